// Faulty geometry in a room, against the clean room's picture by the same random numbers; and numbers that
// are none.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "study/case.h"
#include "study/rendering.h"
#include "study/room.h"

namespace regather::study {
namespace {

using capture::Image, trace::Vec3;

/// By both renderers.
struct Pictures {
    Image photons, paths;
    std::uint64_t nonfinite = 0;
};

Pictures pictures(const scenes::Scene& scene, Effort effort) {
    Pictures two;
    const capture::Captured captured = photon_mapped(scene);
    capture::PathCounts counts;
    two.paths = path_traced_image(scene, 32, effort == Effort::quick ? 4 : 256, counts);
    two.photons = captured.image;
    two.nonfinite = captured.nonfinite.total() + counts.nonfinite.total();
    return two;
}

double apart(const Pictures& faulty, const Pictures& clean) {
    if (faulty.nonfinite > 0) return INFINITY;
    return std::max(difference(faulty.photons, clean.photons), difference(faulty.paths, clean.paths));
}

template <class Change>
Case changed(std::string name, double allowed, std::string reason, const Change& change) {
    return {std::move(name), "RMS difference of the images / their mean", std::move(reason),
            [=](Effort effort) {
                Room room = furnished_room();
                const Pictures clean = pictures(room.scene, effort);
                change(room);
                return Reading{apart(pictures(room.scene, effort), clean), allowed};
            }};
}

/// The mean radiance against the clean room's: where the random numbers fall otherwise.
template <class Change>
Case darker_or_brighter(std::string name, double allowed, std::string reason, const Change& changed_room) {
    return {std::move(name), "relative difference of the mean radiance", std::move(reason),
            [=](Effort effort) {
                const std::uint32_t samples = effort == Effort::quick ? 16 : 2'000;
                const Estimate clean = path_traced(furnished_room().scene, 32, samples),
                               faulty = path_traced(changed_room(), 32, samples);
                const capture::Captured captured = photon_mapped(changed_room());
                if (faulty.counts.nonfinite.total() + captured.nonfinite.total() > 0)
                    return Reading{INFINITY, allowed};
                const double sigma = std::hypot(clean.standard_error, faulty.standard_error) / clean.mean;
                return sampled(std::fabs(faulty.mean - clean.mean) / clean.mean, allowed, sigma);
            }};
}

/// A wall's surface as needles: from one corner, to points 1e-5 m apart, and then the rest.
scenes::Scene with_slivers() {
    Room room = furnished_room();
    constexpr int needles = 2'000;
    constexpr double step = 1e-5;
    const std::uint32_t wall = room.scene.triangle_material[0];
    // In place of the wall x = 0, which are triangles 8 and 9.
    for (int t = 0; t < 2; ++t) {
        room.scene.triangles.erase(room.scene.triangles.begin() + 8);
        room.scene.triangle_material.erase(room.scene.triangle_material.begin() + 8);
        room.scene.triangle_light.erase(room.scene.triangle_light.begin() + 8);
    }
    for (int i = 0; i < needles; ++i)
        room.triangle({0, 0, 0}, {0, 1, i * step}, {0, 1, (i + 1) * step}, wall);
    room.triangle({0, 0, 0}, {0, 1, needles * step}, {0, 1, 1}, wall);
    room.triangle({0, 0, 0}, {0, 1, 1}, {0, 0, 1}, wall);
    return room.scene;
}

scenes::Scene with_camera(Vec3d from, Vec3d at, double fov_degrees) {
    Room room = furnished_room();
    room.look(from, at, fov_degrees);
    return room.scene;
}

/// Numbers that no scene file can hold: the pictures must be finite, and the fault must be told.
template <class Change>
Case poisoned(std::string name, const Change& change) {
    return {std::move(name), "pixels that are not finite (0.5: finite, but not told)",
            "none may; each is counted by its stage", [=](Effort effort) {
                Room room = furnished_room();
                change(room.scene);
                const Pictures two = pictures(room.scene, effort);
                double bad = 0;
                for (const Image* image : {&two.photons, &two.paths})
                    for (const Vec3 pixel : image->pixels) bad += !is_finite(pixel);
                return Reading{bad > 0 ? bad : two.nonfinite == 0 ? 0.5 : 0, 0};
            }};
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();

}  // namespace

std::vector<Case> degenerate_geometry_cases() {
    const std::string same =
        "they are never hit: the same picture, but for the order of triangles in the BVH";
    const std::string like = "which of two equal surfaces is hit makes no difference";
    const std::string mean = "4.5 sigma of the samples";
    std::vector<Case> cases;
    cases.push_back(changed("10,000 triangles without area", 1e-6, same, [](Room& room) {
        for (int i = 0; i < 10'000; ++i) {
            const double x = 0.1 + 0.00008 * i;
            room.triangle({x, 0.5, 0.5}, {x, 0.5, 0.5}, {x, 0.5, 0.5}, 0);
            room.triangle({x, 0.25, 0.5}, {x, 0.5, 0.5}, {x, 0.75, 0.5}, 0);
        }
    }));
    cases.push_back(changed("each triangle twice", 1e-3, like, [](Room& room) {
        scenes::Scene& scene = room.scene;
        const std::size_t count = scene.triangles.size();
        for (std::size_t t = 0; t < count; ++t) {
            if (scene.triangle_light[t] >= 0) continue;
            scene.triangles.push_back(scene.triangles[t]);
            scene.triangle_material.push_back(scene.triangle_material[t]);
            scene.triangle_light.push_back(-1);
        }
    }));
    cases.push_back(changed("a wall on a wall, other triangles", 1e-3, like, [](Room& room) {
        room.quad({0, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}, 0);
    }));
    cases.push_back(darker_or_brighter("a wall of 2,000 needles 1e-5 m wide", 0, mean, with_slivers));
    cases.push_back(
        darker_or_brighter("a block that stands on the floor without a gap", 2e-3,
                           mean + ", and the gap of 2 mm below the clean room's block", [] {
                               Room room = furnished_room();
                               room.block({0.55, 0.5, 0}, {0.8, 0.8, 0.4}, room.scene.triangle_material[12]);
                               return room.scene;
                           }));
    cases.push_back(darker_or_brighter("a light that touches the ceiling", 0.02,
                                       mean + ", and the light moved by 0.01 m",
                                       [] { return furnished_room({}, 0).scene; }));
    cases.push_back(darker_or_brighter("a light 1e-6 m below the ceiling", 0.02,
                                       mean + ", and the light moved by 0.01 m",
                                       [] { return furnished_room({}, 1e-6).scene; }));
    struct View {
        const char* name;
        Vec3d from, at;
        double fov;
    };
    for (const View& view : {View{"camera on a wall", {0.45, 0, 0.5}, {0.5, 0.9, 0.45}, 65},
                             View{"camera on an edge", {0.45, 0, 0}, {0.45, 1, 1}, 50},
                             View{"camera on a corner", {0, 0, 0}, {1, 1, 1}, 40},
                             View{"camera on the light", {0.45, 0.45, 0.99}, {0.5, 0.9, 0.2}, 40}}) {
        cases.push_back({view.name, "pixels that are black or not finite", "a closed room is lit everywhere",
                         [=](Effort effort) {
                             const Pictures on = pictures(with_camera(view.from, view.at, view.fov), effort);
                             double bad = static_cast<double>(on.nonfinite);
                             for (const Image* image : {&on.paths, &on.photons})
                                 for (const Vec3 pixel : image->pixels)
                                     bad += !(pixel.x > 0) || !is_finite(pixel);
                             return Reading{bad, 0};
                         }});
    }
    cases.push_back(poisoned("a light of infinite radiance", [](scenes::Scene& scene) {
        scene.lights[0].radiance = {infinity, 1, 1};
    }));
    cases.back().full_only = true;
    cases.push_back(poisoned("a light whose radiance is NaN", [](scenes::Scene& scene) {
        scene.lights[0].radiance = {1, nan, 1};
    }));
    cases.push_back(poisoned("a material whose albedo is NaN", [](scenes::Scene& scene) {
        scene.materials[1].diffuse = {nan, nan, nan};
    }));
    cases.push_back(poisoned("a material whose albedo is infinite in a channel", [](scenes::Scene& scene) {
        scene.materials[1].diffuse = {0.5f, infinity, 0.5f};
    }));
    return cases;
}

}  // namespace regather::study
