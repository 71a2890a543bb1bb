#include "capture/irradiance/irradiance_metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "trace/error.h"
#include "trace/range.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::capture {
namespace {

constexpr std::uint32_t most_spacings = 1'000'000, most_overture = 1024, most_rays = 65536,
                        most_waiting = 1'000'000;

constexpr trace::Parameter tolerance_parameter{
    "tolerance", "20", "[%] Ward's a: a record is used where d / R + sqrt(1 - n.n') is less"};
constexpr trace::Parameter gradients_parameter{
    "gradients", "1", "1: records are extrapolated by their gradients; 0: they are constant"};
constexpr trace::Parameter distance_parameter{"distance", "harmonic",
                                              "R: the harmonic mean of the distances met, or the minimum"};
constexpr trace::Parameter overture_parameter{"overture", "32",
                                              "pixels between the first points that get records; a power of "
                                              "two, halved round by round; 1: no overture"};
constexpr trace::Parameter rays_parameter{"rays", "0",
                                          "a record is made of; 0: as many as a pixel gathers with"};
constexpr trace::Parameter latency_parameter{
    "latency", "64", "points that are looked up while a record is computed, where waiting is simulated"};
constexpr trace::Parameter entries_parameter{"entries", "16", "points that can wait for records at once"};
constexpr const char* neighbours_help = "1: R is at most a neighbour's and the distance to it";

constexpr trace::Parameter split_sphere_parameters[] = {
    tolerance_parameter, distance_parameter, gradients_parameter, {"neighbours", "0", neighbours_help},
    overture_parameter,  rays_parameter,     latency_parameter,   entries_parameter};
constexpr trace::Parameter bounded_parameters[] = {
    tolerance_parameter,
    distance_parameter,
    gradients_parameter,
    {"neighbours", "1", neighbours_help},
    overture_parameter,
    rays_parameter,
    {"least", "3", "spacings of pixels that a record reaches at least"},
    {"most", "20", "spacings of pixels that a record reaches at most"},
    latency_parameter,
    entries_parameter,
};
constexpr trace::Parameter hessian_parameters[] = {
    tolerance_parameter,
    gradients_parameter,
    {"neighbours", "0", neighbours_help},
    overture_parameter,
    rays_parameter,
    {"error", "40",
     "[millionths of the scene's extent squared] what the relative error over a record's disc adds up to"},
    {"least", "1", "spacings of pixels that a record reaches at least"},
    {"most", "100", "spacings of pixels that a record reaches at most"},
    latency_parameter,
    entries_parameter,
};

PlaneEllipse circle(double radius) {
    return {radius, radius, 1, 0};
}

double split_sphere_radius(const MetricInput& input) {
    const bool minimum = input.given.choice("distance", {"harmonic", "minimum"}) == 1;
    return std::min(minimum ? input.estimate.nearest : input.estimate.harmonic_distance, input.gathered.far);
}
RecordReach split_sphere(const MetricInput& input) {
    return {circle(split_sphere_radius(input))};
}

/// Reaches between `least` and `most` spacings of pixels, where the spacing is known.
RecordReach between_spacings(const MetricInput& input, PlaneEllipse radii) {
    const double spacing = input.gathered.spacing;
    if (!(spacing > 0) || !std::isfinite(spacing)) return {radii};
    const double unit = spacing / input.tolerance, least = input.given.count("least") * unit,
                 most = input.given.count("most") * unit;
    const bool raised = radii.shorter < least;
    radii.longer = std::clamp(radii.longer, least, most);
    radii.shorter = std::clamp(radii.shorter, least, most);
    return {radii, raised};
}

RecordReach bounded(const MetricInput& input) {
    const double change = trace::length(input.estimate.brightness_translation());
    double radius = split_sphere_radius(input);
    if (change > 0) radius = std::min(radius, input.estimate.brightness() / change);
    return between_spacings(input, circle(radius));
}

RecordReach occlusion(const MetricInput& input) {
    const GatheredHemisphere& gathered = input.gathered;
    const double far = gathered.far;
    PlaneEllipse ellipse =
        ellipse_of(occlusion_hessian(gathered.grid, input.frame, gathered.incoming, far),
                   input.estimate.brightness(), input.given.count("error") * 1e-6 * far * far, far);
    ellipse.longer /= input.tolerance;
    ellipse.shorter /= input.tolerance;
    return between_spacings(input, ellipse);
}

std::span<const IrradianceMetric> metric_table() {
    static const IrradianceMetric all[] = {
        {"split-sphere", "R is the mean distance of what is met (Ward, Rubinstein & Clear 1988)",
         split_sphere_parameters, split_sphere},
        {"bounded",
         "the same, at most E / |grad E|, its reach bounded in spacings of pixels (Krivanek et al. 2006)",
         bounded_parameters, bounded},
        {"hessian", "R by how occlusion bends the irradiance, an ellipse (Schwarzhaupt et al. 2012)",
         hessian_parameters, occlusion},
    };
    return all;
}

float finite(double x) {
    constexpr double most = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(x, -most, most));
}
Vec3 finite(Vec3d v) {
    return {finite(v.x), finite(v.y), finite(v.z)};
}

}  // namespace

