#include "cli/capture_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cmath>
#include <limits>
#include <memory>

#include "cli/keys.h"
#include "reorder/catalogue.h"
#include "trace/error.h"

namespace regather::cli {
namespace {

constexpr std::uint32_t most_pixels = 32768;
constexpr std::uint32_t most_photons = (1u << 31) - 1;

}  // namespace

void CaptureOptions::add_to(CLI::App& app) {
    app.add_option("--width", width, "image width [pixels]")->check(CLI::Range(1u, most_pixels))->capture_default_str();
    app.add_option("--height", height, "image height [pixels]")
        ->check(CLI::Range(1u, most_pixels))
        ->capture_default_str();
    app.add_option("--gather-rays", gather_rays, "final gather rays a pixel (N)")
        ->check(CLI::Range(0u, 1u << 20))
        ->capture_default_str();
    app.add_option("--shadow-rays", shadow_rays, "shadow rays per light and shaded point")
        ->check(CLI::Range(0u, 1u << 20))
        ->capture_default_str();
    app.add_option("--photons", photons, "photons to store")->check(CLI::Range(0u, most_photons))->capture_default_str();
    app.add_option("--k", k, "photons of a gather")->check(CLI::Range(1u, most_photons))->capture_default_str();
    app.add_option("--radius", radius, "maximum radius of a gather [scene units]; 0: unlimited")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--seed", seed, "of all random numbers")->capture_default_str();
    app.add_option("--gather-order", gather_order,
                   "ordering of the searches within a batch of pixels; changes the time, not the result")
        ->capture_default_str();
    app.add_flag("!--no-rays", rays, "leave the ray columns out");
}

capture::CaptureConfig CaptureOptions::config() const {
    capture::CaptureConfig config;
    config.pixels = {.width = width, .height = height, .gather_rays = gather_rays, .shadow_rays = shadow_rays,
                     .max_specular = 16, .seed = seed};
    config.photon = {.photons = photons, .seed = seed};
    config.gather.k = k;
    if (!std::isfinite(radius))
        throw trace::UsageError(fmt::format("--radius: found {}, expected a finite number; 0: unlimited", radius));
    if (!std::isfinite(radius)) throw trace::UsageError("radius: found no finite number, expected a length, or 0: unlimited");
    if (radius > 0) config.gather.radius = static_cast<float>(radius);
    config.columns.rays = rays;
    const std::shared_ptr<reorder::Ordering> ordering = reorder::make_ordering(gather_order);
    if (ordering->reads().leaf_kd || ordering->reads().leaf_bvh)
        throw trace::UsageError(fmt::format("--gather-order: found {}, expected an ordering that needs no leaf labels",
                                            gather_order));
    config.order = [ordering, w = width, h = height](const capture::Queries& queries) {
        const reorder::Workload work{.position = queries.position, .direction = queries.direction,
                                     .pixel = queries.pixel, .leaf_kd = {}, .leaf_bvh = {},
                                     .bounds = trace::bounds_of(queries.position), .image_width = w, .image_height = h};
        return reorder::order(*ordering, work).permutation;
    };
    return config;
}

CaptureOptions capture_options(const nlohmann::json& object, const std::string& file) {
    static constexpr std::array<std::string_view, 10> keys{"width", "height", "gather_rays", "shadow_rays", "photons",
                                                           "k", "radius", "seed", "gather_order", "rays"};
    const Object in(object, keys, file, "capture");
    CaptureOptions options;
    const auto count = [&](const char* key, std::uint32_t& value, std::uint64_t least, std::uint64_t most) {
        value = static_cast<std::uint32_t>(in.number(key, value, least, most));
    };
    count("width", options.width, 1, most_pixels);
    count("height", options.height, 1, most_pixels);
    count("gather_rays", options.gather_rays, 0, 1u << 20);
    count("shadow_rays", options.shadow_rays, 0, 1u << 20);
    count("photons", options.photons, 0, most_photons);
    count("k", options.k, 1, most_photons);
    options.radius = in.real("radius", options.radius);
    options.seed = in.number("seed", options.seed, 0, std::numeric_limits<std::uint64_t>::max());
    if (in.has("gather_order")) options.gather_order = in.text("gather_order");
    options.rays = in.flag("rays", options.rays);
    return options;
}

}  // namespace regather::cli
