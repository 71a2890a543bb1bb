#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "charts/kinds.h"
#include "charts/lettering.h"
#include "results/geometry.h"
#include "trace/error.h"

namespace regather::charts {
namespace {

using results::ComputationRow;

constexpr double bar_height = 17, name_size = 11, name_width = 235, half_bar = 0.36;
constexpr double least_share = 0.25,
                 beside = 0.015;  // of the axis: a bar that holds its text; room before a text
constexpr const char *divided_colour = "#56b4e9", *times_colour = "#e69f00", *on_bars = "#000000";

struct Change {
    const ComputationRow* row;
    double divided, times;  ///< [% of the total]
};

/// The rows of one estimate.
struct Model {
    const ComputationRow* first;
    std::vector<Change> changes = {};  ///< Those that are any, by their swing.
};

double change(const results::Number& total, const ComputationRow& row) {
    return 100 * (*total - *row.total_flop) / *row.total_flop;
}

bool same_model(const ComputationRow& a, const ComputationRow& b) {
    return a.scene == b.scene && a.model == b.model && a.factor == b.factor;
}

/// In the order of their first rows.
std::vector<Model> models_of(std::span<const ComputationRow> rows) {
    std::vector<Model> models;
    for (const ComputationRow& row : rows) {
        if (!row.total_flop || !(*row.total_flop > 0) || !row.divided_total_flop || !row.times_total_flop)
            continue;
        if (*row.divided_total_flop > *row.total_flop || *row.times_total_flop < *row.total_flop)
            throw trace::DataError(fmt::format(
                "the estimate {} of {} has divided_total_flop {}, total_flop {} and times_total_flop {}, "
                "expected "
                "them in ascending order",
                row.model, row.parameter, *row.divided_total_flop, *row.total_flop, *row.times_total_flop));
        auto model = std::find_if(models.begin(), models.end(),
                                  [&](const Model& m) { return same_model(*m.first, row); });
        if (model == models.end()) model = models.insert(model, Model{&row});
        const bool known = std::any_of(model->changes.begin(), model->changes.end(),
                                       [&](const Change& c) { return c.row->parameter == row.parameter; });
        if (known)
            throw trace::DataError(
                fmt::format("two rows of the estimate {} are of the parameter {}", row.model, row.parameter));
        if (results::swing(row) != 0)
            model->changes.push_back(
                {&row, change(row.divided_total_flop, row), change(row.times_total_flop, row)});
    }
    std::erase_if(models, [](const Model& model) { return model.changes.empty(); });
    for (Model& model : models)
        std::stable_sort(model.changes.begin(), model.changes.end(), [](const Change& a, const Change& b) {
            return std::abs(a.times - a.divided) > std::abs(b.times - b.divided);
        });
    return models;
}

/// From a round number at or below `low` to one at or above `high`, with 0 between them.
Scale across_zero(double low, double high) {
    Scale out = linear_scale(std::max(high, -low), plain_number);
    const double step = out.ticks[1].first;
    std::erase_if(out.ticks, [&](const auto& tick) { return tick.first >= high + step; });
    out.high = out.ticks.back().first;
    for (out.low = 0; out.low > low;) {
        out.low -= step;
        out.ticks.insert(out.ticks.begin(), {out.low, plain_number(out.low)});
    }
    return out;
}

/// "431.4 GFLOP" and the like.
std::string flop_text(double flop) {
    constexpr std::pair<double, const char*> units[] = {{1e12, "TFLOP"}, {1e9, "GFLOP"}, {1e6, "MFLOP"}};
    for (const auto& [unit, name] : units)
        if (flop >= unit) return fmt::format("{:.4g} {}", flop / unit, name);
    return fmt::format("{:.4g} FLOP", flop);
}

/// 786432, 95.71
std::string value_of(double value) {
    return std::floor(value) == value ? fmt::format("{:.10g}", value) : fmt::format("{:.4g}", value);
}

Panel tornado(const Model& model, const Scale& across) {
    Panel panel;
    const auto count = static_cast<double>(model.changes.size());
    panel.height = bar_height * count;
    panel.tick_size = name_size;
    panel.up.scale = {false, 0, count, {}};
    const ComputationRow& of = *model.first;
    panel.remark = fmt::format("{}: {}", of.scene.empty() ? of.model : of.scene + ", " + of.model,
                               flop_text(*of.total_flop));
    const std::string factor = of.factor ? fmt::format("{:g}", *of.factor) : "a factor";
    for (std::size_t i = 0; i < model.changes.size(); ++i) {
        const auto& [row, divided, times] = model.changes[i];
        const double at = count - static_cast<double>(i) - 0.5;
        const std::string name = row->what.empty() ? row->parameter : row->what;
        const std::string value = row->value ? ": " + value_of(*row->value) : "";
        panel.up.scale.ticks.emplace_back(
            at, fitting(name, name_size, name_width - text_width(value, name_size)) + value);
        const std::string divided_text = fmt::format("{:+.1f} %", divided),
                          times_text = fmt::format("{:+.1f} %", times);
        const bool inside = times >= least_share * (across.high - across.low);
        panel.boxes.push_back({divided, 0, at - half_bar, at + half_bar, "divided by " + factor,
                               divided_colour, divided_text, on_bars});
        panel.boxes.push_back({0, times, at - half_bar, at + half_bar, "times " + factor, times_colour,
                               inside ? times_text : "", on_bars});
        if (!inside) panel.notes.push_back({times + beside * (across.high - across.low), at, times_text});
    }
    Line zero;
    zero.colour = "#303030";
    zero.width = 1;
    zero.form = Line::Form::plain;
    zero.points = {{0, 0}, {0, count}};
    panel.lines.push_back(std::move(zero));
    return panel;
}

}  // namespace

Chart computation(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    const std::vector<Model> models = models_of(rows.of<ComputationRow>());
    if (models.empty()) return skip(fmt::format("needs {}", kind.needs));
    double low = 0, high = 0;
    for (const Model& model : models)
        for (const Change& change : model.changes) {
            low = std::min(low, change.divided);
            high = std::max(high, change.times);
        }
    const Scale across = across_zero(low, high);
    std::vector<Panel> panels;
    for (const Model& model : models) panels.push_back(tornado(model, across));
    return draw({std::string(kind.title),
                 "of a frame; each parameter alone, the others held; those that change nothing are left out",
                 {"change of the total [%]", across},
                 std::move(panels)});
}

}  // namespace regather::charts
