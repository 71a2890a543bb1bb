#include "results/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "results/geometry.h"
#include "results/parameters.h"

namespace regather::results {
namespace {

auto picture_of(const ConvergenceRow& row) {
    return std::tie(row.scene, row.reference, row.width, row.height);
}

bool is_complete(const ConvergenceRow& row) {
    return row.total_seconds.value_or(0) > 0 && row.rmse;
}

/// Three digits, or what bounds it.
std::string percent(double share) {
    return share >= 99.95 ? fmt::format("{:.0f}", share) : fmt::format("{:.3g}", share);
}

std::string setting_text(const ConvergenceRow& row) {
    std::string out = row.mode == "direct" ? "direct" : fmt::format("N {}", row.gather_rays.value_or(0));
    out += fmt::format(", n {}, k {}", decimal_count(static_cast<double>(row.photons.value_or(0))),
                       row.k.value_or(0));
    if (row.radius) out += fmt::format(", r {:.3g}", *row.radius);
    if (row.samples.value_or(1) > 1) out += fmt::format(", s {}", *row.samples);
    if (!row.sampling.empty()) out += fmt::format(", {}", spec_name(row.sampling));
    if (!row.irradiance_cache.empty()) out += fmt::format(", {}", spec_name(row.irradiance_cache));
    if (row.precompute_every) out += ", precomputed";
    if (row.reverse_pixels) out += ", reverse";
    return out;
}

/// All that two rows must have in common for their variances to tell how many rays one needs for each of the
/// other's; the strategy is what they differ by.
auto all_but_sampling(const ConvergenceRow& row) {
    return std::tie(row.scene, row.reference, row.width, row.height, row.seeds, row.mode, row.gather_rays,
                    row.photons, row.k, row.radius, row.caustic_photons, row.samples, row.shadow_rays,
                    row.irradiance_cache, row.precompute_every, row.reverse_pixels, row.photon_seed);
}

bool is_cosine(const ConvergenceRow& row) {
    return spec_name(row.sampling) == "cosine";
}

}  // namespace

std::vector<Ladder> ladders(std::span<const ConvergenceRow> rows) {
    std::vector<Ladder> out;
    bool several = false;
    for (const ConvergenceRow& row : rows) {
        if (!is_complete(row)) continue;
        several |= picture_of(row) != picture_of(*(out.empty() ? &row : out.front().rows.front()));
        const auto same = std::find_if(out.begin(), out.end(), [&](const Ladder& ladder) {
            const ConvergenceRow& first = *ladder.rows.front();
            return first.ladder == row.ladder && first.mode == row.mode &&
                   picture_of(first) == picture_of(row);
        });
        if (same != out.end())
            same->rows.push_back(&row);
        else
            out.push_back({row.ladder, {&row}});
    }
    for (Ladder& ladder : out) {
        const ConvergenceRow& row = *ladder.rows.front();
        if (several)
            ladder.label +=
                fmt::format(", {} {}×{}", row.scene, row.width.value_or(0), row.height.value_or(0));
        std::stable_sort(ladder.rows.begin(), ladder.rows.end(),
                         [](auto a, auto b) { return *a->total_seconds < *b->total_seconds; });
    }
    return out;
}

std::optional<double> fitted_slope(std::span<const double> x, std::span<const double> y) {
    if (x.size() < 3) return {};
    const auto count = static_cast<double>(x.size());
    double mx = 0, my = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mx += std::log(x[i]) / count;
        my += std::log(y[i]) / count;
    }
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (std::log(x[i]) - mx) * (std::log(x[i]) - mx);
        xy += (std::log(x[i]) - mx) * (std::log(y[i]) - my);
    }
    if (xx <= 1e-12) return {};
    return xy / xx;
}

std::optional<double> seconds_to(const Ladder& ladder, double error) {
    const ConvergenceRow* before = nullptr;
    for (const ConvergenceRow* row : ladder.rows) {
        if (*row->rmse > error) {
            before = row;
            continue;
        }
        if (row->below_reference.value_or(false)) return {};  // how good it is, is not known
        if (before == nullptr) return -*row->total_seconds;
        const double share = std::log(*before->rmse / error) / std::log(*before->rmse / *row->rmse);
        return *before->total_seconds * std::pow(*row->total_seconds / *before->total_seconds, share);
    }
    return {};
}

double percent_of_mean(const ConvergenceRow& row, double value) {
    const double mean = row.mean_radiance.value_or(0);
    return mean > 0 ? 100 * value / mean : value;
}

