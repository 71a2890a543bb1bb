#include "capture/fingerprint.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <memory>

#include "capture/capture.h"
#include "capture/reference.h"

namespace regather::capture {
namespace {

constexpr std::uint32_t edge = 16, path_samples = 4;

class Digest {
public:
    Digest() : state_(XXH3_createState(), XXH3_freeState) { XXH3_64bits_reset(state_.get()); }
    void add(const Image& image) {
        XXH3_64bits_update(state_.get(), image.pixels.data(), image.pixels.size() * sizeof image.pixels[0]);
    }
    void add(const trace::TraceInfo& info) {
        const std::uint64_t counts[] = {info.photons, info.queries, info.found_photons, info.visited_nodes};
        XXH3_64bits_update(state_.get(), counts, sizeof counts);
    }
    std::string text() const { return fmt::format("{:016x}", XXH3_64bits_digest(state_.get())); }

private:
    std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

void add_capture(Digest& digest, const scenes::Scene& scene, Visualisation visualisation) {
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
    digest.add(captured.image);
    digest.add(captured.info);
    if (captured.caustic_info) digest.add(*captured.caustic_info);
}

}  // namespace

std::string fingerprint(const scenes::Scene& scene) {
    Digest digest;
    add_capture(digest, scene, Visualisation::final_gather);
    add_capture(digest, scene, Visualisation::direct);
    const RayCaster caster(scene);
    const LightSampler lights(scene);
    const PathTracer tracer(scene, caster, lights, {.width = edge, .height = edge, .seed = 1});
    Reference paths({scene.name, "", edge, edge, 1});
    paths.add(tracer, path_samples);
    digest.add(paths.mean());
    return digest.text();
}

}  // namespace regather::capture
