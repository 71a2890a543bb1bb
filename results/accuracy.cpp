#include "results/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trace/median.h"

namespace regather::results {
namespace {

bool complete(const SamplingRow& row) {
    return row.set_sampling.value_or(0) > 0 && row.misses && row.exact_misses.value_or(0) > 0 && row.seconds;
}

/// As the row says, else by its interval.
std::optional<bool> covered(const SamplingRow& row) {
    if (row.covered || !row.misses_low || !row.misses_high) return row.covered;
    return *row.misses_low <= *row.exact_misses && *row.exact_misses <= *row.misses_high;
}

Accuracy summary(std::span<const SamplingRow* const> rows) {
    Accuracy out;
    out.first = rows.front();
    out.set_sampling = *rows.front()->set_sampling;
    out.runs = rows.size();
    std::vector<double> seconds, exact_seconds;
    double squares = 0;
    for (const SamplingRow* row : rows) {
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
    out.seconds = trace::median(seconds);
    if (!exact_seconds.empty() && out.seconds > 0) out.speed_up = trace::median(exact_seconds) / out.seconds;
    return out;
}

/// Two decimals, more below 1.
std::string percent(double share) {
    const double value = 100 * share;
    return fmt::format("{:.{}f} %", value, value >= 9.95 || value == 0 ? 1 : value >= 0.995 ? 2 : 3);
}

}  // namespace

bool same_order(const SamplingRow& a, const SamplingRow& b) {
    return a.scene == b.scene && a.ordering == b.ordering && a.parameters == b.parameters;
}

std::vector<Accuracy> accuracies(std::span<const SamplingRow> rows) {
    std::vector<std::vector<const SamplingRow*>> orders;
    for (const SamplingRow& row : rows) {
        if (!complete(row)) continue;
        auto own = std::find_if(orders.begin(), orders.end(),
                                [&](const auto& order) { return same_order(*order.front(), row); });
        if (own == orders.end()) own = orders.insert(own, std::vector<const SamplingRow*>());
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

Table accuracy_table(std::span<const SamplingRow> rows) {
    Table out({{"ordering", Align::left, {.most = 30}},
               {"rate"},
               {"runs"},
               {"RMS error"},
               {"worst error"},
               {"speed-up"},
               {"truth in 95 % CI"}});
    for (const Accuracy& one : accuracies(rows))
        out.add({one.first->parameters.empty() ? one.first->ordering : one.first->parameters,
                 fmt::format("1/{}", one.set_sampling), fmt::to_string(one.runs), percent(one.rms_error),
                 percent(one.worst_error), one.speed_up ? fmt::format("{:.1f}x", *one.speed_up) : "",
                 one.intervals == 0
                     ? ""
                     : percent(static_cast<double>(one.covered) / static_cast<double>(one.intervals))});
    return out;
}

}  // namespace regather::results
