#include "replay/detail.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "replay/buffer_stream.h"
#include "replay/walk_run.h"
#include "trace/error.h"

namespace regather::replay {

cachesim::ClassStats Detail::sum(std::optional<trace::Region> region) const {
    cachesim::ClassStats sum;
    for (const DetailPart& part : parts)
        if (!region || part.region == *region) sum += part.stats;
    return sum;
}

std::uint64_t Detail::traffic_bytes(std::optional<trace::Region> region) const {
    std::uint64_t sum = 0;
    for (const DetailPart& part : parts)
        if (!region || part.region == *region) sum += part.traffic_bytes;
    return sum;
}

Detail replay_in_detail(const WalkStore& walks, const HeapLayout& layout,
                        std::span<const std::uint32_t> permutation, const reorder::BufferUse& use,
                        const DetailConfig& config, const QueriesDone& progress) {
    if (config.slices == 0) throw trace::UsageError("slices: found 0, expected at least 1");
    const auto start = std::chrono::steady_clock::now();
    const auto depths = static_cast<std::uint32_t>(std::bit_width(walks.photons()));
    const std::uint32_t buffers = depths;  // the class after the last depth
    cachesim::AttributedCache cache(config.cache, depths + 1);
    BufferStream stream(use, permutation);
    const std::uint64_t base = buffer_base(layout, walks.photons(), config.cache.line_bytes);
    const BufferStream::Sink into_cache = [&](std::span<const cachesim::ByteAccess> accesses) {
        for (cachesim::ByteAccess access : accesses) {
            access.address += base;
            cache.access(access, buffers);
        }
    };

    Detail detail;
    const std::uint64_t queries = permutation.size(), slices = std::min(config.slices, queries);
    cachesim::ClassStats before;
    std::uint64_t r = 0, first = 0;
    const auto end_slice = [&] {
        const cachesim::ClassStats now = cache.total();
        detail.slices.push_back(
            {first, r - first, now.accesses - before.accesses, now.misses - before.misses});
        before = now;
        first = r;
    };
    run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> slots) {
        stream.before(r, into_cache);
        for (const std::uint32_t slot : slots)
            cache.access({layout.address(slot), layout.used_bytes, cachesim::Access::read},
                         static_cast<std::uint32_t>(std::bit_width(slot)) - 1);
        if (++r == queries) stream.finish(into_cache);
        if (r == (detail.slices.size() + 1) * queries / slices) end_slice();
    });
    if (queries == 0) stream.finish(into_cache);
    cache.flush();

    const std::span<const cachesim::ClassStats> stats = cache.stats();
    for (std::uint32_t depth = 0; depth < depths; ++depth)
        detail.parts.push_back(
            {trace::Region::photons, depth, stats[depth], cache.traffic_bytes(stats[depth])});
    detail.parts.push_back(
        {trace::Region::reorder_buffer, {}, stats[buffers], cache.traffic_bytes(stats[buffers])});
    detail.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return detail;
}

}  // namespace regather::replay
