// Closed rooms, and rays that bounce about in them: none may leave, none may hit the triangle that it starts
// from.
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "capture/light/bsdf.h"
#include "capture/ray_caster.h"
#include "capture/sampler.h"
#include "scenes/loader.h"
#include "study/case.h"
#include "study/room.h"

namespace regather::study {
namespace {

using capture::RayCaster, capture::Sampler, trace::Vec3;

constexpr std::uint32_t path_rays = 1000;

enum class Aim { anywhere, edges };

struct Count {
    std::uint64_t rays = 0, left = 0, own_triangle = 0;
};

/// A random point of a random edge, a tenth of them corners; half of them missed by 1e-5 of the scene.
Vec3 point_of_an_edge(const scenes::Scene& scene, float size, Sampler& sampler) {
    const auto& triangle = scene.triangles[sampler.below(static_cast<std::uint32_t>(scene.triangles.size()))];
    const std::uint32_t corner = sampler.below(3);
    const Vec3 a = scene.vertices[triangle[corner]], b = scene.vertices[triangle[(corner + 1) % 3]];
    const float along = sampler.uniform() < 0.1f ? 0 : sampler.uniform();
    Vec3 point = a * (1 - along) + b * along;
    if (sampler.uniform() < 0.5f)
        point += Vec3{sampler.uniform() - 0.5f, sampler.uniform() - 0.5f, sampler.uniform() - 0.5f} *
                 (size * 1e-5f);
    return point;
}

/// Diffuse bounces from `start`; with Aim::edges, most of them towards edges and corners.
Count count(const scenes::Scene& scene, Vec3 start, Aim aim, std::uint64_t rays) {
    const RayCaster caster(scene);
    const float size = max_component(scene.bounds().extent());
    const std::uint64_t paths = rays / path_rays;
    std::atomic<std::uint64_t> left{0}, own{0};
    tbb::parallel_for(std::uint64_t{0}, paths, [&](std::uint64_t path) {
        Sampler sampler(5, capture::Stream::photon, path);
        Vec3 origin = start;
        Vec3 direction = capture::Frame({0, 0, path % 2 == 0 ? 1.0f : -1.0f})
                             .to_world(capture::cosine_hemisphere(sampler.uniform(), sampler.uniform()));
        std::uint32_t last = 0xffffffffu;
        for (std::uint32_t i = 0; i < path_rays; ++i) {
            const auto hit = caster.closest(origin, direction);
            if (!hit) {
                ++left;
                origin = start;
                last = 0xffffffffu;
                continue;
            }
            if (hit->triangle == last) ++own;
            last = hit->triangle;
            const Vec3 side =
                dot(hit->geometric_normal, direction) > 0 ? -hit->geometric_normal : hit->geometric_normal;
            origin = caster.offset(hit->position, side);
            const float u = sampler.uniform();
            direction =
                normalize(capture::Frame(side).to_world(capture::cosine_hemisphere(u, sampler.uniform())));
            if (aim == Aim::edges && sampler.uniform() < 0.7f) {
                const Vec3 path_to = point_of_an_edge(scene, size, sampler) - origin;
                if (dot(path_to, side) > 0) direction = normalize(path_to);
            }
        }
    });
    return {paths * path_rays, left, own};
}

/// A box of 1 m, turned so that no wall is level; `angle` below 90: a prism with that angle at one edge.
scenes::Scene closed(bool turned, double angle, const Placement& placement = {}) {
    Room room(placement);
    const std::uint32_t wall = room.diffuse(0.5);
    const double c = std::cos(0.7), s = std::sin(0.7);
    const auto turn = [&](Vec3d p) {
        if (!turned) return p;
        const double x = c * p[0] - s * p[1], y = s * p[0] + c * p[1];
        return Vec3d{x, c * y - s * p[2], s * y + c * p[2]};
    };
    if (angle == 90) {
        Room straight;
        straight.walls({0, 0, 0}, {1, 1, 1}, straight.diffuse(0.5));
        for (const auto& t : straight.scene.triangles) {
            const auto corner = [&](std::size_t i) {
                const Vec3 v = straight.scene.vertices[t[i]];
                return turn({v.x, v.y, v.z});
            };
            room.triangle(corner(0), corner(1), corner(2), wall);
        }
        return room.scene;
    }
    const double rise = std::tan(angle * std::numbers::pi / 180);
    const Vec3d a = turn({0, 0, 0}), b = turn({1, 0, 0}), e = turn({1, rise, 0});
    const Vec3d A = turn({0, 0, 1}), B = turn({1, 0, 1}), E = turn({1, rise, 1});
    room.triangle(a, b, e, wall);
    room.triangle(A, E, B, wall);
    room.triangle(a, A, B, wall);
    room.triangle(a, B, b, wall);
    room.triangle(b, B, E, wall);
    room.triangle(b, E, e, wall);
    room.triangle(a, e, E, wall);
    room.triangle(a, E, A, wall);
    return room.scene;
}

Vec3 middle(const scenes::Scene& scene) {
    Vec3 sum;
    for (const Vec3 v : scene.vertices) sum += v * (1 / static_cast<float>(scene.vertices.size()));
    return sum;
}

Reading share(const Count& found) {
    return {static_cast<double>(found.left + found.own_triangle) / static_cast<double>(found.rays), 0};
}

Case leaking(std::string name, const scenes::Scene& scene, Vec3 start, Aim aim, double rays) {
    return {std::move(name), "share of rays that leave or hit their own triangle", "none may",
            [=](Effort effort) {
                return share(count(scene, start, aim,
                                   static_cast<std::uint64_t>(effort == Effort::quick ? 2e5 : rays)));
            }};
}

}  // namespace

std::vector<Case> leak_cases() {
    std::vector<Case> cases;
    const auto add = [&](const char* name, const scenes::Scene& scene, Aim aim, double rays) {
        cases.push_back(leaking(name, scene, middle(scene), aim, rays));
    };
    add("box, 1e8 rays", closed(false, 90), Aim::anywhere, 1e8);
    add("turned box, 1e8 rays", closed(true, 90), Aim::anywhere, 1e8);
    const scenes::Scene room = scenes::load_scene("room");
    cases.push_back(leaking("scene room, 1e7 rays", room, room.camera.position, Aim::anywhere, 1e7));
    for (const double scale : {1e-6, 1e6})
        add(scale < 1 ? "turned box of 1e-6 m, 1e7 rays" : "turned box of 1e6 m, 1e7 rays",
            closed(true, 90, {scale, {}}), Aim::anywhere, 1e7);
    add("turned box, 1000 of its sizes away, 1e7 rays", closed(true, 90, {1, {1000, -1000, 500}}),
        Aim::anywhere, 1e7);
    for (const double angle : {60.0, 30.0, 10.0})
        add(angle == 60   ? "prism of 60 degrees, 1e7 rays"
            : angle == 30 ? "prism of 30 degrees, 1e7 rays"
                          : "prism of 10 degrees, 1e7 rays",
            closed(true, angle), Aim::anywhere, 1e7);
    add("box, 1e7 rays aimed at edges and corners", closed(false, 90), Aim::edges, 1e7);
    add("turned box, 1e7 rays aimed at edges and corners", closed(true, 90), Aim::edges, 1e7);
    return cases;
}

}  // namespace regather::study
