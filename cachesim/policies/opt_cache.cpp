#include "cachesim/policies/opt_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "trace/error.h"

namespace regather::cachesim {

namespace {

enum State : std::uint8_t { absent, clean, dirty };

/// A next use and the line's id: one number, so that a heap of them is compared and moved without branches.
std::uint64_t entry(std::uint32_t next_use, std::uint32_t id) {
    return std::uint64_t{next_use} << 32 | id;
}

/// std::pop_heap with the larger child chosen by arithmetic: which one it is cannot be predicted.
std::uint64_t pop_largest(std::uint64_t* heap, std::size_t size) {
    const std::uint64_t largest = heap[0], last = heap[size - 1];
    std::size_t hole = 0;
    for (std::size_t child = 1; child + 1 < size; child = 2 * hole + 1) {
        child += heap[child + 1] > heap[child] ? 1 : 0;
        heap[hole] = heap[child];
        hole = child;
    }
    for (; hole > 0 && heap[(hole - 1) / 2] < last; hole = (hole - 1) / 2) heap[hole] = heap[(hole - 1) / 2];
    heap[hole] = last;
    return largest;
}

}  // namespace

OptStream::OptStream(std::uint64_t limit) : limit_(std::min(limit, most_accesses)) {}

void OptStream::append(Line line, std::uint32_t id, Access kind, std::uint32_t bytes) {
    assert(id < write_bit && id <= lines_.size());
    if (size_ == limit_)
        throw trace::UsageError(
            fmt::format("policy opt: found more than {} line accesses, expected at most as many: the stream "
                        "is kept in memory "
                        "(8 bytes each)",
                        limit_));
    if (id == lines_.size()) lines_.push_back(line);
    const std::uint64_t place = size_ & ((1u << block_bits) - 1);
    if (place == 0) blocks_.push_back(std::make_unique<Entry[]>(1u << block_bits));
    const bool write = kind == Access::write;
    blocks_.back()[place] = {id | (write ? write_bit : 0), never};
    ++size_;
    writes_ += write;
    if (write) written_bytes_ += bytes;
}

void OptStream::finish() {
    std::vector<std::uint32_t> later(lines_.size(), never);
    for (std::uint64_t access = size_; access-- > 0;) {
        Entry& entry = blocks_[access >> block_bits][access & ((1u << block_bits) - 1)];
        std::uint32_t& next = later[entry.reference & ~write_bit];
        entry.next_use = next;
        next = static_cast<std::uint32_t>(access);
    }
}

OptCache::OptCache(const PolicyConfig& config, const OptStream& stream)
    : config_(config),
      stream_(stream),
      index_((check(config), config)),
      ways_(config.ways()),
      sets_(config.sets()),
      coming_(2 * sets_.size() * ways_),
      done_(sets_.size() * ways_),
      states_(stream.lines().size(), absent) {
    assert(config.policy == Policy::opt);
}

void OptCache::access(std::span<std::uint8_t> missed) {
    assert(now_ + missed.size() <= stream_.size());
    for (std::uint8_t& miss : missed) miss = access_next();
}

/// True for a miss.
bool OptCache::access_next() {
    const std::uint32_t id = stream_.id(now_);
    const std::uint64_t set = sets_.size() == 1 ? 0 : index_(stream_.lines()[id]);
    const bool write = stream_.is_write(now_), through = write && config_.write == WritePolicy::through;
    const bool miss = states_[id] == absent;
    ++stats_.accesses;
    stats_.misses += miss;
    stats_.fetches += miss;
    stats_.passed_writes += through;
    if (miss) {
        if (sets_[set].held == ways_) evict(set);
        ++sets_[set].held;
        states_[id] = clean;
    }
    if (write && !through) states_[id] = dirty;
    await(set, id, stream_.next_use(now_));
    ++now_;
    // Every write passes, so their bytes are the stream's.
    if (now_ == stream_.size() && config_.write == WritePolicy::through)
        stats_.passed_bytes = stream_.written_bytes();
    return miss;
}

/// `id` is held and will be used at `next_use`.
void OptCache::await(std::uint64_t set, std::uint32_t id, std::uint32_t next_use) {
    Set& in = sets_[set];
    if (next_use == OptStream::never) {
        std::uint32_t* const done = &done_[set * ways_];
        done[in.done++] = id;
        std::push_heap(done, done + in.done, [&](auto a, auto b) { return smaller_line(b, a); });
        return;
    }
    std::uint64_t* const coming = &coming_[2 * set * ways_];
    if (in.coming == 2 * ways_) {
        // The uses that are over have sunk: they are nearer than all that are to come. Half of the room at
        // least is theirs.
        std::uint64_t* const end =
            std::remove_if(coming, coming + in.coming, [&](auto use) { return use >> 32 <= now_; });
        in.coming = static_cast<std::uint32_t>(end - coming);
        std::make_heap(coming, end);
    }
    coming[in.coming++] = entry(next_use, id);
    std::push_heap(coming, coming + in.coming);
}

void OptCache::evict(std::uint64_t set) {
    Set& in = sets_[set];
    std::uint32_t id;
    if (in.done != 0) {
        std::uint32_t* const done = &done_[set * ways_];
        std::pop_heap(done, done + in.done, [&](auto a, auto b) { return smaller_line(b, a); });
        id = done[--in.done];
    } else {
        id = static_cast<std::uint32_t>(pop_largest(&coming_[2 * set * ways_], in.coming--));
    }
    stats_.writebacks += states_[id] == dirty;
    states_[id] = absent;
    --in.held;
}

bool OptCache::smaller_line(std::uint32_t a, std::uint32_t b) const {
    return stream_.lines()[a] < stream_.lines()[b];
}

void OptCache::flush() {
    for (std::uint8_t& state : states_) {
        stats_.writebacks += state == dirty;
        state = absent;
    }
    std::fill(sets_.begin(), sets_.end(), Set{});
}

}  // namespace regather::cachesim
