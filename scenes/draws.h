// scenes/draws.h -- numbers drawn for shapes that are scattered: Philox 4x32-10 (Salmon et al., "Parallel
// random numbers: as easy as 1, 2, 3", SC 2011). A number depends on seed, purpose, index and how many of
// that index were drawn before it, not on who asks when.
#pragma once
#include <Random123/philox.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace regather::scenes {

class Draws {
public:
    enum class Purpose : std::uint32_t { terrain, tuft, growth };

    Draws(std::uint32_t seed, Purpose purpose, std::uint64_t index)
        : key_{{seed, static_cast<std::uint32_t>(purpose)}},
          counter_{{0, static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), 0}} {}

    /// From [0, 1), a multiple of 2^-32.
    double next() {
        const std::size_t place = drawn_++ % 4;
        if (place == 0) {
            block_ = r123::Philox4x32()(counter_, key_);
            ++counter_[0];
        }
        return block_[place] * 0x1p-32;
    }

    /// From [low, high).
    double between(double low, double high) { return low + (high - low) * next(); }

    /// A point of the unit disc, evenly, that is not its middle. Drawn until one is in it, with no sine: the
    /// bits are those that IEEE 754 prescribes.
    std::array<double, 2> in_disc() {
        for (;;) {
            const double x = 2 * next() - 1, y = 2 * next() - 1, square = x * x + y * y;
            if (square <= 1 && square >= 1e-6) return {x, y};
        }
    }

    /// A point of the unit circle, evenly.
    std::array<double, 2> on_circle() {
        const auto [x, y] = in_disc();
        const double length = std::sqrt(x * x + y * y);
        return {x / length, y / length};
    }

private:
    r123::Philox4x32::key_type key_;
    r123::Philox4x32::ctr_type counter_, block_{};
    std::uint64_t drawn_ = 0;
};

}  // namespace regather::scenes
