#include "capture/query_pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "capture/bsdf.h"
#include "capture/sampler.h"
#include "capture/surface.h"

namespace regather::capture {
namespace {

constexpr float unlimited = std::numeric_limits<float>::infinity();
constexpr std::uint64_t block_pixels = 64;

template <class T>
void append_to(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// A grid of `count` equal cells: rows x columns = count, as square as the divisors of `count` allow.
struct Strata {
    explicit Strata(std::uint32_t count) {
        rows = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count)));
        while (rows > 1 && count % rows != 0) --rows;
        columns = count / std::max(rows, 1u);
    }
    std::uint32_t rows = 1, columns = 1;
};

float component_sum(Vec3 v) { return v.x + v.y + v.z; }

}  // namespace

void Queries::append(const Queries& other) {
    append_to(position, other.position);
    append_to(direction, other.direction);
    append_to(weight, other.weight);
    append_to(pixel, other.pixel);
    append_to(triangle, other.triangle);
}
void Queries::clear() {
    position.clear();
    direction.clear();
    weight.clear();
    pixel.clear();
    triangle.clear();
}
void Rays::append(const Rays& other) {
    append_to(origin, other.origin);
    append_to(direction, other.direction);
    append_to(extent, other.extent);
    append_to(pixel, other.pixel);
}
void Rays::clear() {
    origin.clear();
    direction.clear();
    extent.clear();
    pixel.clear();
}
void PixelWork::append(const PixelWork& other) {
    queries.append(other.queries);
    for (std::size_t kind = 0; kind < rays.size(); ++kind) {
        rays[kind].append(other.rays[kind]);
        ray_counts[kind] += other.ray_counts[kind];
    }
    append_to(radiance, other.radiance);
}
void PixelWork::clear() {
    queries.clear();
    for (Rays& kind : rays) kind.clear();
    ray_counts = {};
    radiance.clear();
}

/// One pixel's paths.
class QueryPass::Pixel {
public:
    Pixel(const QueryPass& pass, std::uint32_t pixel, PixelWork& work)
        : pass_(pass), scene_(pass.scene_), caster_(pass.caster_), pixel_(pixel), work_(work) {}

    void run() {
        const QueryConfig& config = pass_.config_;
        const auto x = static_cast<float>(pixel_ % config.width) + 0.5f;
        const auto y = static_cast<float>(pixel_ / config.width) + 0.5f;
        const float across = 2 * x / static_cast<float>(config.width) - 1;
        const float upward = 1 - 2 * y / static_cast<float>(config.height);
        Sampler sampler(config.seed, Stream::eye, pixel_);
        const Vec3 direction = normalize(pass_.forward_ + pass_.right_ * across + pass_.up_ * upward);
        follow_eye(scene_.camera.position, direction, {1, 1, 1}, 0, true, sampler);
        for (std::size_t i = 0; i < shaded_points_; ++i) add_direct_light(shaded_[i], static_cast<std::uint32_t>(i));
        add_gather_rays();
        work_.radiance.push_back({static_cast<float>(radiance_[0]), static_cast<float>(radiance_[1]),
                                  static_cast<float>(radiance_[2])});
    }

private:
    struct Shaded {
        Vec3 position, normal, side, to_viewer, throughput;
        const Material* material;
    };
    void count(RayKind kind, Vec3 origin, Vec3 direction, float extent) {
        const auto k = static_cast<std::size_t>(kind);
        ++work_.ray_counts[k];
        if (!pass_.keep_rays_) return;
        Rays& rays = work_.rays[k];
        rays.origin.push_back(origin);
        rays.direction.push_back(direction);
        rays.extent.push_back(extent);
        rays.pixel.push_back(pixel_);
    }

    void add(Vec3 radiance) {
        for (int c = 0; c < 3; ++c) radiance_[static_cast<std::size_t>(c)] += static_cast<double>(radiance[c]);
    }

    /// Light that the surface itself sends towards the ray's origin.
    Vec3 emitted(const Hit& hit, bool front) const {
        const std::int32_t light = scene_.triangle_light[hit.triangle];
        return light < 0 || !front ? Vec3{} : scene_.lights[static_cast<std::size_t>(light)].radiance;
    }

