#include "replay/levels.h"

#include <tbb/parallel_for_each.h>

#include <vector>

#include "replay/walk_run.h"

namespace regather::replay {

std::uint64_t replay_levels(const WalkStore& walks, const HeapLayout& layout,
                            std::span<const std::uint32_t> permutation,
                            std::span<cachesim::Hierarchy> systems, const QueriesDone& progress) {
    constexpr std::size_t batch = 1 << 16;
    std::vector<cachesim::ByteAccess> accesses;
    const auto drain = [&] {
        tbb::parallel_for_each(systems.begin(), systems.end(), [&](cachesim::Hierarchy& system) {
            system.access(accesses, trace::Region::photons);
        });
        accesses.clear();
    };
    const std::uint64_t visited =
        run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> slots) {
            for (const std::uint32_t slot : slots)
                accesses.push_back({layout.address(slot), layout.used_bytes, cachesim::Access::read});
            if (accesses.size() >= batch) drain();
        });
    drain();
    return visited;
}

}  // namespace regather::replay
