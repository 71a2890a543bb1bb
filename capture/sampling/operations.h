// capture/sampling/operations.h -- what a strategy keeps and computes for a shaded point, as functions of its
// parameters: counted from the algorithms, every photon that is asked being a witness. A function is a root,
// a sine or cosine, an exponential or a logarithm; reads are of what is kept or built for the point, and
// writes to it. Not counted: the photon search itself and a photon's decoding, addresses, loops.
#pragma once
#include <cstdint>

#include "trace/parameters.h"

namespace regather::capture {

struct Operations {
    double multiply = 0, add = 0, divide = 0, compare = 0, function = 0, read = 0, random = 0;

    /// Floating-point operations; a function is one, as the power in Table 2's BRDF is.
    constexpr double flop() const { return multiply + add + divide + function; }

    friend constexpr Operations operator+(Operations a, Operations b) {
        return {a.multiply + b.multiply, a.add + b.add,   a.divide + b.divide, a.compare + b.compare,
                a.function + b.function, a.read + b.read, a.random + b.random};
    }
    friend constexpr Operations operator*(double n, Operations a) {
        return {n * a.multiply, n * a.add,  n * a.divide, n * a.compare,
                n * a.function, n * a.read, n * a.random};
    }
};

struct SamplingCost {
    std::uint32_t bytes = 0;     ///< Of state that rays of a point are drawn from.
    std::uint32_t searches = 0;  ///< Photon searches a point.
    std::uint64_t rays = 0;      ///< That a point's table is made of.
    Operations table{};          ///< To make it.
    Operations sample{};         ///< To draw one ray with its density.
};

/// Each of a strategy with these parameters, on a diffuse or a glossy surface.
SamplingCost cost_of_uniform(const trace::Parameters& given, bool glossy);
SamplingCost cost_of_cosine(const trace::Parameters& given, bool glossy);
SamplingCost cost_of_scattering(const trace::Parameters& given, bool glossy);
SamplingCost cost_of_incident(const trace::Parameters& given, bool glossy);
SamplingCost cost_of_combined(const trace::Parameters& given, bool glossy);
SamplingCost cost_of_lobes(const trace::Parameters& given, bool glossy);
SamplingCost cost_of_footprints(const trace::Parameters& given, bool glossy);
SamplingCost cost_of_mixture(const trace::Parameters& given, bool glossy);
SamplingCost cost_of_oracle(const trace::Parameters& given, bool glossy);

}  // namespace regather::capture
