#include "results/computation_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "results/geometry.h"

namespace regather::results {
namespace {

constexpr Column computation_columns[] = {
    column<&ComputationRow::scene>("scene"),
    column<&ComputationRow::model>("model", Form::name, needed),
    column<&ComputationRow::parameter>("parameter", Form::name, needed),
    column<&ComputationRow::what>("what"),
    column<&ComputationRow::value>("value"),
    column<&ComputationRow::source>("source"),
    column<&ComputationRow::factor>("factor"),
    column<&ComputationRow::rays>("rays"),
    column<&ComputationRow::generation_flop>("generation_flop"),
    column<&ComputationRow::casting_flop>("casting_flop"),
    column<&ComputationRow::gather_flop>("gather_flop"),
    column<&ComputationRow::sampling_flop>("sampling_flop"),
    column<&ComputationRow::caching_flop>("caching_flop"),
    column<&ComputationRow::total_flop>("total_flop", needed),
    column<&ComputationRow::divided_total_flop>("divided_total_flop", needed),
    column<&ComputationRow::times_total_flop>("times_total_flop", needed),
};

std::string change(const Number& total, const ComputationRow& row) {
    const double of = row.total_flop.value_or(0);
    if (!total || !(of > 0)) return "";
    return *total == of ? "0 %" : fmt::format("{:+.1f} %", 100 * (*total - of) / of);
}

}  // namespace

const RowKind& ComputationRow::kind() {
    static constexpr RowKind kind{"computation", computation_columns};
    return kind;
}

double swing(const ComputationRow& row) {
    return row.times_total_flop.value_or(0) - row.divided_total_flop.value_or(0);
}

Table sensitivity_table(std::span<const ComputationRow> rows) {
    std::vector<std::string> models, parameters;
    const auto include = [](std::vector<std::string>& all, const std::string& one) {
        if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
    };
    for (const ComputationRow& row : rows) {
        include(models, row.model);
        include(parameters, row.parameter);
    }
    std::vector<Table::Head> heads{{"parameter", Align::left}, {"what", Align::left}};
    for (const std::string& model : models) heads.push_back({model});
    Table out(std::move(heads));
    const auto row_of = [&](const std::string& model, const std::string& parameter) {
        return std::find_if(rows.begin(), rows.end(), [&](const ComputationRow& row) {
            return row.model == model && row.parameter == parameter;
        });
    };
    const auto swing_of = [&](const std::string& model, const std::string& parameter) {
        const auto row = row_of(model, parameter);
        return row == rows.end() ? 0 : swing(*row);
    };
    std::stable_sort(parameters.begin(), parameters.end(), [&](const auto& a, const auto& b) {
        return swing_of(models.back(), a) > swing_of(models.back(), b);
    });
    std::vector<std::string> without;
    for (const std::string& parameter : parameters) {
        if (std::all_of(models.begin(), models.end(),
                        [&](const auto& model) { return swing_of(model, parameter) == 0; })) {
            without.push_back(parameter);
            continue;
        }
        std::vector<std::string> cells{parameter, ""};
        for (const std::string& model : models) {
            const auto row = row_of(model, parameter);
            if (row != rows.end()) cells[1] = row->what;
            cells.push_back(row == rows.end() ? ""
                                              : fmt::format("{} {:>8}", change(row->divided_total_flop, *row),
                                                            change(row->times_total_flop, *row)));
        }
        out.add(std::move(cells));
    }
    const double factor = rows.empty() ? 0 : rows.front().factor.value_or(0);
    out.title = fmt::format(
        "change of the total when one parameter alone is divided by {0:g} and times {0:g}", factor);
    if (!without.empty()) out.notes.push_back(fmt::format("no change by: {}", joined(without, ", ")));
    return out;
}

}  // namespace regather::results
