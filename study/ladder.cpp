#include "study/ladder.h"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "capture/irradiance/irradiance_metric.h"
#include "capture/sampling/gather_distribution.h"
#include "results/convergence_row.h"
#include "results/csv.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::study {
namespace {

constexpr std::uint32_t most_photons = (1u << 31) - 1;

constexpr std::size_t longest_name = 100;

bool names_a_file(std::string_view name) {
    return name.size() <= longest_name && trace::shown(name, longest_name) == name &&
           name.find('/') == std::string_view::npos;
}

template <class Change>
void add_steps(std::vector<Setting>& ladder, const Setting& base, std::initializer_list<double> steps,
               Change change) {
    for (const double step : steps) {
        Setting setting = base;
        change(setting, step);
        ladder.push_back(setting);
    }
}

std::uint32_t whole(double value) {
    return static_cast<std::uint32_t>(std::lround(value));
}

/// With all its parameters.
std::string irradiance_cache_of(std::string_view spec, const auto& refuse) {
    try {
        return capture::parse_irradiance_cache(spec).text;
    } catch (const trace::UsageError& error) {
        refuse("irradiance_cache", trace::in_quotes(spec), error.what());
        return "";
    }
}

/// With all its parameters; nothing for the default's.
std::string sampling_of(std::string_view spec, const auto& refuse) {
    try {
        std::string text = capture::parse_sampling(spec).text;
        return text == capture::default_sampling ? "" : text;
    } catch (const trace::UsageError& error) {
        refuse("sampling", trace::in_quotes(spec), error.what());
        return "";
    }
}

}  // namespace

std::string_view mode_name(capture::Visualisation mode) {
    return mode == capture::Visualisation::direct ? "direct" : "final-gather";
}

std::vector<Setting> default_ladder(double diagonal, bool caustics) {
    std::vector<Setting> out;
    Setting base;
    if (!caustics) base.caustic_photons = 0;
    base.ladder = "gather-rays";
    add_steps(out, base, {4, 16, 64, 256}, [](Setting& s, double v) { s.gather_rays = whole(v); });
    base.ladder = "samples";
    base.gather_rays = 64;
    add_steps(out, base, {1, 4, 16, 64}, [](Setting& s, double v) { s.samples = whole(v); });
    base.gather_rays = 16;
    base.ladder = "photons";
    add_steps(out, base, {2e3, 1e4, 5e4, 25e4, 125e4}, [](Setting& s, double v) { s.photons = whole(v); });
    base.ladder = std::string("k");
    add_steps(out, base, {5, 16, 50, 160, 500}, [](Setting& s, double v) { s.k = whole(v); });
    base.ladder = "radius";
    add_steps(out, base, {0.005, 0.01, 0.02, 0.04, 0.08},
              [diagonal](Setting& s, double v) { s.radius = v * diagonal; });
    base.ladder = "caustic-photons";
    if (caustics)
        add_steps(out, base, {2e3, 1e4, 5e4, 25e4, 125e4},
                  [](Setting& s, double v) { s.caustic_photons = whole(v); });

    base.mode = capture::Visualisation::direct;
    base.gather_rays = 0;
    base.ladder = "direct-photons";
    add_steps(out, base, {5e3, 1e4, 2e4, 5e4, 1e5, 2e5, 5e5, 1e6},
              [](Setting& s, double v) { s.photons = whole(v); });
    base.ladder = "direct-k";
    base.photons = 200'000;
    add_steps(out, base, {10, 20, 50, 100, 200, 500, 1000, 2000},
              [](Setting& s, double v) { s.k = whole(v); });
    base.ladder = "direct-both";
    add_steps(out, base, {5e3, 1e4, 2e4, 5e4, 1e5, 2e5, 5e5, 1e6}, [](Setting& s, double v) {
        s.photons = whole(v);
        s.k = whole(std::sqrt(v));
    });
    return out;
}

std::vector<Setting> parse_ladder(std::string_view text, std::string_view file) {
    std::vector<Setting> out;
    std::size_t line = 1;
    for (const results::LadderRow& row : results::from_csv<results::LadderRow>(text, file)) {
        ++line;
        Setting setting;
        const auto refuse = [&](std::string_view column, const std::string& found,
                                std::string_view expected) {
            throw trace::DataError(fmt::format("{}: row {}, column {}: found {}, expected {}", file, line - 1,
                                               column, found, expected));
        };
        const auto take = [&](std::string_view column, const results::Count& cell, std::uint32_t& value,
                              std::uint64_t least, std::uint64_t most) {
            if (!cell) return;
            if (*cell < least || *cell > most)
                refuse(column, fmt::to_string(*cell),
                       fmt::format("a whole number from {} to {}", least, most));
            value = static_cast<std::uint32_t>(*cell);
        };
        if (row.ladder.empty()) refuse("ladder", "an empty cell", "a name");
        if (!names_a_file(row.ladder))
            refuse("ladder", trace::in_quotes(row.ladder),
                   fmt::format("at most {} printable bytes without '/' (it names pictures)", longest_name));
        setting.ladder = row.ladder;
        if (row.mode == "direct")
            setting.mode = capture::Visualisation::direct;
        else if (!row.mode.empty() && row.mode != "final-gather")
            refuse("mode", trace::in_quotes(row.mode), "final-gather or direct");
        if (setting.mode == capture::Visualisation::direct) setting.gather_rays = 0;
        take("gather_rays", row.gather_rays, setting.gather_rays, 0, 1u << 20);
        take("photons", row.photons, setting.photons, 0, most_photons);
        take("k", row.k, setting.k, 1, most_photons);
        take("caustic_photons", row.caustic_photons, setting.caustic_photons, 0, most_photons);
        take("samples", row.samples, setting.samples, 1, 1u << 20);
        if (!row.sampling.empty()) {
            if (setting.mode == capture::Visualisation::direct)
                refuse("sampling", trace::in_quotes(row.sampling),
                       "an empty cell: direct casts no such rays");
            setting.sampling = sampling_of(row.sampling, refuse);
        }
        if (!row.irradiance_cache.empty()) {
            if (setting.mode == capture::Visualisation::direct || setting.gather_rays == 0)
                refuse("irradiance_cache", trace::in_quotes(row.irradiance_cache),
                       "an empty cell: without gather rays there are no records");
            setting.irradiance_cache = irradiance_cache_of(row.irradiance_cache, refuse);
        }
        for (const auto& [column, cell, value] :
             {std::tuple("precompute_every", row.precompute_every, &setting.precompute_every),
              std::tuple("reverse_pixels", row.reverse_pixels, &setting.reverse_pixels)}) {
            if (!cell) continue;
            if (setting.mode == capture::Visualisation::direct || setting.gather_rays == 0)
                refuse(column, fmt::to_string(*cell),
                       "an empty cell: without gather rays nothing is gathered");
            take(column, cell, *value, 1, most_photons);
        }
        if (setting.reverse_pixels > 0 && (setting.precompute_every > 0 || !setting.irradiance_cache.empty()))
            refuse("reverse_pixels", fmt::to_string(setting.reverse_pixels),
                   "an empty cell beside precompute_every and irradiance_cache");
        setting.photon_seed = row.photon_seed;
        if (row.radius) {
            if (*row.radius <= 0)
                refuse("radius", fmt::to_string(*row.radius), "a length above 0, or an empty cell");
            setting.radius = *row.radius;
        }
        out.push_back(setting);
    }
    if (out.empty()) throw trace::DataError(fmt::format("{}: no rows, expected at least one setting", file));
    return out;
}

}  // namespace regather::study
