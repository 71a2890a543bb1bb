// Light that bounces ten thousand times, that comes through a keyhole, and that is a million million times
// weaker than another: against enclosure theory.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/photon_pass.h"
#include "study/case.h"
#include "study/rendering.h"
#include "study/room.h"

namespace regather::study {
namespace {

constexpr double pi = std::numbers::pi;

/// Every wall emits 1 and reflects `albedo`: 1 / (1 - albedo) everywhere, for the albedo as a float.
Case furnace_by_paths(double albedo, std::uint32_t samples) {
    return {fmt::format("closed box of albedo {}, path tracer", albedo),
            "relative error of the radiance",
            "4.5 sigma of the samples, and 2^-22 a bounce for the float albedo",
            [=](Effort effort) {
                const double truth = 1 / (1 - double{static_cast<float>(albedo)});
                const Estimate found = path_traced(
                    furnace(albedo).scene, 8, effort == Effort::quick ? std::max(4u, samples / 40) : samples);
                if (found.counts.cut_off > 0 || found.counts.nonfinite.total() > 0)
                    return Reading{INFINITY, 0};
                return sampled(std::fabs(found.mean - truth) / truth, truth * 0x1p-22,
                               found.standard_error / truth);
            },
            false,
            albedo > 0.9995};
}

/// Of the same box: all power that photons bring to walls, over what the lights sent.
Case furnace_by_photons(double albedo) {
    return {fmt::format("closed box of albedo {}, photon map", albedo),
            "relative error of the stored power",
            "4.5 sigma: as many independent paths as photons x (1 - albedo)",
            [=](Effort effort) {
                const scenes::Scene scene = furnace(albedo).scene;
                const capture::RayCaster caster(scene);
                const capture::LightSampler lights(scene);
                capture::PhotonConfig config;
                config.photons = effort == Effort::quick ? 50'000 : 4'000'000;
                const capture::PhotonPass pass = trace_photons(scene, caster, lights, config);
                const double a = static_cast<float>(albedo), truth = 1 / (1 - a);
                // The last path ends early: what it had left is cut_off.
                const double found = (pass.tally.stored[0] + pass.tally.cut_off[0]) / pass.tally.emitted[0];
                const auto paths = static_cast<double>(pass.tally.paths);
                const double escaped = pass.tally.escaped[0];
                return sampled(escaped > 0 ? INFINITY : std::fabs(found - truth) / truth,
                               truth * 0x1p-22 + 1 / paths, std::sqrt(a / paths), albedo > 0.985 ? 0.3 : 0.1);
            },
            false,
            albedo > 0.995};
}

/// And its picture by density estimation at the wall: albedo / (1 - albedo) beside the emission.
Reading furnace_picture(Effort effort) {
    const double a = 0.9f, truth = 1 / (1 - a);
    capture::CaptureConfig config;
    config.pixels.width = config.pixels.height = 16;
    config.pixels.visualisation = capture::Visualisation::direct;
    config.pixels.shadow_rays = 64;
    config.photon.photons = effort == Effort::quick ? 100'000 : 1'000'000;
    config.gather.k = effort == Effort::quick ? 2'000 : 10'000;
    const capture::Captured captured = capture::capture(furnace(a).scene, config);
    double sum = 0;
    for (const trace::Vec3 pixel : captured.image.pixels) sum += double{pixel.x};
    const double k = config.gather.k, paths = config.photon.photons * (1 - a);
    return sampled(std::fabs(sum / 256 - truth) / truth, 0, std::sqrt(1 / k) + std::sqrt(1 / paths), 0.15);
}

/// Irradiance under the middle of a square of edge s and radiance 1 that is at distance 1 and parallel (form
/// factors of a rectangle: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-4).
double irradiance_below(double s) {
    const double x = s / 2, r = std::sqrt(1 + x * x);
    return 4 * (1 / (2 * pi)) * 2 * (x / r * std::atan(x / r)) * pi;
}

/// A black room of 1 m with a hole in its ceiling and a radiance of 1 above all of it; the camera sees the
/// middle of the floor.
scenes::Scene keyhole(double share) {
    Room room;
    const std::uint32_t black = room.diffuse(0), floor = room.diffuse(0.5);
    const double s = std::sqrt(share), low = 0.5 - s / 2, high = 0.5 + s / 2;
    room.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, floor);
    room.quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, black);
    room.quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, black);
    room.quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, black);
    room.quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, black);
    room.quad({0, 0, 1}, {0, low, 0}, {1, 0, 0}, black);
    room.quad({0, high, 1}, {0, 1 - high, 0}, {1, 0, 0}, black);
    room.quad({0, low, 1}, {0, s, 0}, {low, 0, 0}, black);
    room.quad({high, low, 1}, {0, s, 0}, {1 - high, 0, 0}, black);
    room.light({0, 0, 1.01}, {0, 1, 0}, {1, 0, 0}, 1, black);
    room.look({0.9, 0.5, 0.5}, {0.5, 0.5, 0}, 0.01);
    return room.scene;
}

