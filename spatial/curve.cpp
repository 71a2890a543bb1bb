#include "spatial/curve.h"

#include <bit>

namespace regather::spatial {
namespace {

constexpr std::uint32_t rotate_left(std::uint32_t x, std::uint32_t by) {
    by %= 3;
    return (x << by | x >> (3 - by)) & 7;
}

/// One level: octant in the curve's state -> place of the octant among its siblings, and the state inside it.
struct Step {
    std::uint16_t place, state;
};

constexpr std::uint32_t state_count = 24;

constexpr Step step_of(std::uint32_t state, std::uint32_t octant) {
    const std::uint32_t entry = state / 3, direction = state % 3;
    const std::uint32_t gray = rotate_left(octant ^ entry, 2 - direction);  // right by direction + 1
    const std::uint32_t place = gray ^ gray >> 1 ^ gray >> 2;
    const std::uint32_t even = place == 0 ? 0 : (place - 1) / 2 * 2;
    const std::uint32_t next_entry = entry ^ rotate_left(even ^ even >> 1, direction + 1);
    const std::uint32_t odd = place % 2 == 1 ? place : place - 1;
    const std::uint32_t turn = place == 0 ? 0 : static_cast<std::uint32_t>(std::countr_one(odd)) % 3;
    return {static_cast<std::uint16_t>(place),
            static_cast<std::uint16_t>(next_entry * 3 + (direction + turn + 1) % 3)};
}

/// Three levels: [state << 9 | three octants] -> state << 9 | three places.
struct StepTable {
    std::uint16_t one[state_count << 3], three[state_count << 9];
    StepTable() {
        for (std::uint32_t state = 0; state < state_count; ++state) {
            for (std::uint32_t octant = 0; octant < 8; ++octant) {
                const Step step = step_of(state, octant);
                one[state << 3 | octant] = static_cast<std::uint16_t>(step.state << 3 | step.place);
            }
            for (std::uint32_t octants = 0; octants < 512; ++octants) {
                const Step top = step_of(state, octants >> 6);
                const Step middle = step_of(top.state, octants >> 3 & 7);
                const Step low = step_of(middle.state, octants & 7);
                three[state << 9 | octants] = static_cast<std::uint16_t>(low.state << 9 | top.place << 6 |
                                                                         middle.place << 3 | low.place);
            }
        }
    }
};
const StepTable steps;

}  // namespace

std::uint64_t hilbert_code(std::uint64_t morton, std::uint32_t bits) {
    std::uint64_t code = 0;
    std::uint32_t state = 0, level = bits;
    for (; level % 3 != 0; --level) {
        const std::uint32_t found = steps.one[state << 3 | (morton >> 3 * (level - 1) & 7)];
        code = code << 3 | (found & 7);
        state = found >> 3;
    }
    for (; level != 0; level -= 3) {
        const std::uint32_t found = steps.three[state << 9 | (morton >> 3 * (level - 3) & 511)];
        code = code << 9 | (found & 511);
        state = found >> 9;
    }
    return code;
}

}  // namespace regather::spatial
