// replay/treelet_queues.h -- rays that wait in queues at the treelets of their hierarchy (Aila & Karras,
// "Architecture Considerations for Tracing Incoherent Rays", HPG 2010): a ray runs inside a treelet, and when
// it comes to an element of another one, it is put into that one's queue. Walks are cut into such stays and
// those of many rays run in turns, so this is no permutation of rays. What a ray visits, and in which order,
// stays as it is.
//
// - So many rays are under way at most. While there is room the next ray of the order is made and runs at
//   once through its first treelet; then the treelet whose queue is the longest (of equals the first) is
//   taken, and all that wait there run, first come, first served.
// - A ray in a queue is a record, and the entries of its stack that a running ray has on chip. Where the chip
//   cannot hold those of all rays, a ray that is put into a queue is written and one that is taken is read.
// - Each ray under way has a record and a stack of its own in memory. Entries of the stack that are not on
//   chip (RayTree::Stack) are written and read there as it runs.
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "cachesim/lines.h"
#include "replay/replay.h"
#include "spatial/rays/ray_tree.h"

namespace regather::replay {

/// Of a ray in a queue [bytes]: origin and direction (24), how far it is asked for or has hit (4), what it
/// has hit (4), its number (4), the element that it goes on with (4), the height of its stack (4), the next
/// ray in the queue (4).
inline constexpr std::uint32_t ray_record_bytes = 48;

struct TreeletConfig {
    std::uint32_t treelet_bytes = 16384;  ///< What a treelet holds at most.
    std::uint32_t rays = 4096;            ///< Under way at most; at least 1.
};
inline constexpr std::uint32_t most_queued_rays = 1u << 24;

/// What a ray's accesses are for.
enum class TreeletUse : std::uint8_t { walk, queue };

/// Where the bytes go. Regions: those of the hierarchy, Region::stack, and for records reorder_buffer.
using TreeletSink = std::function<void(const cachesim::ByteAccess&, trace::Region, TreeletUse)>;

struct TreeletRun {
    std::uint32_t treelets = 0;
    std::uint64_t visited_elements = 0;  ///< As the walks give them.
    std::uint64_t pushes = 0;            ///< Rays put into a queue, and taken out of it.
    std::uint64_t queue_runs = 0;        ///< Queues taken.
    std::uint64_t most_under_way = 0;    ///< Rays.
    std::uint64_t saved_entries = 0;     ///< Of stacks, written with their rays' records.
    std::uint64_t state_bytes = 0;       ///< Of the records and on-chip entries of config.rays rays.
    bool in_memory = false;              ///< These are more than the chip holds.

    /// Bytes written to queues in memory and read from them.
    std::uint64_t queue_bytes() const;
};

/// Where the rays under way are: the records behind all elements, from a multiple of 4096 on, then likewise
/// the stacks. Addresses.
struct TreeletMemory {
    std::uint64_t records = 0, stacks = 0, end = 0;
    std::uint32_t stack_places = 0;  ///< Of a ray: as many as any walk fills.
};
TreeletMemory treelet_memory(const spatial::RayTree& tree, const Layout& layout, std::uint32_t rays);

/// The hierarchy that walks were cast through. Throws trace::UsageError when it is none for rays.
const spatial::RayTree& hierarchy_of(const WalkStore& walks);

/// Runs the rays of `permutation` and tells `sink` of each access; `before(r)`, where there is one, just
/// before the r-th ray is made. Throws as hierarchy_of() and replay().
TreeletRun run_treelets(const WalkStore& walks, const Layout& layout,
                        std::span<const std::uint32_t> permutation, const TreeletConfig& config,
                        std::uint64_t onchip_bytes, const TreeletSink& sink, const QueriesDone& before = {});

}  // namespace regather::replay
