#include "replay/pixel_traffic.h"

#include <fmt/format.h>

#include "replay/walk_lines.h"
#include "replay/walk_run.h"
#include "trace/error.h"

namespace regather::replay {

std::vector<std::uint64_t> pixel_traffic(const WalkStore& walks, const Layout& layout,
                                         std::span<const std::uint32_t> permutation,
                                         std::span<const std::uint32_t> query_pixel, std::uint64_t pixels,
                                         const cachesim::CacheConfig& config, const QueriesDone& progress) {
    for (const std::uint32_t pixel : query_pixel)
        if (pixel >= pixels)
            throw trace::DataError(
                fmt::format("query_pixel: found {}, expected a pixel below {}", pixel, pixels));
    cachesim::LruCache cache(config);
    WalkLines lines(layout, config.line_bytes);
    std::vector<std::uint64_t> bytes(pixels);
    std::uint64_t r = 0, before = 0;
    run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> elements) {
        cache.access(lines.touches(elements), trace::Region::photons);
        const std::uint64_t now = cache.traffic_bytes();
        bytes[query_pixel[permutation[r++]]] += now - before;
        before = now;
    });
    return bytes;
}

}  // namespace regather::replay