Case keyhole_by_paths(double share, std::uint32_t samples) {
    return {fmt::format("keyhole of {:g} of the wall, path tracer", share),
            "relative error of the radiance",
            "4.5 sigma of the samples",
            [=](Effort effort) {
                const double truth = 0.5 / pi * irradiance_below(std::sqrt(share));
                const Estimate found = path_traced(
                    keyhole(share), 16, effort == Effort::quick ? std::max(256u, samples / 64) : samples);
                return sampled(std::fabs(found.mean - truth) / truth, 1e-3, found.standard_error / truth,
                               share < 5e-5 ? 0.7 : 0.2);
            },
            false,
            share < 5e-3};
}

/// Power that photons bring to the floor: hole area x irradiance of the floor as the hole's points see it.
Case keyhole_by_photons(double share) {
    return {fmt::format("keyhole of {:g} of the wall, photon map", share),
            "relative error of the floor's power",
            "4.5 sigma of the photons that come through",
            [=](Effort effort) {
                const scenes::Scene scene = keyhole(share);
                const capture::RayCaster caster(scene);
                const capture::LightSampler lights(scene);
                capture::PhotonConfig config;
                config.photons = effort == Effort::quick ? 250'000 : 10'000'000;
                const capture::PhotonPass pass = trace_photons(scene, caster, lights, config);
                double found = 0, through = 0;
                for (const trace::Photon& photon : pass.photons)
                    if (photon.position.z < 0.5f && photon.position.z > -0.5f &&
                        std::fabs(photon.position.z) < 1e-4f) {
                        found += double{trace::decode_power(photon.power).x};
                        ++through;
                    }
                // E of the floor as a unit square at distance 1, from points of the hole: the four rectangles
                // around its foot.
                const double s = std::sqrt(share);
                const auto corner = [](double x, double y) {
                    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
                    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / 2;  // times pi / pi
                };
                double mean = 0;
                constexpr int fine = 16;
                for (int i = 0; i < fine; ++i)
                    for (int j = 0; j < fine; ++j) {
                        const double x = 0.5 + s * ((i + 0.5) / fine - 0.5),
                                     y = 0.5 + s * ((j + 0.5) / fine - 0.5);
                        mean += (corner(x, y) + corner(1 - x, y) + corner(x, 1 - y) + corner(1 - x, 1 - y)) /
                                (fine * fine);
                    }
                const double truth = share * mean;
                return sampled(std::fabs(found - truth) / truth, 1.0 / 256,
                               1 / std::sqrt(std::max(through, 1.0)), share < 5e-4 ? 0.35 : 0.2);
            },
            false,
            share < 5e-3};
}

