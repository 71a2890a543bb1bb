// One room at all scales and places: radiance does not depend on either.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "capture/sampler.h"
#include "reorder/catalogue.h"
#include "scenes/loader.h"
#include "study/case.h"
#include "study/rendering.h"
#include "study/room.h"

namespace regather::study {
namespace {

using trace::Vec3;

const capture::Image& unmoved() {
    static const capture::Image image = photon_mapped(furnished_room().scene).image;
    return image;
}

Case placed(std::string name, const Placement& placement, double allowed, std::string reason) {
    return {std::move(name), "RMS difference of the image / its mean", std::move(reason), [=](Effort) {
                const capture::Captured captured = photon_mapped(furnished_room(placement).scene);
                if (captured.nonfinite.total() > 0) return Reading{INFINITY, allowed};
                return Reading{difference(captured.image, unmoved()), allowed};
            }};
}

/// The same scene from a file, `shift` metres away from its origin.
std::string scene_file(double shift) {
    std::string shapes;
    const auto quad = [&](double x, double y, double z, const char* u, const char* v) {
        shapes += fmt::format(
            R"({}{{"type": "quad", "material": "wall", "corner": [{}, {}, {}], "edge_u": {}, "edge_v": {}}})",
            shapes.empty() ? "" : ", ", x + shift, y - shift, z + shift, u, v);
    };
    quad(0, 0, 0, "[1, 0, 0]", "[0, 1, 0]");
    quad(0, 0, 1, "[0, 1, 0]", "[1, 0, 0]");
    quad(0, 0, 0, "[0, 0, 1]", "[1, 0, 0]");
    quad(0, 1, 0, "[1, 0, 0]", "[0, 0, 1]");
    quad(0, 0, 0, "[0, 1, 0]", "[0, 0, 1]");
    quad(1, 0, 0, "[0, 0, 1]", "[0, 1, 0]");
    quad(0.25, 0.25, 0.25, "[0.25, 0, 0]", "[0, 0.25, 0]");
    return fmt::format(
        R"({{"name": "far", "camera": {{"position": [{}, {}, {}], "target": [{}, {}, {}], "up": [0, 0, 1],
                            "vertical_fov_degrees": 65}},
                            "materials": {{"wall": {{"kind": "diffuse", "diffuse": [0.6, 0.6, 0.6]}}}},
                            "shapes": [{}],
                            "lights": [{{"corner": [{}, {}, {}], "edge_u": [0, 0.25, 0], "edge_v": [0.25, 0, 0],
                                         "radiance": [10, 10, 10]}}]}})",
        0.5 + shift, 0.125 - shift, 0.5 + shift, 0.5 + shift, 1 - shift, 0.375 + shift, shapes, 0.375 + shift,
        0.375 - shift, 0.984375 + shift);
}

Case loaded(double shift) {
    return {
        fmt::format("from a file, {:g} of its sizes away", shift), "RMS difference of the image / its mean",
        "the loader takes the distance off in double: what is left is the rounding of a room at its origin",
        [=](Effort) {
            const auto picture = [](double by) {
                return photon_mapped(scenes::parse_scene(scene_file(by), "far.json", ".")).image;
            };
            return Reading{difference(picture(shift), picture(0)), 1e-3};
        }};
}

std::vector<Vec3> query_points(std::size_t count, const Placement& placement) {
    std::vector<Vec3> points;
    capture::Sampler sampler(3, capture::Stream::gather, 7);
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d p{sampler.fine_uniform(), sampler.fine_uniform(), sampler.fine_uniform()};
        p[static_cast<int>(sampler.below(3))] = 0;  // on three walls
        points.push_back(to_float(placement.scale * p + placement.shift));
    }
    return points;
}

std::vector<std::uint32_t> ordered(const char* curve, const std::vector<Vec3>& points) {
    std::vector<std::uint32_t> pixels(points.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint32_t>(i);
    reorder::Workload work{.position = points,
                           .direction = {},
                           .pixel = pixels,
                           .leaf_kd = {},
                           .leaf_bvh = {},
                           .bounds = trace::bounds_of(points),
                           .image_width = static_cast<std::uint32_t>(pixels.size()),
                           .image_height = 1};
    return reorder::order(*reorder::make_ordering(curve), work).permutation;
}

/// How much longer the way through the unmoved points is in the order that the moved ones give.
Case reordered(const char* curve, std::string name, const Placement& placement, double allowed,
               std::string reason) {
    return {fmt::format("{} order, {}", curve, name), "relative change of the way through the queries",
            std::move(reason), [=](Effort effort) {
                const std::size_t count = effort == Effort::quick ? 20'000 : 200'000;
                const std::vector<Vec3> points = query_points(count, {});
                const auto way = [&](const std::vector<std::uint32_t>& order) {
                    double sum = 0;
                    for (std::size_t r = 1; r < order.size(); ++r)
                        sum += double{length(points[order[r]] - points[order[r - 1]])};
                    return sum;
                };
                const double straight = way(ordered(curve, points));
                return Reading{std::fabs(way(ordered(curve, query_points(count, placement))) / straight - 1),
                               allowed};
            }};
}

}  // namespace

std::vector<Case> scale_and_place_cases() {
    std::vector<Case> cases;
    cases.push_back(placed("scaled by 2^-20", {0x1p-20, {}}, 0, "exact in floats: the same bytes"));
    cases.push_back(placed("scaled by 2^20", {0x1p20, {}}, 0, "exact in floats: the same bytes"));
    const std::string rounding = "coordinates round otherwise: single rays change at edges";
    for (const double scale : {1e-6, 1e-3, 1e3, 1e6})
        cases.push_back(placed(fmt::format("scaled by {:g}", scale), {scale, {}}, 5e-3, rounding));
    for (const double shift : {1.0, 10.0, 1e2, 1e3})
        cases.push_back(placed(fmt::format("moved by {:g} of its size, not recentred", shift),
                               {1, {shift, -shift, shift}}, 5e-3 + 20 * shift * 0x1p-17,
                               "a bound: 20 times the offset of rays, 2^-17 of the distance; the light hangs "
                               "0.01 below the ceiling"));
    for (const double shift : {1e4, 1e5, 1e6}) cases.push_back(loaded(shift));
    for (const char* curve : {"hilbert", "morton"}) {
        cases.push_back(
            reordered(curve, "scaled by 2^20", {0x1p20, {}}, 0, "exact in floats: the same order"));
        cases.push_back(reordered(curve, "scaled by 1e-6", {1e-6, {}}, 1e-3,
                                  "queries within 2^-24 of a cell's side change cells"));
        cases.push_back(reordered(curve, "scaled by 1e6", {1e6, {}}, 1e-3,
                                  "queries within 2^-24 of a cell's side change cells"));
        cases.push_back(
            reordered(curve, "moved by 1e3 of its size", {1, {1e3, -1e3, 1e3}}, 0.02,
                      "positions are 2^-14 of the size apart: smaller than the way from one to the next"));
    }
    return cases;
}

}  // namespace regather::study
