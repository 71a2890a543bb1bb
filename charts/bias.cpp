#include "charts/bias.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "charts/ladder_look.h"
#include "results/geometry.h"

namespace regather::charts {
namespace {

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
    {"deviation, interior [%]",
     [](const results::ConvergenceRow& row, double x) -> std::optional<Point> {
         const double mean = row.interior_mean_radiance.value_or(0);
         if (row.interior_variance.value_or(0) <= 0 || mean <= 0) return {};
         return Point{x, 100 * std::sqrt(*row.interior_variance) / mean};
     },
     root_of_k},
};

}  // namespace

Chart bias_chart(const ChartKind& kind, const results::Rows& rows, Varied varied, std::string across) {
    std::vector<results::Ladder> all = results::ladders(rows.of<results::ConvergenceRow>());
    const auto place = [&](const results::ConvergenceRow& row) {
        return static_cast<double>(varied == Varied::photons ? *row.photons : *row.k);
    };
    std::erase_if(all, [&](results::Ladder& ladder) {
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
    Figure figure{std::string(kind.title), caption(all), {std::move(across), {}}};
    for (const Bias& measure : measures) {
        Panel panel;
        panel.up.label = measure.label;
        panel.height = 150;
        std::vector<double> heights;
        std::size_t lost = 0;
        std::vector<Line> expected;
        for (std::size_t l = 0; l < all.size(); ++l) {
            Line line = line_of(all[l], l), dashed = line;
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
            panel.lines.push_back(std::move(line));
        }
        if (heights.empty()) continue;
        if (lost > 0)
            panel.remark = fmt::format("{} not told apart from 0",
                                       lost == 1 ? "1 point" : fmt::format("{} points", lost));
        panel.up.scale = log_scale(heights, plain_number);
        for (Line& line : expected) {  // only where the panel is
            std::erase_if(line.points, [&](const Point& p) {
                return p.y < panel.up.scale.low || p.y > panel.up.scale.high;
            });
            panel.lines.push_back(std::move(line));
        }
        figure.panels.push_back(std::move(panel));
    }
    if (figure.panels.empty()) return skip("no bias is told apart from 0, and there is no variance");
    figure.across.scale = log_scale(places, [](double v) { return results::decimal_count(v); });
    return draw(figure);
}

}  // namespace regather::charts
