// capture/reference/path_tracer.h -- the truth that images are measured against: unidirectional path tracing
// (Kajiya 1986) on the scene, materials and lights of the photon mapper, with next-event estimation joined to
// the paths' own hits by multiple importance sampling, power heuristic with exponent 2 (Veach & Guibas 1995).
// Unbiased: no path is cut by length, no value is clamped; Russian roulette ends paths. Pixels are means over
// their square (box filter). Radiance [W / (m^2 sr)]. A sample depends on (scene, image size, seed, pixel,
// number of the sample) alone: not on threads, not on what came before.
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "capture/light/lights.h"
#include "capture/nonfinite.h"
#include "capture/ray_caster.h"
#include "capture/reference/moments.h"
#include "capture/view_plane.h"

namespace regather::capture {

/// Where direct light comes from. All have the same expectation where lights can be met by rays.
enum class DirectLight : std::uint8_t {
    both,         ///< Weighed by the power heuristic.
    lights_only,  ///< Points on the lights.
    paths_only,   ///< Paths that happen to meet a light.
};

struct PathConfig {
    std::uint32_t width = 512, height = 512;  ///< [pixels]
    std::uint64_t seed = 1;
    DirectLight direct_light = DirectLight::both;
    /// A net below the roulette, for boxes that absorb nothing: paths that meet it are counted, and lose what
    /// would have come after.
    std::uint32_t most_surfaces = 1'000'000;
};

/// What the samples cost, and what went wrong with them.
struct PathCounts {
    std::uint64_t samples = 0, rays = 0, shadow_rays = 0;
    std::uint64_t cut_off = 0;  ///< Paths that met PathConfig::most_surfaces.
    Nonfinite nonfinite;        ///< Samples that count as black for a value that was not finite: Stage::path.
    PathCounts& operator+=(const PathCounts& other);
    friend bool operator==(const PathCounts&, const PathCounts&) = default;
};

class PathTracer {
public:
    /// The scene, its lights and the caster outlive the tracer.
    PathTracer(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
               const PathConfig& config);

    /// One sample of one pixel. `view` is scratch memory.
    trace::Vec3d sample(std::uint32_t pixel, std::uint32_t number, View& view, PathCounts& counts) const;

    /// Samples [first, first + count) of every pixel of the image, in parallel; those before are in `pixels`.
    /// `finished` is told the number of pixels done, from any thread.
    PathCounts add(std::span<Moments> pixels, std::uint32_t first, std::uint32_t count,
                   const std::function<void(std::uint64_t)>& finished = {}) const;

private:
    class Path;
    const Scene& scene_;
    const RayCaster& caster_;
    const LightSampler& lights_;
    PathConfig config_;
    ViewPlane plane_;
};

}  // namespace regather::capture
