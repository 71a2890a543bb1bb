#include "charts/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "charts/caption.h"
#include "charts/series.h"
#include "results/accuracy.h"
#include "results/parameters.h"

namespace regather::charts {
namespace {

/// As series.h knows it. The cache is any: a point stands for all caches.
results::Row subject_of(const results::SamplingRow& row) {
    results::Row out;
    out.scene = row.scene;
    out.ordering = row.ordering;
    out.parameters = row.parameters;
    out.tile = results::parameter(row.parameters, "tile");
    out.bins = results::parameter(row.parameters, "bins");
    out.cache_bytes = out.line_bytes = out.ways = 1;
    out.traffic_bytes = 0;
    return out;
}

/// A curve for each ordering: series.h shows one tile size at a time, so it is asked until all were shown.
struct Named {
    const results::SamplingRow* row;
    Curve curve;
};
std::vector<Named> named(std::span<const results::Accuracy> all, std::vector<results::Row>& subjects) {
    std::vector<const results::SamplingRow*> orders;
    for (const results::Accuracy& one : all)
        if (orders.empty() || !results::same_order(*orders.back(), *one.first)) orders.push_back(one.first);
    for (const results::SamplingRow* order : orders) subjects.push_back(subject_of(*order));
    std::vector<bool> shown(orders.size());
    std::vector<Named> out(orders.size());
    while (std::find(shown.begin(), shown.end(), false) != shown.end()) {
        std::vector<results::Row> rest;
        std::vector<std::size_t> places;
        for (std::size_t i = 0; i < orders.size(); ++i)
            if (!shown[i]) {
                rest.push_back(subjects[i]);
                places.push_back(i);
            }
        for (Curve& curve : curves(rest, Along::cache, {{1, 1, 1}, 16, 16})) {
            const std::size_t i = places[static_cast<std::size_t>(curve.rows.front() - rest.data())];
            curve.rows = {&subjects[i]};
            curve.variant = static_cast<int>(
                std::count_if(orders.begin(), orders.begin() + static_cast<std::ptrdiff_t>(i),
                              [&](auto other) { return other->ordering == orders[i]->ordering; }));
            shown[i] = true;
            out[i] = {orders[i], std::move(curve)};
        }
    }
    return out;
}

/// Of more than two curves only the uppermost keeps its labels; the others' would lie on each other.
void keep_upper_labels(std::vector<Line>& lines) {
    if (lines.size() <= 2) return;
    const auto height = [](const Line& line) {
        double sum = 0;
        for (const Point& point : line.points) sum += std::log(point.y);
        return sum / static_cast<double>(line.points.size());
    };
    const auto upper = std::max_element(lines.begin(), lines.end(),
                                        [&](const Line& a, const Line& b) { return height(a) < height(b); });
    for (Line& line : lines)
        if (&line != &*upper)
            for (Point& point : line.points) point.label.clear();
}

/// "1/64 ... 1/2 of the sets"
std::string rates_text(std::span<const results::Accuracy> all) {
    std::uint64_t least = all.front().set_sampling, most = least;
    for (const results::Accuracy& one : all) {
        least = std::min(least, one.set_sampling);
        most = std::max(most, one.set_sampling);
    }
    return least == most ? fmt::format("1/{} of the sets", most)
                         : fmt::format("1/{} ... 1/{} of the sets", most, least);
}

}  // namespace

Chart sampling_error(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    std::vector<results::Accuracy> all = results::accuracies(rows.of<results::SamplingRow>());
    // Neither a run of every set nor one without an error or a time has a place on log axes.
    std::erase_if(all, [](const results::Accuracy& one) {
        return one.set_sampling == 1 || one.rms_error == 0 || one.seconds == 0;
    });
    if (all.empty()) return skip(fmt::format("needs {} with an error and seconds above 0", kind.needs));

    Panel error, coverage;
    error.up.label = "RMS error of misses [%]";
    error.height = 230;
    coverage.up.label = "truth in 95 % CI [%]";
    coverage.height = 120;
    std::vector<double> seconds, errors;
    double least_covered = 90;
    std::vector<results::Row> subjects;
    std::vector<Curve> drawn;
    for (const Named& order : named(all, subjects)) {
        Line above = line_of(order.curve), below = above;
        drawn.push_back(order.curve);
        for (const results::Accuracy& one : all) {
            if (!results::same_order(*one.first, *order.row)) continue;
            seconds.push_back(one.seconds);
            errors.push_back(100 * one.rms_error);
            above.points.push_back({one.seconds, errors.back(), fmt::format("1/{}", one.set_sampling)});
            if (one.intervals == 0) continue;
            const double share = 100 * static_cast<double>(one.covered) / static_cast<double>(one.intervals);
            least_covered = std::min(least_covered, share);
            below.points.push_back({one.seconds, share});
        }
        error.lines.push_back(std::move(above));
        coverage.lines.push_back(std::move(below));
    }
    keep_upper_labels(error.lines);
    error.up.scale = log_scale(errors, plain_number);
    Scale time = log_scale(seconds, plain_number);
    time.high *= 1.25;  // room for the last labels
    const bool any_interval = std::any_of(coverage.lines.begin(), coverage.lines.end(),
                                          [](const Line& l) { return !l.points.empty(); });
    const std::string parts[] = {caption(drawn, ""), rates_text(all)};
    Figure figure{std::string(kind.title),
                  results::joined(parts, " · "),
                  {"seconds of the sampled run (median)", time},
                  {std::move(error)}};
    if (any_interval) {
        const double step = least_covered >= 80 ? 5 : 20;
        coverage.up.scale = {false, std::floor(least_covered / step) * step, 101, {}};
        for (double tick = coverage.up.scale.low; tick <= 100; tick += step)
            coverage.up.scale.ticks.emplace_back(tick, plain_number(tick));
        Line nominal;
        nominal.label = "nominal 95 %";
        nominal.colour = "#606060";
        nominal.width = 1;
        nominal.form = Line::Form::rule;
        nominal.points = {{0, 95}};
        coverage.lines.push_back(std::move(nominal));
        figure.panels.push_back(std::move(coverage));
    }
    return draw(figure);
}

}  // namespace regather::charts