    struct Branch {
        Vec3 origin, direction, throughput;
    };
    Branch mirrored(const Hit& hit, const Surface& at, Vec3 incoming, Vec3 throughput) const {
        return {caster_.offset(hit.position, at.side), reflected(at, incoming), throughput};
    }
    /// The refracted branch of a dielectric; false at total internal reflection. Radiance shrinks by the square of
    /// the index that the light leaves behind (Veach 1997, section 5.2).
    bool transmitted(const Hit& hit, const Surface& at, Vec3 incoming, Vec3 throughput, Branch& branch) const {
        Vec3 direction;
        if (!refracted(at, incoming, direction)) return false;
        branch = {caster_.offset(hit.position, -at.side), direction, throughput * (1 / (at.eta() * at.eta()))};
        return true;
    }
    /// One branch of a specular surface, chosen by Fresnel's share.
    Branch choose_specular(const Hit& hit, const Surface& at, Vec3 incoming, Vec3 throughput, Sampler& sampler) const {
        if (at.material->kind == MaterialKind::mirror)
            return mirrored(hit, at, incoming, throughput * at.material->specular);
        Branch through;
        const float share = fresnel(dot(incoming, at.normal), at.eta());
        if (sampler.uniform() >= share && transmitted(hit, at, incoming, throughput, through)) return through;
        return mirrored(hit, at, incoming, throughput);
    }

