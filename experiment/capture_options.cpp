#include "experiment/capture_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "experiment/keys.h"
#include "reorder/catalogue.h"
#include "trace/error.h"

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

CaptureOptions capture_options(const nlohmann::json& object, const std::string& file) {
    static constexpr std::array<std::string_view, 22> keys{"width",          "height",
                                                           "samples",        "mode",
                                                           "gather_rays",    "shadow_rays",
                                                           "photons",        "k",
                                                           "radius",         "filter",
                                                           "surface_check",  "caustic_photons",
                                                           "caustic_k",      "caustic_radius",
                                                           "caustic_filter", "keep",
                                                           "frames",         "exposure",
                                                           "tone",           "seed",
                                                           "gather_order",   "rays"};
    const Object in(object, keys, file, "capture");
    CaptureOptions options;
    const auto count = [&](const char* key, std::uint32_t& value, std::uint64_t least, std::uint64_t most) {
        value = static_cast<std::uint32_t>(in.number(key, value, least, most));
    };
    count("width", options.width, 1, most_pixels);
    count("height", options.height, 1, most_pixels);
    count("samples", options.samples, 1, most_samples);
    count("gather_rays", options.gather_rays, 0, 1u << 20);
    count("shadow_rays", options.shadow_rays, 0, 1u << 20);
    count("photons", options.photons, 0, most_photons);
    count("k", options.k, 1, most_photons);
    count("caustic_photons", options.caustic_photons, 0, most_photons);
    count("caustic_k", options.caustic_k, 1, most_photons);
    options.radius = in.real("radius", options.radius);
    options.caustic_radius = in.real("caustic_radius", options.caustic_radius);
    options.exposure = in.real("exposure", options.exposure);
    for (auto [key, value] : {std::pair<const char*, std::string*>{"mode", &options.mode},
                              {"filter", &options.filter},
                              {"caustic_filter", &options.caustic_filter},
                              {"tone", &options.tone},
                              {"frames", &options.frames}})
        if (in.has(key)) *value = in.text(key);
    options.surface_check = in.flag("surface_check", options.surface_check);
    options.keep = in.list("keep", {});
    options.seed = in.number("seed", options.seed, 0, std::numeric_limits<std::uint64_t>::max());
    if (in.has("gather_order")) options.gather_order = in.text("gather_order");
    options.rays = in.flag("rays", options.rays);
    return options;
}

}  // namespace regather::experiment