std::span<const IrradianceMetric> irradiance_metrics() {
    return metric_table();
}

IrradianceCacheSpec parse_irradiance_cache(std::string_view spec) {
    const auto [which, behind] = trace::named_spec("irradiance cache", spec, metric_table());
    const IrradianceMetric& metric = metric_table()[which];
    trace::Parameters given(metric.name, metric.parameters, behind);
    const auto require = [&](const char* parameter, std::uint32_t low, std::uint32_t high) {
        trace::require_range(metric.name, parameter, given.count(parameter), low, high);
    };
    require("tolerance", 1, 100);
    require("gradients", 0, 1);
    require("neighbours", 0, 1);
    require("rays", 0, most_rays);
    require("overture", 1, most_overture);
    require("latency", 0, most_waiting);
    require("entries", 1, most_waiting);
    if (!std::has_single_bit(given.count("overture")))
        throw trace::UsageError(
            fmt::format("{}: overture is {}, expected a power of two", metric.name, given.count("overture")));
    if (given.knows("distance")) given.choice("distance", {"harmonic", "minimum"});
    if (given.knows("error")) require("error", 1, 1'000'000);
    if (given.knows("least")) {
        require("most", 1, most_spacings);
        require("least", 0, given.count("most"));
    }
    std::string text = fmt::format("{}:{}", metric.name, given.text());
    return {&metric, std::move(given), std::move(text)};
}

IrradianceRecord make_record(const IrradianceCacheSpec& spec, const GatheredHemisphere& gathered) {
    const Frame frame(gathered.point.normal);
    const IrradianceEstimate estimate = estimate_irradiance(gathered.grid, frame, gathered.incoming);
    const auto [ellipse, raised] =
        spec.metric->reach({gathered, frame, estimate, spec.tolerance(), spec.parameters});
    IrradianceRecord record{gathered.point.position,
                            gathered.point.normal,
                            finite(estimate.irradiance),
                            {},
                            {},
                            frame.to_world({static_cast<float>(ellipse.x), static_cast<float>(ellipse.y), 0}),
                            finite(ellipse.longer),
                            finite(ellipse.shorter)};
    if (spec.parameters.count("gradients") == 0) return record;
    // Where it reaches further than its light allows, it says 0 to twice its irradiance there.
    const double change =
        trace::length(estimate.brightness_translation()) * reach_of(record, spec.tolerance());
    const double kept = raised && change > estimate.brightness() ? estimate.brightness() / change : 1;
    for (std::size_t c = 0; c < 3; ++c) {
        record.rotation[c] = finite(estimate.rotation[c]);
        record.translation[c] = finite(estimate.translation[c] * kept);
    }
    return record;
}

}  // namespace regather::capture