    /// Follows an eye path through specular surfaces to the points that are shaded. The first dielectric splits the path.
    void follow_eye(Vec3 origin, Vec3 direction, Vec3 throughput, std::uint32_t specular, bool may_split,
                    Sampler& sampler) {
        for (;;) {
            count(specular == 0 ? RayKind::eye : RayKind::specular, origin, direction, unlimited);
            const std::optional<Hit> hit = caster_.closest(origin, direction);
            if (!hit) return;
            const Vec3 incoming = -direction;
            const Surface at = surface_at(scene_, *hit, incoming);
            add(throughput * emitted(*hit, at.front));
            if (!is_specular(*at.material)) {
                if (shaded_points_ < shaded_.size())
                    shaded_[shaded_points_++] = {hit->position, at.normal, at.side, incoming, throughput, at.material};
                return;
            }
            if (++specular > pass_.config_.max_specular) return;
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

    void add_direct_light(const Shaded& at, std::uint32_t number) {
        const std::uint32_t rays = pass_.config_.shadow_rays;
        if (rays == 0) return;
        const Strata strata(rays);
        const Vec3 origin = caster_.offset(at.position, at.side);
        for (std::size_t l = 0; l < scene_.lights.size(); ++l) {
            const scenes::AreaLight& light = scene_.lights[l];
            const Vec3 light_normal = light.normal();
            const float share = light.area() / static_cast<float>(rays);
            Sampler sampler(pass_.config_.seed, Stream::shadow, pixel_,
                            number * static_cast<std::uint32_t>(scene_.lights.size()) + static_cast<std::uint32_t>(l));
            for (std::uint32_t i = 0; i < rays; ++i) {
                const float u = (static_cast<float>(i % strata.columns) + sampler.uniform()) /
                                static_cast<float>(strata.columns);
                const float v = (static_cast<float>(i / strata.columns) + sampler.uniform()) /
                                static_cast<float>(strata.rows);
                const Vec3 target = caster_.offset(light.corner + light.edge_u * u + light.edge_v * v, light_normal);
                const Vec3 path = target - origin;
                const float distance2 = dot(path, path), distance = std::sqrt(distance2);
                if (!(distance > 0)) continue;
                const Vec3 direction = path * (1 / distance);
                const float cos_light = -dot(light_normal, direction);
                if (cos_light <= 0 || dot(at.side, direction) <= 0) continue;
                const Vec3 f = brdf(*at.material, at.normal, direction, at.to_viewer);
                if (f == Vec3{}) continue;
                count(RayKind::shadow, origin, direction, distance);
                if (caster_.occluded(origin, direction, distance)) continue;
                add(at.throughput * f * light.radiance *
                    (dot(at.normal, direction) * cos_light / distance2 * share));
            }
        }
    }

    void add_gather_rays() {
        float total = 0;
        for (std::size_t i = 0; i < shaded_points_; ++i) total += component_sum(shaded_[i].throughput);
        const std::uint32_t all = pass_.config_.gather_rays;
        if (!(total > 0) || all == 0) return;
        std::uint32_t left = all;
        for (std::size_t i = 0; i < shaded_points_; ++i) {
            const float share = component_sum(shaded_[i].throughput) / total;
            const auto fair = static_cast<std::uint32_t>(std::lround(share * static_cast<float>(all)));
            const bool last = i + 1 == shaded_points_;
            const std::uint32_t rays = last ? std::max(left, 1u) : std::clamp(fair, 1u, std::max(left, 1u));
            left -= std::min(rays, left);
            add_gather_rays(shaded_[i], rays, static_cast<std::uint32_t>(i));
        }
    }

    void add_gather_rays(const Shaded& at, std::uint32_t rays, std::uint32_t number) {
        const Strata strata(rays);
        const Frame frame(at.normal);
        const Vec3 origin = caster_.offset(at.position, at.side);
        // The strata are visited in a random sequence: the paper's naive order knows no coherence inside a pixel.
        Sampler shuffle(pass_.config_.seed, Stream::gather, pixel_, number << 24);
        sequence_.resize(rays);
        for (std::uint32_t i = 0; i < rays; ++i) {
            const std::uint32_t j = shuffle.below(i + 1);
            sequence_[i] = sequence_[j];
            sequence_[j] = i;
        }
        for (std::uint32_t sample = 0; sample < rays; ++sample) {
            const std::uint32_t stratum = sequence_[sample];
            Sampler sampler(pass_.config_.seed, Stream::gather, pixel_, (number << 24) + sample + 1);
            const float u = (static_cast<float>(stratum / strata.columns) + sampler.uniform()) /
                            static_cast<float>(strata.rows);
            const float v = (static_cast<float>(stratum % strata.columns) + sampler.uniform()) /
                            static_cast<float>(strata.columns);
            const Vec3 direction = frame.to_world(cosine_hemisphere(std::min(u, 0x1.fffffep-1f), v));
            if (dot(direction, at.side) <= 0) continue;
            // f cos / (cos / pi) = pi f
            const Vec3 weight = at.throughput * brdf(*at.material, at.normal, direction, at.to_viewer) *
                                (std::numbers::pi_v<float> / static_cast<float>(rays));
            if (weight == Vec3{}) continue;
            follow_gather(origin, direction, weight, sampler);
        }
    }

    void follow_gather(Vec3 origin, Vec3 direction, Vec3 weight, Sampler& sampler) {
        for (std::uint32_t specular = 0;; ++specular) {
            count(specular == 0 ? RayKind::gather : RayKind::specular, origin, direction, unlimited);
            const std::optional<Hit> hit = caster_.closest(origin, direction);
            if (!hit) return;
            const Vec3 incoming = -direction;
            const Surface at = surface_at(scene_, *hit, incoming);
            // Light met directly is counted by the shadow rays; through a specular surface they cannot reach it.
            if (specular > 0) add(weight * emitted(*hit, at.front));
            if (!is_specular(*at.material)) {
                const bool black = at.material->diffuse == Vec3{} && at.material->specular == Vec3{};
                if (black) return;
                Queries& queries = work_.queries;
                queries.position.push_back(hit->position);
                queries.direction.push_back(direction);
                queries.weight.push_back(weight);
                queries.pixel.push_back(pixel_);
                queries.triangle.push_back(hit->triangle);
                return;
            }
            if (specular == pass_.config_.max_specular) return;
            const Branch next = choose_specular(*hit, at, incoming, weight, sampler);
            origin = next.origin;
            direction = next.direction;
            weight = next.throughput;
        }
    }

    const QueryPass& pass_;
    const Scene& scene_;
    const RayCaster& caster_;
    std::uint32_t pixel_;
    PixelWork& work_;
    std::array<double, 3> radiance_{};
    std::array<Shaded, 2> shaded_{};  // one dielectric splits an eye path
    std::size_t shaded_points_ = 0;
    std::vector<std::uint32_t> sequence_;
};

QueryPass::QueryPass(const Scene& scene, const RayCaster& caster, const QueryConfig& config, bool keep_rays)
    : scene_(scene), caster_(caster), config_(config), keep_rays_(keep_rays) {
    const scenes::Camera& camera = scene.camera;
    forward_ = normalize(camera.target - camera.position);
    const float half = std::tan(camera.vertical_fov_degrees * (std::numbers::pi_v<float> / 360));
    const Vec3 right = normalize(cross(forward_, camera.up));
    up_ = cross(right, forward_) * half;
    right_ = right * (half * static_cast<float>(config.width) / static_cast<float>(config.height));
}

void QueryPass::run(std::uint64_t first, std::uint64_t count, PixelWork& work) const {
    const std::uint64_t blocks = (count + block_pixels - 1) / block_pixels;
    std::vector<PixelWork> parts(blocks);
    tbb::parallel_for(std::uint64_t{0}, blocks, [&](std::uint64_t b) {
        const std::uint64_t end = std::min(count, (b + 1) * block_pixels);
        for (std::uint64_t i = b * block_pixels; i < end; ++i)
            Pixel(*this, static_cast<std::uint32_t>(first + i), parts[b]).run();
    });
    work.clear();
    for (const PixelWork& part : parts) work.append(part);
}

}  // namespace regather::capture
