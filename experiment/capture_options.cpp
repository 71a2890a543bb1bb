#include "experiment/capture_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "reorder/catalogue.h"
#include "trace/error.h"
#include "trace/field.h"

namespace regather::experiment {
namespace {

template <class Enum, std::size_t n>
Enum chosen(const std::string& word, const std::array<const char*, n>& names, const char* what) {
    for (std::size_t i = 0; i < n; ++i)
        if (word == names[i]) return static_cast<Enum>(i);
    throw trace::UsageError(
        fmt::format("{}: found '{}', expected one of {}", what, word, fmt::join(names, ", ")));
}
float length(double value, const char* what) {
    if (!(value >= 0))
        throw trace::UsageError(
            fmt::format("{}: found {}, expected a number from 0 up; 0 or inf: unlimited", what, value));
    return value > 0 ? static_cast<float>(value) : std::numeric_limits<float>::infinity();
}

}  // namespace

capture::CaptureConfig CaptureOptions::config() const {
    capture::CaptureConfig config;
    config.pixels = {
        .width = width,
        .height = height,
        .gather_rays = gather_rays,
        .shadow_rays = shadow_rays,
        .max_specular = 16,
        .samples = samples,
        .jitter = false,
        .visualisation = chosen<capture::Visualisation>(mode, capture::visualisation_names, "mode"),
        .seed = seed};
    config.photon = {.photons = photons, .seed = seed};
    config.gather = {.k = k,
                     .radius = length(radius, "radius"),
                     .filter = chosen<capture::Filter>(filter, capture::filter_names, "filter"),
                     .surface_check = surface_check};
    config.caustic = {
        .photons = caustic_photons,
        .k = caustic_k,
        .radius = length(caustic_radius, "caustic_radius"),
        .filter = chosen<capture::Filter>(caustic_filter, capture::filter_names, "caustic_filter")};
    config.keep = {keep.begin(), keep.end()};
    tone_curve();
    config.columns.rays = rays;
    const std::shared_ptr<reorder::Ordering> ordering = reorder::make_ordering(gather_order);
    if (ordering->reads().leaf_kd || ordering->reads().leaf_bvh)
        throw trace::UsageError(fmt::format(
            "gather_order: found {}, expected an ordering that needs no leaf labels", gather_order));
    config.order = [ordering, w = width, h = height](const capture::Queries& queries) {
        const reorder::Workload work{.position = queries.position,
                                     .direction = queries.direction,
                                     .pixel = queries.pixel,
                                     .leaf_kd = {},
                                     .leaf_bvh = {},
                                     .bounds = trace::bounds_of(queries.position),
                                     .image_width = w,
                                     .image_height = h};
        return reorder::order(*ordering, work).permutation;
    };
    return config;
}

capture::Tone CaptureOptions::tone_curve() const {
    return chosen<capture::Tone>(tone, capture::tone_names, "tone");
}

CaptureOptions capture_options(const trace::Field& in) {
    static constexpr bool optional = false;
    static constexpr std::string_view count = "a whole number", text = "a text",
                                      length = "a number that is not negative",
                                      radius = "a number that is not negative, or \"inf\"";
    static const trace::Kind kind{"capture",
                                  {{"width", optional, count},
                                   {"height", optional, count},
                                   {"samples", optional, count},
                                   {"mode", optional, text},
                                   {"gather_rays", optional, count},
                                   {"shadow_rays", optional, count},
                                   {"photons", optional, count},
                                   {"k", optional, count},
                                   {"radius", optional, radius},
                                   {"filter", optional, text},
                                   {"surface_check", optional, "true or false"},
                                   {"caustic_photons", optional, count},
                                   {"caustic_k", optional, count},
                                   {"caustic_radius", optional, radius},
                                   {"caustic_filter", optional, text},
                                   {"keep", optional, "a part or a list of parts"},
                                   {"frames", optional, text},
                                   {"exposure", optional, length},
                                   {"tone", optional, text},
                                   {"seed", optional, count},
                                   {"gather_order", optional, text},
                                   {"rays", optional, "true or false"}}};
    in.check(kind);
    CaptureOptions options;
    const auto whole = [&](const char* key, std::uint32_t& value, std::uint32_t least, std::uint32_t most) {
        if (in.has(key)) value = in[key].whole(least, most);
    };
    whole("width", options.width, 1, most_pixels);
    whole("height", options.height, 1, most_pixels);
    whole("samples", options.samples, 1, most_samples);
    whole("gather_rays", options.gather_rays, 0, 1u << 20);
    whole("shadow_rays", options.shadow_rays, 0, 1u << 20);
    whole("photons", options.photons, 0, most_photons);
    whole("k", options.k, 1, most_photons);
    whole("caustic_photons", options.caustic_photons, 0, most_photons);
    whole("caustic_k", options.caustic_k, 1, most_photons);
    for (auto [key, value] : {std::pair<const char*, double*>{"radius", &options.radius},
                              {"caustic_radius", &options.caustic_radius},
                              {"exposure", &options.exposure}}) {
        if (!in.has(key)) continue;
        const bool unlimited =
            value != &options.exposure && in[key].value().text() && in[key].text() == "inf";
        *value = unlimited ? std::numeric_limits<double>::infinity()
                           : in[key].number(0, std::numeric_limits<double>::max(), kind.key(key).expected);
    }
    for (auto [key, value] : {std::pair<const char*, std::string*>{"mode", &options.mode},
                              {"filter", &options.filter},
                              {"caustic_filter", &options.caustic_filter},
                              {"tone", &options.tone},
                              {"frames", &options.frames},
                              {"gather_order", &options.gather_order}})
        if (in.has(key)) *value = in[key].text();
    for (auto [key, value] :
         {std::pair<const char*, bool*>{"surface_check", &options.surface_check}, {"rays", &options.rays}})
        if (in.has(key)) *value = in[key].truth();
    if (options.mode == "direct")
        for (const char* const key : {"gather_rays", "shadow_rays"})
            if (in.has(key))
                in[key].refuse(
                    "found beside \"mode\": \"direct\", which casts no such rays, expected one of them");
    if (options.caustic_photons == 0)
        for (const char* const key : {"caustic_k", "caustic_radius", "caustic_filter"})
            if (in.has(key))
                in[key].refuse(
                    "found beside \"caustic_photons\": 0, which makes no such map, expected one of them");
    if (in.has("keep")) options.keep = in["keep"].texts();
    if (in.has("seed"))
        options.seed = in["seed"].whole<std::uint64_t>(0, std::numeric_limits<std::uint64_t>::max());
    return options;
}

}  // namespace regather::experiment
