#include "capture/fingerprint.h"

#include <span>

#include "capture/capture.h"
#include "capture/reference/reference.h"
#include "trace/digest.h"

namespace regather::capture {
namespace {

constexpr std::uint32_t edge = 16, path_samples = 4;

void add(trace::Digest& digest, const Image& image) {
    digest.add_all(std::span(image.pixels));
}

void add(trace::Digest& digest, const trace::TraceInfo& info) {
    for (const std::uint64_t count : {info.photons, info.queries, info.found_photons, info.visited_nodes})
        digest.add(count);
}

void add_capture(trace::Digest& digest, const scenes::Scene& scene, Visualisation visualisation) {
    CaptureConfig config;
    config.pixels.width = config.pixels.height = edge;
    config.pixels.gather_rays = 8;
    config.pixels.shadow_rays = 4;
    config.pixels.visualisation = visualisation;
    config.photon.photons = 2000;
    config.gather.k = 20;
    config.caustic.photons = 400;
    config.caustic.k = 15;
    const Captured captured = capture(scene, config);
    add(digest, captured.image);
    add(digest, captured.info);
    if (const auto& caustic = captured.beside[Beside::caustic]) add(digest, *caustic);
}

}  // namespace

std::string fingerprint(const scenes::Scene& scene) {
    trace::Digest digest;
    add_capture(digest, scene, Visualisation::final_gather);
    add_capture(digest, scene, Visualisation::direct);
    const RayCaster caster(scene);
    const LightSampler lights(scene);
    const PathTracer tracer(scene, caster, lights, {.width = edge, .height = edge, .seed = 1});
    Reference paths({scene.name, "", edge, edge, 1});
    paths.add(tracer, path_samples);
    add(digest, paths.mean());
    return digest.hexadecimal();
}

}  // namespace regather::capture
