// capture/sampler.h -- counter-based random numbers: Philox 4x32-10 (Salmon et al., "Parallel Random Numbers:
// As Easy as 1, 2, 3", SC 2011) from Random123. A number depends on (seed, stream, index, sample, dimension)
// alone, not on who asks for it when.
#pragma once
#include <Random123/philox.h>

#include <cstdint>

namespace regather::capture {

/// What the numbers are for; streams never share numbers.
enum class Stream : std::uint32_t { photon, eye, shadow, gather, caustic_photon, irradiance, reference = 64 };

/// The dimensions of one sample, one after the other.
class Sampler {
public:
    Sampler(std::uint64_t seed, Stream stream, std::uint64_t index, std::uint32_t sample = 0)
        : key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}},
          counter_{{0, sample, static_cast<std::uint32_t>(index),
                    static_cast<std::uint32_t>(index >> 32) << 8 | static_cast<std::uint32_t>(stream)}} {}

    std::uint32_t bits() {
        if (next_ == 4) {
            block_ = r123::Philox4x32()(counter_, key_);
            ++counter_[0];
            next_ = 0;
        }
        return block_[static_cast<std::size_t>(next_++)];
    }
    /// Uniform in [0, 1), a multiple of 2^-24.
    float uniform() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
    /// Uniform in [0, 1), a multiple of 2^-53.
    double fine_uniform() {
        const std::uint64_t high = bits();
        return static_cast<double>((high << 32 | bits()) >> 11) * 0x1p-53;
    }
    /// Uniform in [0, bound), bound > 0, by multiplication (bias below bound / 2^32).
    std::uint32_t below(std::uint32_t bound) {
        return static_cast<std::uint32_t>(std::uint64_t{bits()} * bound >> 32);
    }

private:
    r123::Philox4x32::key_type key_;
    r123::Philox4x32::ctr_type counter_, block_{};
    int next_ = 4;
};

}  // namespace regather::capture
