// replay/frame.h -- the walks of several traces through one memory system, in turns, as a renderer runs the
// rays and the searches of a frame: pixel by pixel, tile by tile, or one kind after the other over the whole
// image.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cachesim/machines/hierarchy.h"
#include "replay/replay.h"

namespace regather::replay {

/// A trace's share of a frame. All that it names outlives the replay.
struct FramePart {
    const WalkStore* walks = nullptr;
    const Layout* layout = nullptr;
    std::uint64_t base = 0;                      ///< Added to the layout's addresses.
    std::span<const std::uint32_t> permutation;  ///< All queries of the trace in their order.
    std::span<const std::uint32_t> pixel;        ///< By query.
};

/// When the parts take turns: after each square tile of the image, in row order.
struct FrameTurns {
    std::uint32_t image_width = 1, image_height = 1;  ///< [pixels]
    std::optional<std::uint32_t> tile;                ///< Edge [pixels], from 1 up; none: the whole image.
};

/// In each tile the parts run one after the other, each the queries of the tile's pixels in the order of its
/// permutation, read by each of `systems` as if it were alone, from empty to flushed. By system, then by
/// part: what was counted while the part ran (SystemStream::finish()). Throws trace::DataError for a pixel
/// outside the image, and as replay().
std::vector<std::vector<cachesim::HierarchyCounts>> replay_frame(std::span<const FramePart> parts,
                                                                 const FrameTurns& turns,
                                                                 std::span<cachesim::Hierarchy> systems,
                                                                 const QueriesDone& progress = {});

}  // namespace regather::replay