Table convergence_table(std::span<const ConvergenceRow> rows) {
    Table out({{"ladder", Align::left},
               {"setting", Align::left},
               {"render s"},
               {"total s"},
               {"RMSE %"},
               {"bias %"},
               {"dev. %"},
               {"MAPE %"},
               {"FLIP"}});
    for (const Ladder& ladder : ladders(rows))
        for (const ConvergenceRow* row : ladder.rows) {
            const auto root = [&](const Number& square) {
                return square ? percent(percent_of_mean(*row, std::sqrt(std::max(*square, 0.0))))
                              : std::string();
            };
            const bool no_bias =
                row->bias_squared && *row->bias_squared <= 2 * row->bias_squared_stderr.value_or(0);
            out.add({ladder.label, setting_text(*row),
                     row->render_seconds ? fmt::format("{:.3f}", *row->render_seconds) : "",
                     fmt::format("{:.3f}", *row->total_seconds),
                     (row->below_reference.value_or(false) ? "<=" : "") +
                         percent(percent_of_mean(*row, *row->rmse)),
                     no_bias ? "~0" : root(row->bias_squared), root(row->variance),
                     row->mape ? percent(100 * *row->mape) : "",
                     row->hdr_flip ? fmt::format("{:.3f}", *row->hdr_flip) : ""});
        }
    return out;
}

Table time_table(std::span<const ConvergenceRow> rows) {
    const std::vector<Ladder> all = ladders(rows);
    const auto seconds_at = [](const Ladder& ladder, double share) {
        return seconds_to(ladder, share * ladder.rows.front()->mean_radiance.value_or(0));
    };
    std::vector<double> levels;
    for (const double share : {0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005})
        if (std::any_of(all.begin(), all.end(),
                        [&](const Ladder& ladder) { return seconds_at(ladder, share).value_or(-1) > 0; }))
            levels.push_back(share);
    std::vector<Table::Head> heads = {{"seconds to an RMSE of", Align::left}, {"slope"}};
    for (const double share : levels) heads.push_back({fmt::format("{:g} %", 100 * share)});
    Table out(std::move(heads));
    if (levels.empty()) return out;
    for (const Ladder& ladder : all) {
        std::vector<double> x, y;
        for (const ConvergenceRow* row : ladder.rows)
            if (!row->below_reference.value_or(false) && *row->rmse > 0) {
                x.push_back(*row->total_seconds);
                y.push_back(*row->rmse);
            }
        const auto slope = fitted_slope(x, y);
        std::vector<std::string> cells = {ladder.label, slope ? fmt::format("{:.2f}", *slope) : ""};
        for (const double share : levels) {
            const auto seconds = seconds_at(ladder, share);
            cells.push_back(!seconds       ? "-"
                            : *seconds < 0 ? fmt::format("<{:.3g}", -*seconds)
                                           : fmt::format("{:.3g}", *seconds));
        }
        out.add(std::move(cells));
    }
    return out;
}

std::vector<EqualError> equal_errors(std::span<const ConvergenceRow> rows) {
    std::vector<EqualError> out;
    for (const ConvergenceRow& row : rows) {
        if (is_cosine(row) || !row.photon_seed || row.indirect_variance.value_or(0) <= 0) continue;
        const auto cosine = std::find_if(rows.begin(), rows.end(), [&](const ConvergenceRow& other) {
            return is_cosine(other) && all_but_sampling(other) == all_but_sampling(row) &&
                   other.indirect_variance.value_or(0) > 0;
        });
        if (cosine == rows.end()) continue;
        EqualError found{&row, *cosine->indirect_variance / *row.indirect_variance};
        if (cosine->indirect_variance_stderr && row.indirect_variance_stderr) {
            const double reach =
                1.96 * std::hypot(*cosine->indirect_variance_stderr / *cosine->indirect_variance,
                                  *row.indirect_variance_stderr / *row.indirect_variance);
            found.interval = {found.rays * std::exp(-reach), found.rays * std::exp(reach)};
        }
        out.push_back(found);
    }
    return out;
}

Table equal_error_table(std::span<const ConvergenceRow> rows) {
    Table out({{"rays of cosine for the error of one", Align::left}, {"N"}, {"rays"}, {"95 %"}});
    for (const EqualError& found : equal_errors(rows)) {
        const ConvergenceRow& row = *found.row;
        const auto& interval = found.interval;
        out.add({row.sampling.empty() ? "brdf" : row.sampling, fmt::to_string(row.gather_rays.value_or(0)),
                 fmt::format("{:.2f}", found.rays),
                 interval ? fmt::format("{:.2f} to {:.2f}", interval->first, interval->second) : ""});
    }
    return out;
}

}  // namespace regather::results
