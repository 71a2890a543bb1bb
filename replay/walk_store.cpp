#include "replay/walk_store.h"

#include <fmt/format.h>

#include "trace/error.h"

namespace regather::replay {

WalkStore::WalkStore(trace::TraceReader& trace)
    : WalkStore(static_cast<std::uint32_t>(trace.info().photons), trace.column<std::uint32_t>("query_walk_bytes"),
                trace.column<std::uint8_t>("walk")) {
    trace.expect_random_access("walk");
}

WalkStore::WalkStore(std::uint32_t photons, std::span<const std::uint32_t> walk_bytes,
                     std::span<const std::uint8_t> walks)
    : photons_(photons), walk_bytes_(walk_bytes), walks_(walks) {
    block_start_.reserve(walk_bytes.size() / block_queries + 1);
    std::uint64_t start = 0;
    for (std::uint64_t q = 0; q < walk_bytes.size(); ++q) {
        if (q % block_queries == 0) block_start_.push_back(start);
        start += walk_bytes[q];
    }
    if (start != walks.size())
        throw trace::DataError(fmt::format("walk.npy: found {} bytes, expected {} as query_walk_bytes add up to",
                                           walks.size(), start));
}

}  // namespace regather::replay
