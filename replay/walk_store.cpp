#include "replay/walk_store.h"

#include <fmt/format.h>

#include <utility>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::replay {
namespace {

/// Nodes of the tree that the walks were taken in; opening the column checks it.
std::uint32_t tree_size(trace::TraceReader& trace) {
    const std::uint64_t photons = trace.column<trace::Photon>("photon").size();
    if (photons >= std::uint64_t{1} << 31)
        throw trace::DataError(fmt::format("{}: found {} rows, expected fewer than 2^31",
                                           (trace.folder() / "photon.npy").string(), photons));
    return static_cast<std::uint32_t>(photons);
}

}  // namespace

WalkStore::WalkStore(trace::TraceReader& trace)
    : WalkStore(tree_size(trace), trace.column<std::uint32_t>("query_walk_bytes"),
                trace.column<std::uint8_t>("walk"),
                trace::shown((trace.folder() / "walk.npy").string(), trace::most_shown_path)) {
    trace.expect_random_access("walk");
}

WalkStore::WalkStore(std::uint32_t photons, std::span<const std::uint32_t> walk_bytes,
                     std::span<const std::uint8_t> walks, std::string file)
    : photons_(photons), walk_bytes_(walk_bytes), walks_(walks), file_(std::move(file)) {
    block_start_.reserve(walk_bytes.size() / block_queries + 1);
    std::uint64_t start = 0;
    for (std::uint64_t q = 0; q < walk_bytes.size(); ++q) {
        if (q % block_queries == 0) block_start_.push_back(start);
        start += walk_bytes[q];
    }
    if (start != walks.size())
        throw trace::DataError(fmt::format("{}: found {} bytes, expected {} as query_walk_bytes add up to",
                                           file_, walks.size(), start));
}

}  // namespace regather::replay
