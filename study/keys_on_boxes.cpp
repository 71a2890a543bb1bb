// Orders along space-filling curves where the box is extreme: how long the way through the queries is, and
// what a key costs.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "capture/sampler.h"
#include "reorder/catalogue.h"
#include "study/case.h"

namespace regather::study {
namespace {

using trace::Vec3;

struct Points {
    std::vector<Vec3> position;
    std::vector<std::uint32_t> pixel;
    trace::Bounds3 bounds;
    reorder::Workload workload() const {
        return {.position = position,
                .direction = {},
                .pixel = pixel,
                .leaf_kd = {},
                .leaf_bvh = {},
                .bounds = bounds,
                .image_width = static_cast<std::uint32_t>(position.size()),
                .image_height = 1};
    }
};

Points random_points(std::size_t count, Vec3 extent) {
    Points points;
    capture::Sampler sampler(11, capture::Stream::eye, count);
    for (std::size_t i = 0; i < count; ++i) {
        const float x = sampler.uniform(), y = sampler.uniform(), z = sampler.uniform();
        points.position.push_back(extent * Vec3{x, y, z});
        points.pixel.push_back(static_cast<std::uint32_t>(i));
    }
    points.bounds = trace::bounds_of(points.position);
    return points;
}

/// From query to query, in double.
double way(const Points& points, const std::vector<std::uint32_t>& order) {
    double sum = 0;
    for (std::size_t r = 1; r < order.size(); ++r) {
        const Vec3 a = points.position[order[r - 1]], b = points.position[order[r]];
        sum += std::hypot(double{a.x} - b.x, double{a.y} - b.y, double{a.z} - b.z);
    }
    return sum;
}

std::vector<std::uint32_t> ordered(const char* curve, const Points& points) {
    return reorder::order(*reorder::make_ordering(curve), points.workload()).permutation;
}

std::vector<std::uint32_t> capture_order(const Points& points) {
    std::vector<std::uint32_t> order(points.position.size());
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

bool is_permutation(std::vector<std::uint32_t> order) {
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i)
        if (order[i] != i) return false;
    return true;
}

std::size_t points_of(Effort effort) {
    return effort == Effort::quick ? 20'000 : 500'000;
}

/// The way over that of a random order; infinite when the order is none.
Case shorter(const char* curve, std::string box, Vec3 extent, double (*allowed_of)(double points),
             std::string reason) {
    return {fmt::format("{} on {}", curve, box), "way through the queries / way of a random order",
            std::move(reason), [=](Effort effort) {
                const Points points = random_points(points_of(effort), extent);
                const double allowed = allowed_of(static_cast<double>(points_of(effort)));
                const auto order = ordered(curve, points);
                if (!is_permutation(order)) return Reading{INFINITY, allowed};
                return Reading{way(points, order) / way(points, capture_order(points)), allowed};
            }};
}

double seconds_of_order(const char* curve, const Points& points) {
    const auto ordering = reorder::make_ordering(curve);
    double least = INFINITY;
    for (int i = 0; i < 5; ++i) {
        const auto start = std::chrono::steady_clock::now();
        const auto done = reorder::order(*ordering, points.workload());
        least =
            std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        if (done.permutation.size() != points.position.size()) return INFINITY;
    }
    return least;
}

Case timed(const char* curve, std::string box, Vec3 extent) {
    Case one{fmt::format("{}: time on {}", curve, box), "seconds of keys and sort / seconds on a cube",
             "no slower path; noise of the clock", [=](Effort effort) {
                 const Points cube = random_points(points_of(effort), {1, 1, 1}),
                              points = random_points(points_of(effort), extent);
                 return Reading{seconds_of_order(curve, points) / seconds_of_order(curve, cube), 2};
             }};
    one.timed = true;
    return one;
}

/// Positions far outside the bounds that the workload tells: clamped, still a permutation, and no worse than
/// random.
Reading outside(const char* curve, Effort effort) {
    Points points = random_points(points_of(effort), {1, 1, 1});
    points.bounds = {{0.4f, 0.4f, 0.4f}, {0.6f, 0.6f, 0.6f}};
    points.position[0] = {INFINITY, 0, 0};
    const auto order = ordered(curve, points);
    const bool last = order.back() == 0;
    points.position[0] = {0.5f, 0.5f, 0.5f};
    return {
        is_permutation(order) && last ? way(points, order) / way(points, capture_order(points)) : INFINITY,
        0.9};
}

/// All queries in one point: every key is equal, and the capture order must stay.
Reading one_point(const char* curve, Effort effort) {
    Points points = random_points(points_of(effort), {0, 0, 0});
    return {ordered(curve, points) == capture_order(points) ? 0.0 : 1.0, 0};
}

}  // namespace

std::vector<Case> keys_on_boxes_cases() {
    std::vector<Case> cases;
    // A random order goes a third of the length from one to the next. The curve turns round along an edge of
    // the cube: at each of the log2 n levels that part queries it may go back half of the length.
    const char* const line =
        "3 / n for n queries in order along a line, times 1 + log2(n) / 2: the curve turns round along edges";
    const auto on_line = [](double n) { return 3 / n * (1 + 0.5 * std::log2(n)); };
    const auto in_plane = [](double n) { return 5 / std::sqrt(n); };
    const auto in_cube = [](double n) { return 2.5 / std::cbrt(n); };
    for (const char* curve : {"hilbert", "morton"}) {
        cases.push_back(shorter(curve, "a cube", {1, 1, 1}, in_cube, "2.5 n^(-1/3)"));
        cases.push_back(
            shorter(curve, "a box 1e12 times as long as thin", {1e6f, 1e-6f, 1e-6f}, on_line, line));
        cases.push_back(
            shorter(curve, "a box 1e12 times as long as thin, along z", {1e-6f, 1e-6f, 1e6f}, on_line, line));
        cases.push_back(shorter(curve, "a sheet 1e12 times as wide as thin", {1e6f, 1e6f, 1e-6f}, in_plane,
                                "5 n^(-1/2)"));
        cases.push_back({fmt::format("{}: all queries in one point", curve), "queries out of capture order",
                         "ties keep it", [=](Effort effort) { return one_point(curve, effort); }});
        cases.push_back({fmt::format("{}: queries outside the bounds, one at infinity", curve),
                         "way through the queries / way of a random order",
                         "clamped to the nearest cell: most share one",
                         [=](Effort effort) { return outside(curve, effort); }});
        cases.push_back(timed(curve, "a box 1e12 times as long as thin", {1e6f, 1e-6f, 1e-6f}));
        cases.push_back(timed(curve, "one point", {0, 0, 0}));
    }
    return cases;
}

}  // namespace regather::study
