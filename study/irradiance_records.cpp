// Records of irradiance where nothing is met, where it is dark, on an edge, and at any scale: against closed
// forms, and against themselves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "capture/irradiance/irradiance_metric.h"
#include "capture/irradiance/irradiance_octree.h"
#include "capture/sampler.h"
#include "study/case.h"

namespace regather::study {
namespace {

using trace::Vec3, trace::Vec3d;

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t grid_rows = 24, grid_columns = 75;

/// What is met in a direction from the origin, whose normal is z.
using Seen = std::function<void(capture::Incoming& sample)>;

capture::IrradianceRecord record_of(const capture::IrradianceMetric& metric, const Seen& seen, double scale) {
    const capture::HemisphereGrid grid(grid_rows, grid_columns);
    const capture::IrradiancePoint point{{}, {0, 0, 1}};
    const capture::Frame frame(point.normal);
    std::vector<capture::Incoming> incoming(grid.cells());
    for (std::uint32_t cell = 0; cell < grid.cells(); ++cell) {
        capture::Sampler sampler(23, capture::Stream::irradiance, 0, cell);
        const float u = sampler.uniform(), v = sampler.uniform();
        incoming[cell].direction = frame.to_world(grid.direction(cell, u, v));
        seen(incoming[cell]);
    }
    return make_record(capture::parse_irradiance_cache(metric.name),
                       {grid, point, incoming, 0.003 * scale, 4 * scale});
}

bool is_finite(const capture::IrradianceRecord& record) {
    bool all = std::isfinite(record.longer) && std::isfinite(record.shorter) && record.shorter >= 0;
    for (const Vec3 v : {record.irradiance, record.axis}) all = all && trace::is_finite(v);
    for (const Vec3 v : record.rotation) all = all && trace::is_finite(v);
    for (const Vec3 v : record.translation) all = all && trace::is_finite(v);
    return all;
}

/// What the record says of a point beside its own, by way of an octree; NaN where anything is not finite.
double told_beside(const capture::IrradianceRecord& record, double scale) {
    if (!is_finite(record)) return NAN;
    const auto side = static_cast<float>(4 * scale);
    capture::IrradianceOctree octree(trace::Bounds3{{-side, -side, -side}, {side, side, side}}, 0.2, true);
    octree.insert(record);
    const float step = std::fmin(static_cast<float>(1e-4 * scale), record.shorter / 20);
    const auto told = octree.irradiance({{step, step, 0}, {0, 0, 1}}, 0.2);
    return told ? double{told->y} : NAN;
}

/// The largest error of all metrics; NaN where one is.
Reading of_all_metrics(double allowed, const std::function<double(const capture::IrradianceMetric&)>& error) {
    double largest = 0;
    for (const capture::IrradianceMetric& metric : capture::irradiance_metrics())
        if (const double found = error(metric); !(found <= largest)) largest = found;
    return {largest, allowed};
}

Case told_by(std::string name, Seen seen, double truth, double allowed, std::string reason) {
    return {std::move(name), "error of the irradiance beside a record", std::move(reason), [=](Effort) {
                return of_all_metrics(allowed, [&](const capture::IrradianceMetric& metric) {
                    return std::fabs(told_beside(record_of(metric, seen, 1), 1) - truth);
                });
            }};
}

/// On the floor at a wall x = distance of radiance 1; the sky is dark and nothing is met there.
Seen wall_at(double distance) {
    return [=](capture::Incoming& sample) {
        if (!(sample.direction.x > 0)) return;
        sample.distance = static_cast<float>(distance / static_cast<double>(sample.direction.x));
        sample.radiance = {1, 1, 1};
    };
}

/// A bright ceiling behind a dark beam, all of it so many times as large.
Case scaled(double scale) {
    const auto seen = [](double by) {
        return [by](capture::Incoming& sample) {
            const auto z = static_cast<double>(sample.direction.z),
                       x = static_cast<double>(sample.direction.x);
            const bool beam = x > 0.2 * z && x < 0.6 * z;
            sample.distance = static_cast<float>(by * (beam ? 0.5 : 1) / z);
            sample.radiance = beam ? Vec3{} : Vec3{1, 2, 3};
        };
    };
    return {
        fmt::format("a record of a scene {:g} times as large", scale),
        "relative error of reach, and of the change over it",
        "floats: 2^-24 a number, and their sums in double", [=](Effort) {
            return of_all_metrics(1e-5, [&](const capture::IrradianceMetric& metric) {
                const capture::IrradianceRecord one = record_of(metric, seen(1), 1),
                                                other = record_of(metric, seen(scale), scale);
                if (!is_finite(one) || !is_finite(other)) return double{NAN};
                const auto off = [](double found, double expected) {
                    return std::fabs(found - expected) / std::fabs(expected);
                };
                const auto change = [](const capture::IrradianceRecord& record) {
                    return trace::length(Vec3d(record.translation[1])) * static_cast<double>(record.longer);
                };
                return std::max({off(static_cast<double>(other.shorter) / scale, one.shorter),
                                 off(change(other), change(one)), off(other.irradiance.y, one.irradiance.y)});
            });
        }};
}

}  // namespace

std::vector<Case> irradiance_record_cases() {
    const Seen sky = [](capture::Incoming& sample) { sample.radiance = {1, 1, 1}; };
    const Seen dark = [](capture::Incoming& sample) { sample.distance = 1 / sample.direction.z; };
    const Seen nothing = [](capture::Incoming&) {};
    std::vector<Case> cases{
        told_by("a record where nothing is met, under an even sky", sky, pi, 1e-5, "2^-20 of pi in floats"),
        told_by("a record where no light comes from", dark, 0, 0, "sums of nothing"),
        told_by("a record where nothing is met and no light comes from", nothing, 0, 0, "sums of nothing"),
    };
    for (const double distance : {1e-3, 1e-9, 1e-30})
        cases.push_back(told_by(fmt::format("a record at {:g} of a bright wall", distance), wall_at(distance),
                                pi / 2, 0.15,
                                "half the sky: the cells on its border, and what the gradient says of a "
                                "step"));
    for (const double scale : {1e-12, 1e-6, 1e6, 1e12}) cases.push_back(scaled(scale));
    return cases;
}

}  // namespace regather::study
