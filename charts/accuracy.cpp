#include "charts/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "charts/caption.h"
#include "charts/figure.h"
#include "charts/series.h"
#include "results/parameters.h"

namespace regather::charts {
namespace {

/// Of two middle values the mean.
double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

bool complete(const results::SamplingRow& row) {
    return row.set_sampling.value_or(0) > 0 && row.misses && row.exact_misses.value_or(0) > 0 && row.seconds;
}

bool same_order(const results::SamplingRow& a, const results::SamplingRow& b) {
    return a.scene == b.scene && a.ordering == b.ordering && a.parameters == b.parameters;
}

/// As the row says, else by its interval.
std::optional<bool> covered(const results::SamplingRow& row) {
    if (row.covered || !row.misses_low || !row.misses_high) return row.covered;
    return *row.misses_low <= *row.exact_misses && *row.exact_misses <= *row.misses_high;
}

Accuracy summary(std::span<const results::SamplingRow* const> rows) {
    Accuracy out;
    out.first = rows.front();
    out.set_sampling = *rows.front()->set_sampling;
    out.runs = rows.size();
    std::vector<double> seconds, exact_seconds;
    double squares = 0;
    for (const results::SamplingRow* row : rows) {
        const auto exact = static_cast<double>(*row->exact_misses);
        const double error = std::abs(static_cast<double>(*row->misses) - exact) / exact;
        squares += error * error;
        out.worst_error = std::max(out.worst_error, error);
        seconds.push_back(*row->seconds);
        if (row->exact_seconds) exact_seconds.push_back(*row->exact_seconds);
        if (const auto held = covered(*row)) {
            ++out.intervals;
            out.covered += *held;
        }
    }
    out.rms_error = std::sqrt(squares / static_cast<double>(rows.size()));
    out.seconds = median(seconds);
    if (!exact_seconds.empty() && out.seconds > 0) out.speed_up = median(exact_seconds) / out.seconds;
    return out;
}

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
std::vector<Named> named(std::span<const Accuracy> all, std::vector<results::Row>& subjects) {
    std::vector<const results::SamplingRow*> orders;
    for (const Accuracy& one : all)
        if (orders.empty() || !same_order(*orders.back(), *one.first)) orders.push_back(one.first);
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
        for (Curve& curve : curves(rest, Axis::cache, {{1, 1, 1}, 16, 16})) {
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

/// Two decimals, more below 1.
std::string percent(double share) {
    const double value = 100 * share;
    return fmt::format("{:.{}f} %", value, value >= 9.95 || value == 0 ? 1 : value >= 0.995 ? 2 : 3);
}

std::string cut(const std::string& text, std::size_t most) {
    return text.size() > most ? text.substr(0, most - 3) + "..." : text;
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
std::string rates_text(std::span<const Accuracy> all) {
    std::uint64_t least = all.front().set_sampling, most = least;
    for (const Accuracy& one : all) {
        least = std::min(least, one.set_sampling);
        most = std::max(most, one.set_sampling);
    }
    return least == most ? fmt::format("1/{} of the sets", most)
                         : fmt::format("1/{} ... 1/{} of the sets", most, least);
}

}  // namespace

std::vector<Accuracy> accuracies(std::span<const results::SamplingRow> rows) {
    std::vector<std::vector<const results::SamplingRow*>> orders;
    for (const results::SamplingRow& row : rows) {
        if (!complete(row)) continue;
        auto own = std::find_if(orders.begin(), orders.end(),
                                [&](const auto& order) { return same_order(*order.front(), row); });
        if (own == orders.end()) own = orders.insert(own, std::vector<const results::SamplingRow*>());
        own->push_back(&row);
    }
    std::vector<Accuracy> out;
    for (auto& order : orders) {
        std::stable_sort(order.begin(), order.end(),
                         [](auto a, auto b) { return *a->set_sampling < *b->set_sampling; });
        for (std::size_t from = 0, to = 0; from < order.size(); from = to) {
            while (to < order.size() && order[to]->set_sampling == order[from]->set_sampling) ++to;
            out.push_back(summary(std::span(order).subspan(from, to - from)));
        }
    }
    return out;
}

std::string accuracy_table(std::span<const results::SamplingRow> rows) {
    const std::vector<Accuracy> all = accuracies(rows);
    if (all.empty()) return "";
    std::string out = fmt::format("{:<30}  {:>7}  {:>5}  {:>9}  {:>11}  {:>8}  {:>16}\n", "ordering", "rate",
                                  "runs", "RMS error", "worst error", "speed-up", "truth in 95 % CI");
    for (const Accuracy& one : all) {
        const std::string& name = one.first->parameters.empty() ? one.first->ordering : one.first->parameters;
        const std::string held =
            one.intervals == 0
                ? ""
                : percent(static_cast<double>(one.covered) / static_cast<double>(one.intervals));
        std::string line = fmt::format("{:<30}  {:>7}  {:>5}  {:>9}  {:>11}  {:>8}  {:>16}", cut(name, 30),
                                       fmt::format("1/{}", one.set_sampling), one.runs,
                                       percent(one.rms_error), percent(one.worst_error),
                                       one.speed_up ? fmt::format("{:.1f}x", *one.speed_up) : "", held);
        out += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    }
    return out;
}

Chart sampling_error(const ChartKind& kind, const Rows& rows, const ChartOptions&) {
    std::vector<Accuracy> all = accuracies(rows.sampling);
    // Neither a run of every set nor one without an error or a time has a place on log axes.
    std::erase_if(all, [](const Accuracy& one) {
        return one.set_sampling == 1 || one.rms_error == 0 || one.seconds == 0;
    });
    if (all.empty()) return skip(fmt::format("needs {} with an error and seconds above 0", kind.needs));

    Plate error, coverage;
    error.label = "RMS error of misses [%]";
    error.height = 230;
    coverage.label = "truth in 95 % CI [%]";
    coverage.height = 120;
    std::vector<double> seconds, errors;
    double least_covered = 90;
    std::vector<results::Row> subjects;
    std::vector<Curve> drawn;
    for (const Named& order : named(all, subjects)) {
        Line above = line_of(order.curve), below = above;
        drawn.push_back(order.curve);
        for (const Accuracy& one : all) {
            if (!same_order(*one.first, *order.row)) continue;
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
    error.vertical = log_scale(errors, plain_number);
    Scale time = log_scale(seconds, plain_number);
    time.high *= 1.25;  // room for the last labels
    const bool any_interval = std::any_of(coverage.lines.begin(), coverage.lines.end(),
                                          [](const Line& l) { return !l.points.empty(); });
    Figure figure{"seconds of the sampled run (median)", time, {std::move(error)}};
    if (any_interval) {
        const double step = least_covered >= 80 ? 5 : 20;
        coverage.vertical = {false, std::floor(least_covered / step) * step, 101, {}};
        for (double tick = coverage.vertical.low; tick <= 100; tick += step)
            coverage.vertical.ticks.emplace_back(tick, plain_number(tick));
        Line nominal;
        nominal.label = "nominal 95 %";
        nominal.colour = "#606060";
        nominal.width = 1;
        nominal.form = Line::Form::plain;
        nominal.points = {{time.low, 95}, {time.high, 95}};
        coverage.lines.push_back(std::move(nominal));
        figure.plates.push_back(std::move(coverage));
    }
    Chart chart;
    chart.title = kind.title;
    const std::string parts[] = {caption(drawn, ""), rates_text(all)};
    chart.caption = results::joined(parts, " · ");
    compose(chart, figure);
    return chart;
}

}  // namespace regather::charts
