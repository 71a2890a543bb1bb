#include "replay/walk_store.h"

#include <fmt/format.h>

#include <utility>

#include "spatial/photons/structures.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::replay {

WalkStore::WalkStore(trace::TraceReader& trace)
    : WalkStore(spatial::open_structure(trace), trace.column<std::uint32_t>("query_walk_bytes"),
                trace.column<std::uint8_t>("walk"),
                trace::shown((trace.folder() / "walk.npy").string(), trace::most_shown_path)) {
    trace.expect_random_access("walk");
}

WalkStore::WalkStore(std::shared_ptr<const spatial::Structure> structure,
                     std::span<const std::uint32_t> walk_bytes, std::span<const std::uint8_t> walks,
                     std::string file)
    : structure_(std::move(structure)), walk_bytes_(walk_bytes), walks_(walks), file_(std::move(file)) {
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
