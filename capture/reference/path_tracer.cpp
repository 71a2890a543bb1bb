#include "capture/reference/path_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "capture/light/bsdf.h"
#include "capture/light/surface.h"
#include "capture/sampler.h"

namespace regather::capture {
namespace {

using Rgb = trace::Vec3d;

constexpr std::uint64_t traced_at_once = 64;
constexpr double roulette_below = 0.25;  // of the throughput: shorter paths are worth their whole cost
// Glass keeps light that smooth normals have turned below its critical angle, and loses none of it: a path of
// only specular surfaces meets another roulette. Its mean length beyond is 64.
constexpr std::uint32_t specular_run = 64;
constexpr double specular_chance = 1 - 1.0 / 64;

/// Weight of a technique of density `own` beside another one of density `other`.
double power_heuristic(double own, double other) {
    const double ratio = other / own;
    return 1 / (1 + ratio * ratio);
}

}  // namespace

PathCounts& PathCounts::operator+=(const PathCounts& other) {
    samples += other.samples;
    rays += other.rays;
    shadow_rays += other.shadow_rays;
    cut_off += other.cut_off;
    nonfinite += other.nonfinite;
    return *this;
}

/// One path from the eye. Throughput and sums are doubles: after 10,000 surfaces of albedo 0.9999 the
/// roundings of floats would show.
class PathTracer::Path {
public:
    Path(const PathTracer& tracer, Sampler& sampler, View& view, PathCounts& counts)
        : tracer_(tracer),
          scene_(tracer.scene_),
          caster_(tracer.caster_),
          lights_(tracer.lights_),
          sampler_(sampler),
          view_(view),
          counts_(counts) {}

    Rgb follow(Vec3 origin, Vec3 direction) {
        origin_ = origin;
        direction_ = direction;
        for (std::uint32_t surface = 0;; ++surface) {
            if (surface == tracer_.config_.most_surfaces) {
                ++counts_.cut_off;
                break;
            }
            ++counts_.rays;
            const std::optional<Hit> hit = caster_.closest(origin_, direction_);
            if (!hit) break;
            const Vec3 incoming = -direction_;
            const Surface at = surface_at(scene_, *hit, incoming);
            add_emission(*hit, at.front);
            const bool goes_on =
                is_specular(*at.material) ? turn(*hit, at, incoming) : scatter_on(*hit, at, incoming);
            if (!goes_on || !survives()) break;
        }
        return radiance_;
    }

private:
    void add_emission(const Hit& hit, bool front) {
        const std::int32_t light = scene_.triangle_light[hit.triangle];
        if (light < 0 || !front) return;
        const auto l = static_cast<std::uint32_t>(light);
        double weight = 1;
        // `density_` is 0 where no point on a light could have been chosen instead: at the eye and at
        // specular surfaces.
        if (density_ > 0) {
            if (tracer_.config_.direct_light == DirectLight::lights_only) return;
            if (tracer_.config_.direct_light == DirectLight::both) {
                const Vec3 path = hit.position - origin_;
                const double cosine = -static_cast<double>(dot(hit.geometric_normal, direction_));
                const double of_light =
                    lights_.pdf_area(view_, l) * static_cast<double>(dot(path, path)) / cosine;
                weight = power_heuristic(density_, of_light);
            }
        }
        radiance_ += throughput_ * scene_.lights[l].radiance * weight;
    }

    /// Direct light by a point on a light, then the path's next direction.
    bool scatter_on(const Hit& hit, const Surface& at, Vec3 incoming) {
        origin_ = caster_.offset(hit.position, at.side);
        if (tracer_.config_.direct_light != DirectLight::paths_only) add_direct_light(hit, at, incoming);
        const double choice = sampler_.fine_uniform();
        const float u = sampler_.uniform(), v = sampler_.uniform();
        if (!sample_direction(*at.material, at.normal, incoming, choice, u, v, direction_)) return false;
        if (!(dot(at.side, direction_) > 0)) return false;
        density_ = scatter_pdf(*at.material, at.normal, incoming, direction_);
        if (!(density_ > 0)) return false;
        const bool lambert = at.material->kind == MaterialKind::diffuse || at.material->specular == Vec3{};
        specular_ = 0;
        throughput_ =
            throughput_ * (lambert ? Rgb(at.material->diffuse)  // f cos / pdf without its roundings
                                   : Rgb(brdf(*at.material, at.normal, direction_, incoming)) *
                                         (static_cast<double>(dot(at.normal, direction_)) / density_));
        return true;
    }