/// Two black rooms with a light each, one 1e12 times as strong as the other; the camera is in the weak one's.
scenes::Scene two_rooms(double strong, double weak) {
    Room room;
    const std::uint32_t black = room.diffuse(0), floor = room.diffuse(0.5);
    room.walls({2, 0, 0}, {3, 1, 1}, floor);
    room.light({2.4, 0.4, 0.99}, {0, 0.2, 0}, {0.2, 0, 0}, strong, black);
    room.quad({-4.5, -4.5, 2}, {0, 10, 0}, {10, 0, 0}, black);
    room.quad({-0.5, -0.5, 0}, {2, 0, 0}, {0, 2, 0}, floor);
    room.light({0.25, 0.25, 1}, {0, 0.5, 0}, {0.5, 0, 0}, weak, black);
    room.look({0.9, 0.5, 0.4}, {0.5, 0.5, 0}, 0.01);
    return room.scene;
}

Reading weak_light_by_paths(Effort effort) {
    const double weak = 1e-6, truth = weak * 0.5 / pi * irradiance_below(0.5);
    const Estimate found = path_traced(two_rooms(1e6, weak), 16, effort == Effort::quick ? 64 : 4'000);
    return sampled(std::fabs(found.mean - truth) / truth, 1e-3, found.standard_error / truth, 0.13);
}

Reading weak_light_by_photon_mapper(Effort) {
    const double weak = 1e-6, truth = weak * 0.5 / pi * irradiance_below(0.5);
    capture::CaptureConfig config;
    config.pixels.width = config.pixels.height = 16;
    config.pixels.shadow_rays = 64;
    config.photon.photons = 10'000;
    const capture::Captured captured = capture::capture(two_rooms(1e6, weak), config);
    double sum = 0;
    for (const trace::Vec3 pixel : captured.layers[capture::Layer::direct].pixels) sum += double{pixel.x};
    return {std::fabs(sum / 256 - truth) / truth, 0.01};
}

/// One light of radiance 1e6 beside a million million weaker one on the same floor: the weak one must not be
/// lost when it is alone, nor disturb the strong one.
Reading strong_beside_weak(Effort effort) {
    Room room;
    const std::uint32_t black = room.diffuse(0), floor = room.diffuse(0.5);
    room.quad({-0.5, -0.5, 0}, {2, 0, 0}, {0, 2, 0}, floor);
    room.light({0.25, 0.25, 1}, {0, 0.5, 0}, {0.5, 0, 0}, 1e6, black);
    room.light({0.8, 0.25, 1}, {0, 0.5, 0}, {0.5, 0, 0}, 1e-6, black);
    room.look({0.9, 0.5, 0.4}, {0.5, 0.5, 0}, 0.01);
    const double truth = 1e6 * 0.5 / pi * irradiance_below(0.5);
    const Estimate found = path_traced(room.scene, 16, effort == Effort::quick ? 64 : 1'000);
    return sampled(std::fabs(found.mean - truth) / truth, 1e-3, found.standard_error / truth, 0.13);
}

}  // namespace

std::vector<Case> stiff_transport_cases() {
    std::vector<Case> cases{furnace_by_paths(0.9, 2'000), furnace_by_paths(0.99, 400),
                            furnace_by_paths(0.999, 100), furnace_by_paths(0.9999, 10)};
    for (const double albedo : {0.9, 0.99, 0.999, 0.9999}) cases.push_back(furnace_by_photons(albedo));
    cases.push_back({"closed box of albedo 0.9, picture by photons", "relative error of the radiance",
                     "4.5 sigma of the k photons and of the paths", furnace_picture});
    for (const double share : {1e-2, 1e-3, 1e-4, 1e-5})
        cases.push_back(keyhole_by_paths(share, static_cast<std::uint32_t>(std::min(20'000.0, 20 / share))));
    for (const double share : {1e-2, 1e-3, 1e-4}) cases.push_back(keyhole_by_photons(share));
    cases.push_back({"a light of 1e-12 of another's power, path tracer", "relative error of the radiance",
                     "4.5 sigma of the samples", weak_light_by_paths});
    cases.push_back({"a light of 1e-12 of another's power, photon mapper",
                     "relative error of the direct light", "64 stratified shadow rays a pixel",
                     weak_light_by_photon_mapper});
    cases.push_back({"a light beside one of 1e-12 of its power", "relative error of the radiance",
                     "4.5 sigma of the samples", strong_beside_weak});
    return cases;
}

}  // namespace regather::study
