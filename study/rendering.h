// study/rendering.h -- small pictures of test rooms by the photon mapper and by the path tracer, and how far
// two of them are apart.
#pragma once
#include <cstdint>

#include "capture/capture.h"
#include "capture/reference/path_tracer.h"

namespace regather::study {

/// Root mean square of the difference over pixels and channels, over the mean of `truth`; infinite for a
/// pixel that is no number.
double difference(const capture::Image& image, const capture::Image& truth);

/// 32 x 32 pixels with 16 final gather rays each from 20,000 photons.
capture::Captured photon_mapped(const scenes::Scene& scene);

/// Mean radiance of all pixels and its standard error (channel 0).
struct Estimate {
    double mean = 0, standard_error = 0;
    capture::PathCounts counts;
};
/// width x width pixels.
Estimate path_traced(const scenes::Scene& scene, std::uint32_t width, std::uint32_t samples);
capture::Image path_traced_image(const scenes::Scene& scene, std::uint32_t width, std::uint32_t samples,
                                 capture::PathCounts& counts);

}  // namespace regather::study
