#include "charts/convergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>

#include "charts/figure.h"
#include "results/geometry.h"

namespace regather::charts {
namespace {

struct LadderStyle {
    std::string_view name, colour;
    int marker;
};
// Okabe & Ito's colours, as of the orderings in series.cpp.
constexpr LadderStyle styles_table[] = {
    {"gather-rays", "#0072b2", 7},    {"samples", "#56b4e9", 11},
    {"photons", "#d55e00", 5},        {"k", "#009e73", 9},
    {"radius", "#882255", 13},        {"caustic-photons", "#e69f00", 15},
    {"direct-photons", "#d55e00", 4}, {"direct-k", "#009e73", 8},
    {"direct-both", "#cc79a7", 6},
};
constexpr std::string_view spare[] = {"#332288", "#44aa99", "#aa4499", "#661100", "#6699cc", "#117733"};

auto picture_of(const results::ConvergenceRow& row) {
    return std::tie(row.scene, row.reference, row.width, row.height);
}

bool is_complete(const results::ConvergenceRow& row) {
    return row.total_seconds.value_or(0) > 0 && row.rmse;
}

bool is_direct(const Ladder& ladder) {
    return ladder.rows.front()->mode == "direct";
}

/// The name without "direct-": what is varied.
Line look_of(const Ladder& ladder, std::size_t place) {
    Line line;
    const std::string& name = ladder.rows.front()->ladder;
    const auto style = std::find_if(std::begin(styles_table), std::end(styles_table),
                                    [&](const LadderStyle& s) { return s.name == name; });
    line.colour = style != std::end(styles_table) ? style->colour : spare[place % std::size(spare)];
    line.marker = style != std::end(styles_table) ? style->marker : 10 + static_cast<int>(place % 6);
    line.label = ladder.label;
    return line;
}

double percent_of_mean(const results::ConvergenceRow& row, double value) {
    const double mean = row.mean_radiance.value_or(0);
    return mean > 0 ? 100 * value / mean : value;
}

std::string slope_text(const std::optional<double>& slope) {
    return slope ? fmt::format(", slope {}{:.2f}", *slope < 0 ? "−" : "", std::abs(*slope)) : "";
}

/// "box · 64×64 · 4 seeds · reference's error 0.31 %"
std::string caption_of(std::span<const Ladder> all) {
    std::vector<std::string> scenes, seeds;
    const auto add = [](std::vector<std::string>& list, std::string text) {
        if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(std::move(text));
    };
    for (const Ladder& ladder : all)
        for (const results::ConvergenceRow* row : ladder.rows) {
            add(scenes, row->width && row->height
                            ? fmt::format("{}, {}×{} pixels", row->scene, *row->width, *row->height)
                            : row->scene);
            if (row->seeds) add(seeds, fmt::format("{} seeds", *row->seeds));
        }
    const std::string parts[] = {results::joined(scenes, " and "), results::joined(seeds, " and ")};
    return results::joined(parts, " · ");
}

Line level(double y, const Scale& across, std::string label) {
    Line line;
    line.label = std::move(label);
    line.colour = "#606060";
    line.width = 1;
    line.variant = 1;
    line.form = Line::Form::plain;
    line.points = {{across.low, y}, {across.high, y}};
    return line;
}

using Value = std::optional<double> (*)(const results::ConvergenceRow&);

std::optional<double> total(const results::ConvergenceRow& row) {
    return row.total_seconds;
}
std::optional<double> render(const results::ConvergenceRow& row) {
    return row.render_seconds;
}

/// Curves of all ladders over seconds, those with final gathers above those without.
struct OverTime {
    Value seconds, height;
    std::string label, across;
    bool with_slopes, with_reference;
};

Chart over_time(const ChartKind& kind, const Rows& rows, const OverTime& what) {
    const std::vector<Ladder> all = ladders(rows.convergence);
    Plate plates[2];
    plates[0].remark = "Final gathers";
    plates[1].remark = "Direct visualisation";
    std::vector<double> seconds, heights[2];
    std::set<double> floors;
    for (std::size_t l = 0; l < all.size(); ++l) {
        const Ladder& ladder = all[l];
        const std::size_t p = is_direct(ladder) ? 1 : 0;
        Line line = look_of(ladder, l);
        std::vector<double> x, y;
        for (const results::ConvergenceRow* row : ladder.rows) {
            const auto t = what.seconds(*row), v = what.height(*row);
            if (!t || !v || *t <= 0 || *v <= 0) continue;
            line.points.push_back({*t, *v});
            seconds.push_back(*t);
            heights[p].push_back(*v);
            if (row->reference_rmse.value_or(0) > 0)
                floors.insert(percent_of_mean(*row, *row->reference_rmse));
            if (row->below_reference.value_or(false)) continue;
            x.push_back(*t);
            y.push_back(*v);
        }
        if (line.points.empty()) continue;
        std::sort(line.points.begin(), line.points.end(),
                  [](const Point& a, const Point& b) { return a.x < b.x; });
        if (what.with_slopes) line.label += slope_text(fitted_slope(x, y));
        plates[p].lines.push_back(std::move(line));
    }
    if (seconds.empty()) return skip(fmt::format("needs {} with values above 0", kind.needs));
    Figure figure{what.across, log_scale(seconds, plain_number), {}};
    std::vector<double> both;
    for (Plate& plate : plates)
        both.insert(both.end(), heights[&plate - plates].begin(), heights[&plate - plates].end());
    if (what.with_reference && floors.size() == 1) both.push_back(*floors.begin());
    for (std::size_t p = 0; p < 2; ++p) {
        Plate& plate = plates[p];
        if (plate.lines.empty()) continue;
        plate.label = what.label;
        plate.height = heights[1 - p].empty() ? 270 : 190;
        plate.vertical = log_scale(both, plain_number);  // the same for both, so that heights may be compared
        plate.vertical.high *= 1.3;                      // so that no tick's label meets the plate's name
        if (what.with_reference && floors.size() == 1)
            plate.lines.push_back(level(*floors.begin(), figure.horizontal, "error of the reference"));
        figure.plates.push_back(std::move(plate));
    }
    Chart chart;
    chart.title = kind.title;
    chart.caption = caption_of(all);
    compose(chart, figure);
    return chart;
}

std::optional<double> relative_rmse(const results::ConvergenceRow& row) {
    return percent_of_mean(row, *row.rmse);
}

// ---- bias and variance ----

/// Bias as its root, in percent of the mean radiance; nothing when it is not told apart from 0 (two standard
/// errors).
std::optional<Point> bias_point(double x, const results::Number& squared, const results::Number& stderr_,
                                double mean) {
    if (!squared || mean <= 0 || *squared <= 2 * stderr_.value_or(0) || *squared <= 0) return {};
    const auto root = [&](double v) { return 100 * std::sqrt(std::max(v, 0.0)) / mean; };
    Point point{x, root(*squared)};
    if (stderr_) {
        point.low = root(*squared - *stderr_);
        point.high = root(*squared + *stderr_);
    }
    return point;
}

struct Bias {
    std::string label;
    std::optional<Point> (*point)(const results::ConvergenceRow&, double x);
    /// As theory expects the measure of this row, but for a factor; nothing: it expects no power law.
    std::optional<double> (*expected)(const results::ConvergenceRow&);
};

std::optional<double> area_a_photon(const results::ConvergenceRow& row) {
    return static_cast<double>(*row.k) / static_cast<double>(*row.photons);
}
std::optional<double> root_of_radius(const results::ConvergenceRow& row) {
    return std::pow(*area_a_photon(row), 0.25);
}
std::optional<double> root_of_k(const results::ConvergenceRow& row) {
    return 1 / std::sqrt(static_cast<double>(*row.k));
}

const Bias measures[] = {
    {"bias, interior [%]",
     [](const results::ConvergenceRow& row, double x) {
         return bias_point(x, row.interior_bias_squared, row.interior_bias_squared_stderr,
                           row.interior_mean_radiance.value_or(0));
     },
     area_a_photon},
    {"bias, all pixels [%]",
     [](const results::ConvergenceRow& row, double x) {
         return bias_point(x, row.bias_squared, row.bias_squared_stderr, row.mean_radiance.value_or(0));
     },
     root_of_radius},
    {"std. deviation, interior [%]",
     [](const results::ConvergenceRow& row, double x) -> std::optional<Point> {
         const double mean = row.interior_mean_radiance.value_or(0);
         if (row.interior_variance.value_or(0) <= 0 || mean <= 0) return {};
         return Point{x, 100 * std::sqrt(*row.interior_variance) / mean};
     },
     root_of_k},
};

enum class Varied { photons, k };

Chart bias_chart(const ChartKind& kind, const Rows& rows, Varied varied, std::string across) {
    std::vector<Ladder> all = ladders(rows.convergence);
    const auto place = [&](const results::ConvergenceRow& row) {
        return static_cast<double>(varied == Varied::photons ? *row.photons : *row.k);
    };
    std::erase_if(all, [&](Ladder& ladder) {
        if (!is_direct(ladder)) return true;
        std::set<std::uint64_t> photons, k;
        for (const results::ConvergenceRow* row : ladder.rows) {
            if (row->photons.value_or(0) == 0 || row->k.value_or(0) == 0) return true;
            photons.insert(*row->photons);
            k.insert(*row->k);
        }
        std::sort(ladder.rows.begin(), ladder.rows.end(),
                  [&](auto a, auto b) { return place(*a) < place(*b); });
        return varied == Varied::photons ? photons.size() < 2 : photons.size() > 1 || k.size() < 2;
    });
    if (all.empty()) return skip(fmt::format("needs {}", kind.needs));

    std::vector<double> places;
    Figure figure{std::move(across), {}, {}};
    for (const Bias& measure : measures) {
        Plate plate;
        plate.label = measure.label;
        plate.height = 150;
        std::vector<double> heights;
        std::size_t lost = 0;
        std::vector<Line> expected;
        for (std::size_t l = 0; l < all.size(); ++l) {
            Line line = look_of(all[l], l), dashed = line;
            std::optional<double> scale;
            for (const results::ConvergenceRow* row : all[l].rows) {
                const double x = place(*row);
                places.push_back(x);
                const auto point = measure.point(*row, x);
                if (point) {
                    line.points.push_back(*point);
                    heights.push_back(point->y);
                    if (point->low > 0) heights.push_back(point->low);
                    if (!scale) scale = point->y / *measure.expected(*row);
                } else {
                    ++lost;
                }
                if (!scale) continue;
                dashed.points.push_back({x, *scale * *measure.expected(*row)});
            }
            if (line.points.empty()) continue;
            dashed.label = l == 0 ? "as theory expects, from the first point" : "";
            dashed.form = Line::Form::plain;
            dashed.variant = 2;
            dashed.width = 1.2;
            expected.push_back(std::move(dashed));
            plate.lines.push_back(std::move(line));
        }
        if (heights.empty()) continue;
        if (lost > 0)
            plate.remark = fmt::format("{} not told apart from 0",
                                       lost == 1 ? "1 point" : fmt::format("{} points", lost));
        plate.vertical = log_scale(heights, plain_number);
        for (Line& line : expected) {  // only where the panel is
            std::erase_if(line.points, [&](const Point& p) {
                return p.y < plate.vertical.low || p.y > plate.vertical.high;
            });
            plate.lines.push_back(std::move(line));
        }
        figure.plates.push_back(std::move(plate));
    }
    if (figure.plates.empty()) return skip("no bias is told apart from 0, and there is no variance");
    figure.horizontal = log_scale(places, [](double v) { return results::decimal_count(v); });
    Chart chart;
    chart.title = kind.title;
    chart.caption = caption_of(all);
    compose(chart, figure);
    return chart;
}

/// Three digits, or what bounds it.
std::string percent(double share) {
    return share >= 99.95 ? fmt::format("{:.0f}", share) : fmt::format("{:.3g}", share);
}

std::string setting_text(const results::ConvergenceRow& row) {
    std::string out = row.mode == "direct" ? "direct" : fmt::format("N {}", row.gather_rays.value_or(0));
    out += fmt::format(", n {}, k {}", results::decimal_count(static_cast<double>(row.photons.value_or(0))),
                       row.k.value_or(0));
    if (row.radius) out += fmt::format(", r {:.3g}", *row.radius);
    if (row.samples.value_or(1) > 1) out += fmt::format(", s {}", *row.samples);
    return out;
}

}  // namespace

std::vector<Ladder> ladders(std::span<const results::ConvergenceRow> rows) {
    std::vector<Ladder> out;
    bool several = false;
    for (const results::ConvergenceRow& row : rows) {
        if (!is_complete(row)) continue;
        several |= picture_of(row) != picture_of(*(out.empty() ? &row : out.front().rows.front()));
        const auto same = std::find_if(out.begin(), out.end(), [&](const Ladder& ladder) {
            const results::ConvergenceRow& first = *ladder.rows.front();
            return first.ladder == row.ladder && first.mode == row.mode &&
                   picture_of(first) == picture_of(row);
        });
        if (same != out.end())
            same->rows.push_back(&row);
        else
            out.push_back({row.ladder, {&row}});
    }
    for (Ladder& ladder : out) {
        const results::ConvergenceRow& row = *ladder.rows.front();
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
    const results::ConvergenceRow* before = nullptr;
    for (const results::ConvergenceRow* row : ladder.rows) {
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

std::string convergence_table(std::span<const results::ConvergenceRow> rows) {
    const std::vector<Ladder> all = ladders(rows);
    if (all.empty()) return "";
    std::string out =
        fmt::format("{:<15} {:<28} {:>8} {:>8} {:>7} {:>6} {:>6} {:>6} {:>6}\n", "ladder", "setting",
                    "render s", "total s", "RMSE %", "bias %", "dev. %", "MAPE %", "FLIP");
    for (const Ladder& ladder : all)
        for (const results::ConvergenceRow* row : ladder.rows) {
            const auto root = [&](const results::Number& square) {
                return square ? percent(percent_of_mean(*row, std::sqrt(std::max(*square, 0.0))))
                              : std::string();
            };
            const bool no_bias =
                row->bias_squared && *row->bias_squared <= 2 * row->bias_squared_stderr.value_or(0);
            std::string line =
                fmt::format("{:<15} {:<28} {:>8.3f} {:>8.3f} {:>7} {:>6} {:>6} {:>6} {:>6}", ladder.label,
                            setting_text(*row), row->render_seconds.value_or(0), *row->total_seconds,
                            (row->below_reference.value_or(false) ? "<=" : "") +
                                percent(percent_of_mean(*row, *row->rmse)),
                            no_bias ? "~0" : root(row->bias_squared), root(row->variance),
                            row->mape ? percent(100 * *row->mape) : "",
                            row->hdr_flip ? fmt::format("{:.3f}", *row->hdr_flip) : "");
            out += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
        }
    return out;
}

std::string time_table(std::span<const results::ConvergenceRow> rows) {
    const std::vector<Ladder> all = ladders(rows);
    std::vector<double> levels;
    for (const double share : {0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005})
        if (std::any_of(all.begin(), all.end(), [&](const Ladder& ladder) {
                return seconds_to(ladder, share * ladder.rows.front()->mean_radiance.value_or(0))
                           .value_or(-1) > 0;
            }))
            levels.push_back(share);
    if (levels.empty()) return "";
    std::string out = fmt::format("{:<30} {:>6}", "seconds to an RMSE of", "slope");
    for (const double share : levels) out += fmt::format(" {:>8}", fmt::format("{:g} %", 100 * share));
    out += '\n';
    for (const Ladder& ladder : all) {
        std::vector<double> x, y;
        for (const results::ConvergenceRow* row : ladder.rows)
            if (!row->below_reference.value_or(false) && *row->rmse > 0) {
                x.push_back(*row->total_seconds);
                y.push_back(*row->rmse);
            }
        const auto slope = fitted_slope(x, y);
        out += fmt::format("{:<30} {:>6}", ladder.label, slope ? fmt::format("{:.2f}", *slope) : "");
        for (const double share : levels) {
            const auto seconds = seconds_to(ladder, share * ladder.rows.front()->mean_radiance.value_or(0));
            out += fmt::format(" {:>8}", !seconds       ? "-"
                                         : *seconds < 0 ? fmt::format("<{:.3g}", -*seconds)
                                                        : fmt::format("{:.3g}", *seconds));
        }
        out += '\n';
    }
    return out;
}

Chart error_by_time(const ChartKind& kind, const Rows& rows, const ChartOptions&) {
    return over_time(kind, rows,
                     {total, relative_rmse, "RMSE [% of mean]", "seconds an image, with photon pass and tree",
                      true, true});
}

Chart error_by_render_time(const ChartKind& kind, const Rows& rows, const ChartOptions&) {
    return over_time(kind, rows,
                     {render, relative_rmse, "RMSE [% of mean]",
                      "seconds an image, queries and gathers alone", true, true});
}

Chart efficiency(const ChartKind& kind, const Rows& rows, const ChartOptions&) {
    const Value relative = [](const results::ConvergenceRow& row) -> std::optional<double> {
        if (!row.efficiency || row.mean_radiance.value_or(0) <= 0) return {};
        return *row.efficiency * *row.mean_radiance * *row.mean_radiance;
    };
    return over_time(kind, rows,
                     {total, relative, "mean² / (variance × s)",
                      "seconds an image, with photon pass and tree", false, false});
}

Chart bias_by_photons(const ChartKind& kind, const Rows& rows, const ChartOptions&) {
    return bias_chart(kind, rows, Varied::photons, "photons in the map");
}

Chart bias_by_k(const ChartKind& kind, const Rows& rows, const ChartOptions&) {
    return bias_chart(kind, rows, Varied::k, "photons of a gather (k)");
}

}  // namespace regather::charts