    void add_direct_light(const Hit& hit, const Surface& at, Vec3 incoming) {
        lights_.look(hit.position, at.side, view_);
        const double choice = sampler_.fine_uniform(), u = sampler_.fine_uniform(),
                     v = sampler_.fine_uniform();
        LightPoint point;
        if (!lights_.sample(view_, choice, u, v, point)) return;
        const Vec3 path = point.position - origin_;
        const double distance2 = dot(path, path);
        if (!(distance2 > 0)) return;
        const Vec3 direction = normalize(path);
        const double cos_light = -static_cast<double>(dot(point.normal, direction));
        if (!(cos_light > 0) || !(dot(at.side, direction) > 0)) return;
        const double of_path = scatter_pdf(*at.material, at.normal, incoming, direction);
        if (!(of_path > 0)) return;
        const Vec3 target = caster_.offset(point.position, point.normal), ray = target - origin_;
        const float extent = length(ray);
        if (!(extent > 0)) return;
        ++counts_.shadow_rays;
        if (caster_.occluded(origin_, ray * (1 / extent), extent)) return;
        const double density = point.pdf * distance2 / cos_light;
        const double weight =
            tracer_.config_.direct_light == DirectLight::both ? power_heuristic(density, of_path) : 1;
        radiance_ += throughput_ * brdf(*at.material, at.normal, direction, incoming) * point.radiance *
                     (static_cast<double>(dot(at.normal, direction)) * weight / density);
    }

    /// One branch of a specular surface. Radiance shrinks by the square of the index that the light leaves
    /// behind (Veach 1997, section 5.2).
    bool turn(const Hit& hit, const Surface& at, Vec3 incoming) {
        density_ = 0;
        if (++specular_ > specular_run) {
            if (sampler_.fine_uniform() >= specular_chance) return false;
            throughput_ = throughput_ * (1 / specular_chance);
        }
        if (at.material->kind == MaterialKind::mirror) {
            throughput_ = throughput_ * at.material->specular;
        } else {
            Vec3 through;
            if (sampler_.fine_uniform() >= fresnel(dot(incoming, at.normal), at.eta()) &&
                refracted(at, incoming, through)) {
                const double eta = at.eta();
                throughput_ = throughput_ * (1 / (eta * eta));
                compression_ *= eta * eta;
                origin_ = caster_.offset(hit.position, -at.side);
                direction_ = through;
                return true;
            }
        }
        origin_ = caster_.offset(hit.position, at.side);
        direction_ = reflected(at, incoming);
        return true;
    }

    /// Russian roulette by what is left of the light, its compression in glass set aside: it comes back on
    /// the way out.
    bool survives() {
        if (!is_finite(throughput_)) {  // nor is the path's radiance, then
            radiance_.x = std::numeric_limits<double>::quiet_NaN();
            return false;
        }
        const double left = max_component(throughput_) * compression_;
        if (!(left > 0)) return false;
        if (left >= roulette_below) return true;
        const double chance = left / roulette_below;
        if (sampler_.fine_uniform() >= chance) return false;
        throughput_ = throughput_ * (1 / chance);
        return true;
    }

    const PathTracer& tracer_;
    const Scene& scene_;
    const RayCaster& caster_;
    const LightSampler& lights_;
    Sampler& sampler_;
    View& view_;
    PathCounts& counts_;

    Vec3 origin_, direction_;
    Rgb throughput_{1, 1, 1}, radiance_{};
    double compression_ = 1;
    std::uint32_t specular_ = 0;  // surfaces in a row
    double density_ = 0;          // [1/sr] of direction_, beside that of points on lights
};

PathTracer::PathTracer(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
                       const PathConfig& config)
    : scene_(scene),
      caster_(caster),
      lights_(lights),
      config_(config),
      plane_(scene.camera, config.width, config.height) {}

Rgb PathTracer::sample(std::uint32_t pixel, std::uint32_t number, View& view, PathCounts& counts) const {
    Sampler sampler(config_.seed, Stream::reference, pixel, number);
    const float x = static_cast<float>(pixel % config_.width) + sampler.uniform();
    const float y = static_cast<float>(pixel / config_.width) + sampler.uniform();
    ++counts.samples;
    const Rgb radiance =
        Path(*this, sampler, view, counts).follow(scene_.camera.position, plane_.direction(x, y));
    if (is_finite(radiance)) return radiance;
    counts.nonfinite.count(Stage::path);
    return {};
}

PathCounts PathTracer::add(std::span<Moments> pixels, std::uint32_t first, std::uint32_t count,
                           const std::function<void(std::uint64_t)>& finished) const {
    PathCounts all;
    std::mutex mutex;
    std::atomic<std::uint64_t> done = 0;
    const std::uint64_t blocks = (pixels.size() + traced_at_once - 1) / traced_at_once;
    tbb::parallel_for(std::uint64_t{0}, blocks, [&](std::uint64_t block) {
        View view;
        PathCounts counts;
        const std::uint64_t begin = block * traced_at_once,
                            end = std::min<std::uint64_t>(begin + traced_at_once, pixels.size());
        for (std::uint64_t pixel = begin; pixel < end; ++pixel)
            for (std::uint32_t s = 0; s < count; ++s) {
                const Rgb rgb = sample(static_cast<std::uint32_t>(pixel), first + s, view, counts);
                pixels[pixel].add({rgb.x, rgb.y, rgb.z}, std::uint64_t{first} + s + 1);
            }
        if (finished) finished(done += end - begin);
        const std::lock_guard lock(mutex);  // sums of whole numbers: in any order
        all += counts;
    });
    return all;
}

}  // namespace regather::capture
