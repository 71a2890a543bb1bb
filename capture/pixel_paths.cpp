#include "capture/pixel_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "capture/sampler.h"
#include "capture/sampling/strata.h"

namespace regather::capture {
namespace {

constexpr float unlimited = std::numeric_limits<float>::infinity();
constexpr std::size_t lights_sampled_each = 4;

float sum_of_channels(Vec3 v) {
    return v.x + v.y + v.z;
}
bool is_black(const Material& material) {
    return material.diffuse == Vec3{} && material.specular == Vec3{};
}

}  // namespace

PixelPaths::PixelPaths(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
                       const QueryConfig& config, PassParts parts, PixelWork& work)
    : scene_(scene),
      caster_(caster),
      lights_(lights),
      config_(config),
      parts_(parts),
      plane_(scene.camera, config.width, config.height),
      work_(work),
      sampling_(parse_sampling(config.sampling)),
      distribution_(sampling_.make(parts_.guide)) {}

/// Eye ray sample_ of pixel_: what it sees, and the points to shade with their gather rays.
void PixelPaths::follow_eye_ray(const Strata& strata) {
    const auto column = static_cast<float>(pixel_ % config_.width),
               row = static_cast<float>(pixel_ / config_.width);
    radiance_ = {};
    shaded_points_ = 0;
    Sampler sampler(config_.seed, Stream::eye, pixel_, sample_);
    float x = 0.5f, y = 0.5f;
    if (config_.samples > 1 || config_.jitter) {
        const Strata::Point place = strata.sample(sample_, sampler);
        x = place.along_columns;
        y = place.along_rows;
    }
    follow_eye(scene_.camera.position, plane_.direction(column + x, row + y), {1, 1, 1}, 0, true, sampler);
    if (config_.visualisation == Visualisation::final_gather && config_.gather_rays > 0)
        share_gather_rays(std::max(1u, config_.gather_rays / config_.samples +
                                           (sample_ < config_.gather_rays % config_.samples ? 1 : 0)));
}

void PixelPaths::look(std::uint32_t pixel, std::vector<DiffusePoint>& found) {
    pixel_ = pixel;
    const Strata strata(config_.samples);
    for (sample_ = 0; sample_ < config_.samples; ++sample_) {
        follow_eye_ray(strata);
        for (std::uint32_t i = 0; i < shaded_points_; ++i)
            if (const Material& material = *shaded_[i].material;
                material.kind == MaterialKind::diffuse && !is_black(material) && shaded_[i].gather_rays > 0)
                found.push_back({shaded_[i], pixel_, sample_, i});
    }
}

void PixelPaths::run(std::uint32_t pixel) {
    pixel_ = pixel;
    const Strata strata(config_.samples);
    for (sample_ = 0; sample_ < config_.samples; ++sample_) {
        follow_eye_ray(strata);
        for (std::size_t i = 0; i < shaded_points_; ++i) {
            if (config_.visualisation == Visualisation::direct) {
                ask(work_.queries, shaded_[i], Layer::indirect);
            } else {
                const Shaded& at = shaded_[i];
                const bool gathers = at.gather_rays > 0 && !is_black(*at.material) && !add_recorded_light(at);
                if (gathers) {
                    distribution_->look({{at.material, at.normal, at.to_viewer},
                                         at.position,
                                         caster_.offset(at.position, at.side)});
                    if (parts_.guide_queries) ask(work_.guide_queries, at, Layer::indirect);
                }
                add_direct_light(at, i);
                if (gathers) add_gather_rays(at, i);
            }
            if (parts_.caustics) ask(work_.caustic_queries, shaded_[i], Layer::caustic);
        }
        LayeredRadiance& seen = work_.radiance.emplace_back();
        for (std::size_t l = 0; l < seen.size(); ++l)
            seen[l] = {static_cast<float>(radiance_[l][0]), static_cast<float>(radiance_[l][1]),
                       static_cast<float>(radiance_[l][2])};
    }
}

void PixelPaths::count(RayKind kind, Vec3 origin, Vec3 direction, float extent) {
    const auto k = static_cast<std::size_t>(kind);
    ++work_.ray_counts[k];
    if (!parts_.rays) return;
    Rays& rays = work_.rays[k];
    rays.origin.push_back(origin);
    rays.direction.push_back(direction);
    rays.extent.push_back(extent);
    rays.pixel.push_back(pixel_);
}

void PixelPaths::add(Stage stage, Layer layer, Vec3 radiance) {
    radiance = work_.nonfinite.checked(stage, radiance);
    std::array<double, 3>& sum = radiance_[static_cast<std::size_t>(layer)];
    for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += static_cast<double>(radiance[c]);
}

/// Light that the surface itself sends towards the ray's origin.
Vec3 PixelPaths::emitted(const Hit& hit, bool front) const {
    const std::int32_t light = scene_.triangle_light[hit.triangle];
    return light < 0 || !front ? Vec3{} : scene_.lights[static_cast<std::size_t>(light)].radiance;
}

/// Random numbers of a shaded point: those of the pixel, its eye ray and the point's number.
std::uint64_t PixelPaths::stream_index(std::size_t shaded) const {
    return (sample_ * shaded_.size() + shaded) << 32 | pixel_;
}

PixelPaths::Branch PixelPaths::mirrored(const Hit& hit, const Surface& at, Vec3 incoming,
                                        Vec3 throughput) const {
    return {caster_.offset(hit.position, at.side), reflected(at, incoming), throughput};
}

/// The refracted branch of a dielectric; false at total internal reflection. Radiance shrinks by the square
/// of the index that the light leaves behind (Veach 1997, section 5.2).
bool PixelPaths::transmitted(const Hit& hit, const Surface& at, Vec3 incoming, Vec3 throughput,
                             Branch& branch) const {
    Vec3 direction;
    if (!refracted(at, incoming, direction)) return false;
    branch = {caster_.offset(hit.position, -at.side), direction, throughput * (1 / (at.eta() * at.eta()))};
    return true;
}

/// One branch of a specular surface, chosen by Fresnel's share.
PixelPaths::Branch PixelPaths::choose_specular(const Hit& hit, const Surface& at, Vec3 incoming,
                                               Vec3 throughput, Sampler& sampler) const {
    if (at.material->kind == MaterialKind::mirror)
        return mirrored(hit, at, incoming, throughput * at.material->specular);
    Branch through;
    const float share = fresnel(dot(incoming, at.normal), at.eta());
    if (sampler.uniform() >= share && transmitted(hit, at, incoming, throughput, through)) return through;
    return mirrored(hit, at, incoming, throughput);
}

/// Follows an eye path through specular surfaces to the points that are shaded. The first dielectric splits
/// the path.
void PixelPaths::follow_eye(Vec3 origin, Vec3 direction, Vec3 throughput, std::uint32_t specular,
                            bool may_split, Sampler& sampler) {
    for (;;) {
        count(specular == 0 ? RayKind::eye : RayKind::specular, origin, direction, unlimited);
        const std::optional<Hit> hit = caster_.closest(origin, direction);
        if (!hit) return;
        const Vec3 incoming = -direction;
        const Surface at = surface_at(scene_, *hit, incoming);
        add(Stage::eye, specular == 0 ? Layer::direct : Layer::specular,
            throughput * emitted(*hit, at.front));
        if (!is_specular(*at.material)) {
            if (shaded_points_ < shaded_.size())
                shaded_[shaded_points_++] = {hit->position, at.normal,   at.side,       incoming,
                                             throughput,    at.material, hit->triangle, specular > 0};
            return;
        }
        if (++specular > config_.max_specular) return;
        Branch next;
        if (at.material->kind == MaterialKind::dielectric && may_split) {
            may_split = false;
            const float share = fresnel(dot(incoming, at.normal), at.eta());
            if (transmitted(*hit, at, incoming, throughput * (1 - share), next)) {
                const Branch mirror = mirrored(*hit, at, incoming, throughput * share);
                follow_eye(mirror.origin, mirror.direction, mirror.throughput, specular, false, sampler);
            } else {
                next = mirrored(*hit, at, incoming, throughput);
            }
        } else {
            next = choose_specular(*hit, at, incoming, throughput, sampler);
        }
        origin = next.origin;
        direction = next.direction;
        throughput = next.throughput;
    }
}

void PixelPaths::ask(Queries& queries, const Shaded& at, Layer layer) {
    if (is_black(*at.material)) return;
    queries.position.push_back(at.position);
    queries.direction.push_back(-at.to_viewer);
    queries.weight.push_back(at.throughput);
    queries.pixel.push_back(pixel_);
    queries.triangle.push_back(at.triangle);
    queries.normal.push_back(at.normal);
    queries.sample.push_back(sample_);
    queries.layer.push_back(at.specular ? Layer::specular : layer);
}

/// Where the light of an area light is looked for by shadow rays and by gather rays both, as on a glossy
/// surface, each is weighted by the balance heuristic (Veach 1997, section 9.2.2): `density` is that of all
/// samples of one kind together, per area or solid angle.
double PixelPaths::light_density(std::uint32_t light) const {
    if (config_.shadow_rays == 0) return 0;
    return config_.shadow_rays * (scene_.lights.size() <= lights_sampled_each
                                      ? lights_.density(light)
                                      : lights_sampled_each * lights_.pdf_area(view_, light));
}

void PixelPaths::add_direct_light(const Shaded& at, std::size_t number) {
    const std::uint32_t rays = config_.shadow_rays;
    if (rays == 0 || is_black(*at.material)) return;
    const Vec3 origin = caster_.offset(at.position, at.side);
    if (scene_.lights.size() <= lights_sampled_each) {
        const Strata strata(rays);
        for (std::uint32_t l = 0; l < scene_.lights.size(); ++l) {
            Sampler sampler(config_.seed, Stream::shadow, stream_index(number), l);
            for (std::uint32_t i = 0; i < rays; ++i) {
                const Strata::Point cell = strata.sample(i, sampler);
                const LightPoint point = lights_.sample_light(l, cell.along_columns, cell.along_rows);
                add_light_of(at, origin, point, rays * point.pdf);
            }
        }
        return;
    }
    lights_.look(at.position, at.side, view_);
    if (view_.dark()) return;
    Sampler sampler(config_.seed, Stream::shadow, stream_index(number));
    const std::uint32_t all = rays * lights_sampled_each;
    for (std::uint32_t i = 0; i < all; ++i) {
        const double choice = (i + static_cast<double>(sampler.uniform())) / all;
        const float u = sampler.uniform(), v = sampler.uniform();
        LightPoint point;
        if (lights_.sample(view_, choice, u, v, point)) add_light_of(at, origin, point, all * point.pdf);
    }
}

/// `density`: of all shadow rays of the point, per area of the light.
void PixelPaths::add_light_of(const Shaded& at, Vec3 origin, const LightPoint& point, double density) {
    const Vec3 target = caster_.offset(point.position, point.normal);
    const Vec3 path = target - origin;
    const float distance2 = dot(path, path), distance = std::sqrt(distance2);
    if (!(distance > 0) || !(density > 0)) return;
    const Vec3 direction = path * (1 / distance);
    const float cos_light = -dot(point.normal, direction);
    if (cos_light <= 0 || dot(at.side, direction) <= 0) return;
    const Vec3 f = brdf(*at.material, at.normal, direction, at.to_viewer);
    if (f == Vec3{}) return;
    count(RayKind::shadow, origin, direction, distance);
    if (caster_.occluded(origin, direction, distance)) return;
    const double to_solid_angle = static_cast<double>(distance2) / cos_light;
    double all = density * to_solid_angle;
    if (at.material->kind == MaterialKind::glossy && at.gather_rays > 0)
        all += at.gather_rays * distribution_->pdf(direction);
    add(Stage::shadow, at.specular ? Layer::specular : Layer::direct,
        at.throughput * f * point.radiance *
            static_cast<float>(static_cast<double>(dot(at.normal, direction)) / all));
}

/// Gives each shaded point of the eye ray its share of the gather rays, by its throughput, and one at least.
void PixelPaths::share_gather_rays(std::uint32_t rays) {
    float total = 0;
    for (std::size_t i = 0; i < shaded_points_; ++i) total += sum_of_channels(shaded_[i].throughput);
    if (!(total > 0)) return;
    std::uint32_t left = rays;
    for (std::size_t i = 0; i < shaded_points_; ++i) {
        const auto fair = static_cast<std::uint32_t>(
            std::lround(sum_of_channels(shaded_[i].throughput) / total * static_cast<float>(rays)));
        const bool last = i + 1 == shaded_points_;
        shaded_[i].gather_rays = last ? std::max(left, 1u) : std::clamp(fair, 1u, std::max(left, 1u));
        left -= std::min(shaded_[i].gather_rays, left);
    }
}

std::optional<Vec3> PixelPaths::recorded_irradiance(const Shaded& at) {
    const IrradianceOctree& octree = *parts_.irradiance;
    const IrradiancePoint point{at.position, at.normal};
    if (!parts_.octree_searches) return octree.irradiance(point, octree.tolerance());
    OctreeElements<spatial::ListWalkRecorder> elements{octree_walk_, octree.nodes()};
    const std::optional<Vec3> irradiance = octree.irradiance(point, octree.tolerance(), elements);
    work_.octree_searches.add(at.position, pixel_, octree_walk_);
    return irradiance;
}

/// Whether records of irradiance say what a diffuse point's gather rays would bring.
bool PixelPaths::add_recorded_light(const Shaded& at) {
    if (!parts_.irradiance || at.material->kind != MaterialKind::diffuse) return false;
    const std::optional<Vec3> irradiance = recorded_irradiance(at);
    if (!irradiance) {
        ++work_.irradiance.not_served;
        return false;
    }
    ++work_.irradiance.served;
    work_.irradiance.rays_saved += at.gather_rays;
    add(Stage::gather, at.specular ? Layer::specular : Layer::indirect,
        at.throughput * at.material->diffuse * *irradiance * std::numbers::inv_pi_v<float>);
    return true;
}

void PixelPaths::gather_hemisphere(const DiffusePoint& point, const HemisphereGrid& grid,
                                   std::span<Incoming> incoming, std::span<std::uint32_t> query) {
    pixel_ = point.pixel;
    sample_ = point.sample;
    const Shaded& at = point.at;
    const Frame frame(at.normal);
    for (std::uint32_t cell = 0; cell < grid.cells(); ++cell) {
        Sampler sampler(config_.seed, Stream::irradiance, stream_index(point.number), cell);
        const float u = sampler.uniform(), v = sampler.uniform();
        incoming[cell] = {};
        incoming[cell].direction = frame.to_world(grid.direction(cell, u, v));
        query[cell] = no_query;
        if (dot(incoming[cell].direction, at.side) <= 0) continue;
        radiance_ = {};
        const std::size_t queries = work_.queries.size();
        incoming[cell].distance =
            follow_gather(at, {incoming[cell].direction, {1, 1, 1}, 0, grid.place(cell)}, sampler);
        Vec3d light;
        for (const std::array<double, 3>& layer : radiance_) light += Vec3d{layer[0], layer[1], layer[2]};
        incoming[cell].radiance = trace::to_float(light);
        if (work_.queries.size() > queries) query[cell] = static_cast<std::uint32_t>(queries);
    }
}

void PixelPaths::add_gather_rays(const Shaded& at, std::size_t number) {
    const std::uint32_t rays = at.gather_rays;
    const Strata strata(rays, sampling_.strata());
    const bool glossy = at.material->kind == MaterialKind::glossy;
    // The strata are visited in a random sequence: the paper's naive order knows no coherence inside a pixel.
    Sampler shuffle(config_.seed, Stream::gather, stream_index(number));
    sequence_.resize(rays);
    for (std::uint32_t i = 0; i < rays; ++i) {
        const std::uint32_t j = shuffle.below(i + 1);
        sequence_[i] = sequence_[j];
        sequence_[j] = i;
    }
    for (std::uint32_t ray = 0; ray < rays; ++ray) {
        Sampler sampler(config_.seed, Stream::gather, stream_index(number), ray + 1);
        const Strata::Point cell = strata.sample(sequence_[ray], sampler);
        GatherSample found;
        if (!distribution_->sample(cell, sampler, found)) continue;
        const Vec3 direction = found.direction;
        const double density = rays * found.density, divisor = rays * found.divisor;
        const Vec3 weight =
            found.is_cosine && !glossy
                ? at.throughput * at.material->diffuse * (1 / static_cast<float>(rays))
                : at.throughput * brdf(*at.material, at.normal, direction, at.to_viewer) *
                      static_cast<float>(static_cast<double>(dot(at.normal, direction)) / divisor);
        if (!trace::is_finite(weight) || !trace::is_finite(direction)) {
            work_.nonfinite.count(Stage::gather);
            continue;
        }
        if (dot(direction, at.side) <= 0 || weight == Vec3{}) continue;
        follow_gather(at, {direction, weight, glossy ? density : 0, strata.place(sequence_[ray])}, sampler);
    }
}

float PixelPaths::follow_gather(const Shaded& at, const GatherRay& ray, Sampler& sampler) {
    Vec3 origin = caster_.offset(at.position, at.side), direction = ray.direction, weight = ray.weight;
    const double density = ray.density;
    float distance = unlimited;
    for (std::uint32_t specular = 0;; ++specular) {
        count(specular == 0 ? RayKind::gather : RayKind::specular, origin, direction, unlimited);
        const std::optional<Hit> hit = caster_.closest(origin, direction);
        if (!hit) return distance;
        if (specular == 0) distance = hit->distance;
        const Vec3 incoming = -direction;
        const Surface met = surface_at(scene_, *hit, incoming);
        const Vec3 light = emitted(*hit, met.front);
        if (light != Vec3{}) {
            if (specular == 0 && density > 0) {
                const double from_light =
                    light_density(static_cast<std::uint32_t>(scene_.triangle_light[hit->triangle])) *
                    static_cast<double>(hit->distance) * hit->distance /
                    static_cast<double>(dot(incoming, met.side));
                add(Stage::gather, at.specular ? Layer::specular : Layer::direct,
                    weight * light * static_cast<float>(density / (density + from_light)));
            } else if (specular > 0 && !parts_.caustics) {
                add(Stage::gather, at.specular ? Layer::specular : Layer::caustic, weight * light);
            }
        }
        if (!is_specular(*met.material)) {
            if (is_black(*met.material)) return distance;
            Queries& queries = work_.queries;
            queries.position.push_back(hit->position);
            queries.direction.push_back(direction);
            queries.weight.push_back(weight);
            queries.pixel.push_back(pixel_);
            queries.stratum.push_back(ray.stratum);
            queries.triangle.push_back(hit->triangle);
            queries.normal.push_back(met.normal);
            queries.sample.push_back(sample_);
            queries.layer.push_back(at.specular ? Layer::specular : Layer::indirect);
            return distance;
        }
        if (specular == config_.max_specular) return distance;
        const Branch next = choose_specular(*hit, met, incoming, weight, sampler);
        origin = next.origin;
        direction = next.direction;
        weight = next.throughput;
    }
}

}  // namespace regather::capture
