// replay/levels.h -- runs recorded walks in an order through memory systems of several levels, byte by byte.
#pragma once
#include <cstdint>
#include <span>

#include "cachesim/machines/hierarchy.h"
#include "replay/replay.h"

namespace regather::replay {

/// What the queries of `permutation` visit, read in that order by each of `systems` as if it were alone, and
/// charged to the elements' regions. Systems run side by side on the threads of oneTBB. Returns the
/// visited elements. Throws trace::DataError with the query's number when a walk does not fit its structure.
std::uint64_t replay_levels(const WalkStore& walks, const Layout& layout,
                            std::span<const std::uint32_t> permutation,
                            std::span<cachesim::Hierarchy> systems, const QueriesDone& progress = {});

}  // namespace regather::replay
