#include "reorder/hashed.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "reorder/cell.h"
#include "reorder/sort.h"
#include "trace/range.h"

namespace regather::reorder {
namespace {

constexpr std::uint32_t max_cells = 1 << 21;
constexpr std::uint64_t max_slots = 1 << 26;
constexpr std::uint64_t ops_per_hash = 6;  // three multiplies, two exclusive-or, one remainder

/// A set of bucket numbers that knows its smallest: a bit a bucket, and a bit for each 64 bits of the level
/// below.
class BucketSet {
public:
    explicit BucketSet(std::size_t buckets) {
        do {
            buckets = (buckets + 63) / 64;
            levels_.emplace_back(buckets, 0);
        } while (buckets > 1);
    }
    void insert(std::size_t bucket) {
        for (auto& level : levels_) {
            level[bucket / 64] |= std::uint64_t{1} << bucket % 64;
            bucket /= 64;
        }
    }
    void erase(std::size_t bucket) {
        for (auto& level : levels_) {
            level[bucket / 64] &= ~(std::uint64_t{1} << bucket % 64);
            if (level[bucket / 64] != 0) return;
            bucket /= 64;
        }
    }
    /// The set is not empty.
    std::size_t smallest() const {
        std::size_t at = 0;
        for (auto level = levels_.rbegin(); level != levels_.rend(); ++level)
            at = at * 64 + static_cast<std::size_t>(std::countr_zero((*level)[at]));
        return at;
    }

private:
    std::vector<std::vector<std::uint64_t>> levels_;
};

/// Bounded first-in first-out buckets; knows which are full.
class Buckets {
public:
    Buckets(std::uint32_t buckets, std::uint32_t capacity)
        : capacity_(capacity),
          slots_(std::size_t{buckets} * capacity),
          head_(buckets),
          held_(buckets),
          full_(buckets) {}

    bool full(std::uint32_t bucket) const { return held_[bucket] == capacity_; }
    bool empty(std::uint32_t bucket) const { return held_[bucket] == 0; }
    void push(std::uint32_t bucket, std::uint32_t query) {
        const std::uint64_t place = std::uint64_t{head_[bucket]} + held_[bucket];
        slots_[std::size_t{bucket} * capacity_ + (place < capacity_ ? place : place - capacity_)] = query;
        if (++held_[bucket] == capacity_) full_.insert(bucket);
    }
    std::uint32_t pop(std::uint32_t bucket) {
        const std::uint32_t query = slots_[std::size_t{bucket} * capacity_ + head_[bucket]];
        if (++head_[bucket] == capacity_) head_[bucket] = 0;
        if (held_[bucket]-- == capacity_) full_.erase(bucket);
        return query;
    }
    /// At least one is full.
    std::uint32_t first_full() const { return static_cast<std::uint32_t>(full_.smallest()); }
    /// Those that hold anything, fullest first, the first of equals.
    std::vector<std::uint32_t> by_fullness() const {
        std::vector<std::uint32_t> held(held_.size());
        std::iota(held.begin(), held.end(), 0u);
        std::erase_if(held, [&](std::uint32_t bucket) { return empty(bucket); });
        std::stable_sort(held.begin(), held.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return held_[a] > held_[b]; });
        return held;
    }

private:
    std::uint32_t capacity_;
    std::vector<std::uint32_t> slots_, head_, held_;
    BucketSet full_;
};

/// By query.
std::vector<std::uint32_t> buckets_of(const HashedConfig& config, const Workload& work) {
    const CellGrid grid(work.bounds, config.cells);
    std::vector<std::uint32_t> bucket(work.position.size());
    tbb::parallel_for(std::size_t{0}, bucket.size(), [&](std::size_t i) {
        const std::uint32_t beside = config.cells;
        const Cell cell =
            is_finite(work.position[i]) ? grid.cell_of(work.position[i]) : Cell{beside, beside, beside};
        bucket[i] = bucket_of(cell[0], cell[1], cell[2], config.buckets);
    });
    return bucket;
}

/// Ranks the queries; returns the number of stalls. `made_at(r)` is the query made r-th.
template <class MadeAt>
std::uint64_t run_machine(const HashedConfig& config, std::span<const std::uint32_t> bucket, MadeAt&& made_at,
                          std::span<std::uint64_t> rank) {
    Buckets buckets(config.buckets, config.capacity);
    std::uint64_t made = 0, processed = 0, stalls = 0, stalled_at = bucket.size();
    const auto make_all_possible = [&] {
        for (; made < bucket.size(); ++made) {
            const std::uint32_t query = made_at(made);
            if (buckets.full(bucket[query])) {
                if (stalled_at != made) ++stalls;
                stalled_at = made;
                return;
            }
            buckets.push(bucket[query], query);
        }
    };
    make_all_possible();
    // While queries are left to be made, the making waits for a full bucket: the fullest is the first full
    // one.
    while (made < bucket.size()) {
        const std::uint32_t active = buckets.first_full();
        while (!buckets.empty(active)) {
            rank[buckets.pop(active)] = processed++;
            make_all_possible();
        }
    }
    for (const std::uint32_t active : buckets.by_fullness())
        while (!buckets.empty(active)) rank[buckets.pop(active)] = processed++;
    return stalls;
}

}  // namespace

