#include <algorithm>

#include "replay/layouts/placement.h"

namespace regather::replay {

std::vector<std::uint64_t> given_addresses(const spatial::Structure& structure) {
    const std::span<const std::uint64_t> given = structure.own_addresses();
    const std::span<const std::uint32_t> bytes = structure.own_bytes();
    std::vector<std::uint64_t> addresses(given.begin(), given.end());
    std::vector<std::uint32_t> order;
    for (std::uint32_t e = 0; e < given.size(); ++e)
        if (bytes[e] > 0) order.push_back(e);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return given[a] < given[b] || (given[a] == given[b] && a < b);
    });
    std::uint64_t end = 0, left_out = 0;  // of what was placed, as it was given; of the gaps so far
    for (const std::uint32_t e : order) {
        if (given[e] > end) {
            const std::uint64_t stretches = (given[e] - end) / gap_stretch;
            if (stretches > 1) left_out += (stretches - 1) * gap_stretch;
        }
        addresses[e] = given[e] - left_out;
        end = std::max(end, given[e] + bytes[e]);
    }
    return addresses;
}

}  // namespace regather::replay
