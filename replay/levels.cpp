#include "replay/levels.h"

#include <tbb/parallel_for_each.h>

#include <vector>

#include "replay/walk_run.h"

namespace regather::replay {

std::uint64_t replay_levels(const WalkStore& walks, const Layout& layout,
                            std::span<const std::uint32_t> permutation,
                            std::span<cachesim::Hierarchy> systems, const QueriesDone& progress) {
    constexpr std::size_t batch = 1 << 16;
    struct Stretch {
        trace::Region region;
        std::size_t end;
    };
    std::vector<cachesim::ByteAccess> accesses;
    std::vector<Stretch> stretches;  // of one region each
    const auto drain = [&] {
        tbb::parallel_for_each(systems.begin(), systems.end(), [&](cachesim::Hierarchy& system) {
            std::size_t begin = 0;
            for (const Stretch& stretch : stretches) {
                system.access(std::span(accesses).subspan(begin, stretch.end - begin), stretch.region);
                begin = stretch.end;
            }
        });
        accesses.clear();
        stretches.clear();
    };
    const std::uint64_t visited =
        run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> elements) {
            layout.for_each(elements, [&](std::uint32_t element, std::uint64_t address, std::uint32_t bytes) {
                const trace::Region region = layout.region(element);
                if (stretches.empty() || stretches.back().region != region) stretches.push_back({region, 0});
                accesses.push_back({address, bytes, cachesim::Access::read});
                stretches.back().end = accesses.size();
            });
            if (accesses.size() >= batch) drain();
        });
    drain();
    return visited;
}

}  // namespace regather::replay