std::uint32_t bucket_of(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t buckets) {
    return (x * 73856093u ^ y * 19349663u ^ z * 83492791u) % buckets;
}

Hashed::Hashed(const HashedConfig& config) : config_(config) {
    trace::require_range("hashed", "buckets", config.buckets, 1, max_slots);
    trace::require_range("hashed", "capacity", config.capacity, 1, max_slots);
    trace::require_range("hashed", "buckets x capacity", std::uint64_t{config.buckets} * config.capacity, 1,
                         max_slots);
    trace::require_range("hashed", "cells", config.cells, 1, max_cells);
}

std::uint64_t Hashed::buffer_bytes() const {
    return std::uint64_t{config_.buckets} * config_.capacity * query_record_bytes;
}

Cost Hashed::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<std::uint64_t> keys) const {
    return assign_keys(work, onchip_bytes, {}, keys);
}

Cost Hashed::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> incoming, std::span<std::uint64_t> keys) const {
    const std::vector<std::uint32_t> bucket = buckets_of(config_, work);
    Cost cost;
    const auto capture_order = [](std::uint64_t made) { return static_cast<std::uint32_t>(made); };
    cost.stalls = incoming.empty() ? run_machine(config_, bucket, capture_order, keys)
                                   : run_machine(
                                         config_, bucket, [&](auto made) { return incoming[made]; }, keys);
    cost.keys = keys.size();
    cost.key_ops = cost.keys * (CellGrid::ops + ops_per_hash);
    cost.moved_records = cost.keys;
    cost.buffered_bytes = buffer_bytes();
    if (cost.buffered_bytes > onchip_bytes) cost.reorder_bytes = 2 * cost.keys * query_record_bytes;
    return cost;
}

BoundedBuckets Hashed::buckets(const Workload& work, std::uint64_t onchip_bytes,
                               std::vector<std::uint32_t> incoming) const {
    return {.record_bytes = buffer_bytes() > onchip_bytes ? query_record_bytes : 0,
            .buckets = config_.buckets,
            .capacity = config_.capacity,
            .bucket = buckets_of(config_, work),
            .made = std::move(incoming)};
}

BufferUse Hashed::buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                             std::span<const std::uint32_t>) const {
    BufferUse use;
    if (buffer_bytes() > onchip_bytes) use.buckets = buckets(work, onchip_bytes, {});
    return use;
}

Cost HashedBehind::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                               std::span<std::uint64_t> keys) const {
    const Cost making = making_->assign_keys(work, making_onchip(onchip_bytes), keys);
    const std::vector<std::uint32_t> incoming = sorted_permutation(keys);
    Cost sum = hashing_.assign_keys(work, onchip_bytes, incoming, keys);
    sum.keys += making.keys;
    sum.key_ops += making.key_ops;
    sum.buffered_bytes += making.buffered_bytes;
    sum.reorder_bytes += making.reorder_bytes;
    sum.recast_rays += making.recast_rays;
    return sum;
}

BufferUse HashedBehind::buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                                   std::span<const std::uint32_t>) const {
    std::vector<std::uint64_t> keys(work.position.size());
    making_->assign_keys(work, making_onchip(onchip_bytes), keys);
    std::vector<std::uint32_t> incoming = sorted_permutation(keys);
    BufferUse use = making_->buffer_use(work, making_onchip(onchip_bytes), incoming);
    if (use.state || hashing_.buffer_bytes() > onchip_bytes)
        use.buckets = hashing_.buckets(work, onchip_bytes, std::move(incoming));
    return use;
}

}  // namespace regather::reorder
