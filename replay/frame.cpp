#include "replay/frame.h"

#include <fmt/format.h>

#include <memory>

#include "reorder/tiling.h"
#include "replay/system_stream.h"
#include "replay/walk_run.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

/// A part's queries tile by tile, in the order of its permutation within a tile; and where each tile ends.
struct TiledOrder {
    std::vector<std::uint32_t> permutation;
    std::vector<std::uint64_t> ends;

    TiledOrder(const FramePart& part, const reorder::Tiling& tiling, std::uint64_t pixels)
        : permutation(part.permutation.size()), ends(tiling.tiles()) {
        for (const std::uint32_t query : part.permutation) {
            const std::uint32_t pixel = part.pixel[query];
            if (pixel >= pixels)
                throw trace::DataError(
                    fmt::format("{}: query {}: found pixel {}, expected one below {}, as the image has",
                                part.walks->file(), query, pixel, pixels));
            ++ends[tiling.tile_of(pixel)];
        }
        std::vector<std::uint64_t> next(ends.size());
        for (std::size_t t = 1; t < ends.size(); ++t) {
            next[t] = ends[t - 1];
            ends[t] += ends[t - 1];
        }
        for (const std::uint32_t query : part.permutation)
            permutation[next[tiling.tile_of(part.pixel[query])]++] = query;
    }
};

void read(const Layout& layout, std::uint64_t base, std::span<const std::uint32_t> elements,
          SystemStream& stream) {
    layout.for_each(elements, [&](std::uint32_t element, std::uint64_t address, std::uint32_t bytes) {
        stream.append({base + address, bytes, cachesim::Access::read}, layout.region(element));
    });
}

}  // namespace

std::vector<std::vector<cachesim::HierarchyCounts>> replay_frame(std::span<const FramePart> parts,
                                                                 const FrameTurns& turns,
                                                                 std::span<cachesim::Hierarchy> systems,
                                                                 const QueriesDone& progress) {
    reorder::Workload image;
    image.image_width = turns.image_width;
    image.image_height = turns.image_height;
    const reorder::Tiling tiling(image, turns.tile);
    std::vector<TiledOrder> orders;
    std::vector<std::unique_ptr<spatial::WalkDecoder>> decoders;
    for (const FramePart& part : parts) {
        orders.emplace_back(part, tiling, std::uint64_t{turns.image_width} * turns.image_height);
        decoders.push_back(part.walks->structure().decoder());
    }

    SystemStream stream(systems, parts.size());
    constexpr std::uint64_t progress_queries = 1 << 16;
    std::uint64_t done = 0, told = 0;
    for (std::uint64_t tile = 0; tile < tiling.tiles(); ++tile)
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const FramePart& part = parts[p];
            stream.begin_part(p);
            const std::uint64_t begin = tile == 0 ? 0 : orders[p].ends[tile - 1], end = orders[p].ends[tile];
            for (std::uint64_t r = begin; r < end; ++r) {
                const std::uint32_t query = orders[p].permutation[r];
                const auto [fault, elements] = decoders[p]->decode(part.walks->walk(query));
                if (fault != spatial::WalkFault::none) refuse_walk(*part.walks, query, fault);
                read(*part.layout, part.base, elements, stream);
            }
            done += end - begin;
            if (progress && done - told >= progress_queries) progress(told = done);
        }
    if (progress) progress(done);
    return stream.finish();
}

}  // namespace regather::replay
