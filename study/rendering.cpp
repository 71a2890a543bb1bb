#include "study/rendering.h"

#include <cmath>
#include <vector>

namespace regather::study {
namespace {

std::vector<capture::Moments> traced(const scenes::Scene& scene, std::uint32_t width, std::uint32_t samples,
                                     capture::PathCounts& counts) {
    const capture::RayCaster caster(scene);
    const capture::LightSampler lights(scene);
    capture::PathConfig config;
    config.width = config.height = width;
    const capture::PathTracer tracer(scene, caster, lights, config);
    std::vector<capture::Moments> pixels(std::size_t{width} * width);
    counts = tracer.add(pixels, 0, samples);
    return pixels;
}

}  // namespace

double difference(const capture::Image& image, const capture::Image& truth) {
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double d = double{image.pixels[i][c]} - truth.pixels[i][c];
            squares += d * d;
            sum += double{truth.pixels[i][c]};
        }
    const auto count = static_cast<double>(3 * truth.pixels.size());
    return std::isfinite(squares) ? std::sqrt(squares / count) / (sum / count) : INFINITY;
}

capture::Captured photon_mapped(const scenes::Scene& scene) {
    capture::CaptureConfig config;
    config.pixels.width = config.pixels.height = 32;
    config.pixels.gather_rays = 16;
    config.pixels.shadow_rays = 4;
    config.photon.photons = 20'000;
    config.gather.k = 50;
    config.caustic.photons = 2'000;
    return capture::capture(scene, config);
}

Estimate path_traced(const scenes::Scene& scene, std::uint32_t width, std::uint32_t samples) {
    Estimate estimate;
    double variance = 0;
    const auto pixels = traced(scene, width, samples, estimate.counts);
    for (const capture::Moments& pixel : pixels) {
        estimate.mean += pixel.mean[0];
        variance += pixel.variance(0, samples);
    }
    const auto count = static_cast<double>(pixels.size());
    estimate.mean /= count;
    estimate.standard_error = std::sqrt(variance) / count;
    return estimate;
}

capture::Image path_traced_image(const scenes::Scene& scene, std::uint32_t width, std::uint32_t samples,
                                 capture::PathCounts& counts) {
    capture::Image image{width, width, {}};
    for (const capture::Moments& pixel : traced(scene, width, samples, counts))
        image.pixels.push_back({static_cast<float>(pixel.mean[0]), static_cast<float>(pixel.mean[1]),
                                static_cast<float>(pixel.mean[2])});
    return image;
}

}  // namespace regather::study
