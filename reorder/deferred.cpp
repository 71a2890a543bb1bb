#include "reorder/deferred.h"

#include <algorithm>
#include <unordered_map>

namespace regather::reorder {
namespace {

/// ceil(log_256(bytes / onchip_bytes)), at least 1.
std::uint64_t distribution_passes(std::uint64_t bytes, std::uint64_t onchip_bytes) {
    std::uint64_t passes = 1;
    const std::uint64_t chip = std::max(onchip_bytes, query_record_bytes);  // holds one record at least
    for (std::uint64_t part = (bytes + 255) / 256; part > chip; part = (part + 255) / 256) ++passes;
    return passes;
}

}  // namespace

std::uint64_t queries_in_fullest_tile(const Workload& work, const Tiling& tiling) {
    if (tiling.tiles() == 1) return work.pixel.size();
    // By tile that occurs, as there may be 2^32; looked up once a run of queries in one tile.
    std::unordered_map<std::uint32_t, std::uint64_t> queries;
    std::uint64_t fullest = 0;
    for (std::size_t begin = 0, end = 0; begin != work.pixel.size(); begin = end) {
        const std::uint32_t tile = tiling.tile_of(work.pixel[begin]);
        while (end != work.pixel.size() && tiling.tile_of(work.pixel[end]) == tile) ++end;
        fullest = std::max(fullest, queries[tile] += end - begin);
    }
    return fullest;
}

Cost deferred_cost(const Workload& work, const Tiling& tiling, const DeferredSort& sort,
                   std::uint64_t onchip_bytes) {
    Cost cost;
    cost.keys = work.position.size();
    cost.key_ops = cost.keys * sort.ops_per_key;
    cost.sort_passes = (sort.key_bits + 7) / 8;
    cost.moved_records = cost.keys * cost.sort_passes;
    cost.buffered_bytes = queries_in_fullest_tile(work, tiling) * query_record_bytes;
    if (cost.buffered_bytes > onchip_bytes)
        cost.reorder_bytes =
            2 * cost.keys * query_record_bytes * distribution_passes(cost.buffered_bytes, onchip_bytes);
    return cost;
}

BufferUse deferred_buffer_use(const Workload& work, const Tiling& tiling, std::uint64_t onchip_bytes,
                              std::span<const std::uint32_t> permutation) {
    const std::uint64_t fullest = queries_in_fullest_tile(work, tiling) * query_record_bytes;
    if (fullest <= onchip_bytes) return {};
    SortedBatches batches;
    batches.record_bytes = query_record_bytes;
    batches.rounds = static_cast<std::uint32_t>(distribution_passes(fullest, onchip_bytes));
    if (tiling.tiles() > 1) {
        for (std::size_t r = 1; r < permutation.size(); ++r)
            if (tiling.tile_of(work.pixel[permutation[r]]) != tiling.tile_of(work.pixel[permutation[r - 1]]))
                batches.ends.push_back(r);
    }
    batches.ends.push_back(permutation.size());
    BufferUse use;
    use.batches = std::move(batches);
    return use;
}

}  // namespace regather::reorder
