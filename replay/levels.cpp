#include "replay/levels.h"

#include "replay/system_stream.h"
#include "replay/walk_run.h"

namespace regather::replay {

std::uint64_t replay_levels(const WalkStore& walks, const Layout& layout,
                            std::span<const std::uint32_t> permutation,
                            std::span<cachesim::Hierarchy> systems, const QueriesDone& progress) {
    SystemStream stream(systems);
    const std::uint64_t visited =
        run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> elements) {
            layout.for_each(elements, [&](std::uint32_t element, std::uint64_t address, std::uint32_t bytes) {
                stream.append({address, bytes, cachesim::Access::read}, layout.region(element));
            });
        });
    stream.drain();
    return visited;
}

}  // namespace regather::replay
