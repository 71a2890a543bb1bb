#include "experiment/traces/capture_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "capture/irradiance/irradiance_metric.h"
#include "reorder/catalogue.h"
#include "trace/error.h"
#include "trace/field.h"
#include "trace/text.h"

namespace regather::experiment {
namespace {

template <class Enum, std::size_t n>
Enum chosen(const std::string& word, const std::array<const char*, n>& names, const char* what) {
    for (std::size_t i = 0; i < n; ++i)
        if (word == names[i]) return static_cast<Enum>(i);
    throw trace::UsageError(
        fmt::format("{}: found '{}', expected one of {}", what, trace::shown(word), fmt::join(names, ", ")));
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
        .sampling = capture::parse_sampling(sampling).text,
        .irradiance_cache = irradiance_cache.empty() ? irradiance_cache
                                                     : capture::parse_irradiance_cache(irradiance_cache).text,
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
    config.record =
        chosen<capture::PhotonRecord>(photon_record, capture::photon_record_names, "photon_record");
    config.precompute_every = precompute_every;
    config.reverse_pixels = reverse_pixels;
    config.keep = {keep.begin(), keep.end()};
    tone_curve();
    config.columns.rays = rays;
    const std::shared_ptr<reorder::Ordering> ordering = reorder::make_ordering(gather_order);
    const reorder::Reads reads = ordering->reads();
    if (reads.leaf_kd || reads.leaf_bvh || reads.stratum || reads.rows)
        throw trace::UsageError(fmt::format(
            "gather_order: found {}, expected an ordering that needs no leaf labels, strata or file",
            trace::in_quotes(gather_order)));
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

std::span<const CaptureKey> capture_keys() {
    using Options = CaptureOptions;
    static const std::string sampling_help = [] {
        std::vector<std::string_view> names;
        for (const capture::SamplingStrategy& strategy : capture::sampling_strategies())
            names.push_back(strategy.name);
        return fmt::format("how their directions are chosen: {}", fmt::join(names, ", "));
    }();
    static const std::string irradiance_help = [] {
        std::vector<std::string_view> names;
        for (const capture::IrradianceMetric& metric : capture::irradiance_metrics())
            names.push_back(metric.name);
        return fmt::format("diffuse points gather for their neighbours, too, as far as a metric says: {}",
                           fmt::join(names, ", "));
    }();
    static const std::vector<CaptureKey> keys{
        {"width", &Options::width, "image width [pixels]", 1, most_pixels},
        {"height", &Options::height, "image height [pixels]", 1, most_pixels},
        {"samples", &Options::samples, "eye rays a pixel; one goes through its centre", 1, most_samples},
        {.name = "mode",
         .value = &Options::mode,
         .help = "how photons are seen: by final gather rays (equation 3), or direct (equation 2)",
         .words = capture::visualisation_names},
        {"gather_rays", &Options::gather_rays, "final gather rays a pixel (N)", 0, most_rays},
        {"sampling", &Options::sampling, sampling_help},
        {"irradiance_cache", &Options::irradiance_cache, irradiance_help},
        {"shadow_rays", &Options::shadow_rays, "shadow rays per shaded point and light, of up to four lights",
         0, most_rays},
        {"photons", &Options::photons, "photons to store", 0, most_photons},
        {"k", &Options::k, "photons of a gather", 1, most_photons},
        {.name = "radius",
         .value = &Options::radius,
         .help = "maximum radius of a gather [scene units]; 0 or inf: unlimited",
         .infinite = true},
        {.name = "filter",
         .value = &Options::filter,
         .help = "weight of the photons of a gather by their distance",
         .words = capture::filter_names},
        {.name = "surface_check",
         .value = &Options::surface_check,
         .help = "use photons of surfaces that face elsewhere, too"},
        {"caustic_photons", &Options::caustic_photons, "photons of the caustic map; 0: no such map", 0,
         most_photons},
        {"caustic_k", &Options::caustic_k, "photons of a gather in the caustic map", 1, most_photons},
        {.name = "caustic_radius",
         .value = &Options::caustic_radius,
         .help = "its maximum radius [scene units]; 0 or inf: unlimited",
         .infinite = true},
        {.name = "caustic_filter",
         .value = &Options::caustic_filter,
         .help = "its filter",
         .words = capture::filter_names},
        {.name = "photon_record",
         .value = &Options::photon_record,
         .help =
             "bytes of a photon; 16: positions in 21 bits an axis, and what that does to the image is told",
         .words = capture::photon_record_names},
        {"precompute_every", &Options::precompute_every,
         "irradiance is estimated at every so many photons, and gathers read the nearest; 0: they gather", 0,
         most_photons},
        {"reverse_pixels", &Options::reverse_pixels,
         "photons search the hit points of so many pixels at a time; 0: hit points search photons", 0,
         most_pixels * most_pixels},
        {"keep", &Options::keep,
         "parts to build although the scene has no need of them (regather info SCENE lists them)"},
        {"frames", &Options::frames,
         "frames of the camera path: 7, or 0,10,20, or 0:30:5 (from, below, step)"},
        {"exposure", &Options::exposure, "of image.png: factor of the radiance; 0: by the image's mean"},
        {.name = "tone",
         .value = &Options::tone,
         .help = "tone curve of image.png",
         .words = capture::tone_names},
        {"seed", &Options::seed, "of all random numbers"},
        {"gather_order", &Options::gather_order,
         "ordering of the searches within a batch of pixels; changes the time, not the result"},
        {"rays", &Options::rays, "leave the ray columns out"},
    };
    return keys;
}

std::vector<IdleKeys> idle_keys(const CaptureOptions& options) {
    std::vector<IdleKeys> idle;
    if (options.mode == "direct")
        idle.push_back({{"gather_rays", "shadow_rays", "sampling", "irradiance_cache"},
                        "mode",
                        "direct",
                        "casts no such rays"});
    if (options.photon_record == "16")
        idle.push_back({{"irradiance_cache", "precompute_every", "reverse_pixels"},
                        "photon_record",
                        "16",
                        "is told from two gathers of each pixel"});
    if (options.gather_rays == 0)
        idle.push_back({{"irradiance_cache"}, "gather_rays", "0", "gathers nothing"});
    if (options.caustic_photons == 0)
        idle.push_back(
            {{"caustic_k", "caustic_radius", "caustic_filter"}, "caustic_photons", "0", "makes no such map"});
    return idle;
}

namespace {

/// What a message says was expected.
std::string_view expected(const CaptureKey& key) {
    constexpr std::string_view of_type[] = {
        "a whole number", "a whole number", "a number that is not negative",
        "true or false",  "a text",         "a part or a list of parts"};
    return key.infinite ? "a number that is not negative, or \"inf\"" : of_type[key.value.index()];
}

void read(const trace::Field& in, const CaptureKey& key, double& to) {
    constexpr double most = std::numeric_limits<double>::max();
    const bool unlimited = key.infinite && in.value().text() && in.text() == "inf";
    to = unlimited ? std::numeric_limits<double>::infinity() : in.number(0, most, expected(key));
}

void read(const trace::Field& in, const CaptureKey& key, std::uint32_t& to) {
    to = in.whole(static_cast<std::uint32_t>(key.least), static_cast<std::uint32_t>(key.most));
}
void read(const trace::Field& in, const CaptureKey& key, std::uint64_t& to) {
    to = in.whole<std::uint64_t>(key.least, key.most);
}
void read(const trace::Field& in, const CaptureKey&, bool& to) {
    to = in.truth();
}
void read(const trace::Field& in, const CaptureKey&, std::string& to) {
    to = in.text();
}
void read(const trace::Field& in, const CaptureKey&, std::vector<std::string>& to) {
    to = in.texts();
}

}  // namespace

CaptureOptions capture_options(const trace::Field& in) {
    static const trace::Kind kind = [] {
        trace::Kind of_keys{"capture", {}};
        for (const CaptureKey& key : capture_keys()) of_keys.keys.push_back({key.name, false, expected(key)});
        return of_keys;
    }();
    in.check(kind);
    CaptureOptions options;
    for (const CaptureKey& key : capture_keys())
        if (const std::optional<trace::Field> field = in.get(key.name))
            std::visit([&](const auto member) { read(*field, key, options.*member); }, key.value);
    for (const IdleKeys& idle : idle_keys(options))
        for (const std::string_view key : idle.keys)
            if (in.has(key))
                in[key].refuse(fmt::format("found beside \"{}\": {}, which {}, expected one of them",
                                           idle.beside, in[idle.beside].found(), idle.reason));
    return options;
}

}  // namespace regather::experiment
