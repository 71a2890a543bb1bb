#include "results/stability_row.h"

#include <fmt/format.h>

namespace regather::results {
namespace {

constexpr Column stability_columns[] = {
    column<&StabilityRow::group>("group", needed),
    column<&StabilityRow::stability_case>("case", needed),
    column<&StabilityRow::quantity>("quantity"),
    column<&StabilityRow::error>("error", needed),
    column<&StabilityRow::allowed_error>("allowed_error", needed),
    column<&StabilityRow::passed>("passed"),
    column<&StabilityRow::seconds>("seconds", Form::seconds),
    column<&StabilityRow::reason>("reason"),
};

std::string number(const Number& value) {
    return !value ? "not finite" : *value == 0 ? "0" : fmt::format("{:.2e}", *value);
}

}  // namespace

const RowKind& StabilityRow::kind() {
    static constexpr RowKind kind{"stability", stability_columns};
    return kind;
}

Table stability_table(std::span<const StabilityRow> rows) {
    Table out({{"group", Align::left, {.most = 10}},
               {"case", Align::left, {.most = 46}},
               {"error"},
               {"allowed"},
               {"seconds"},
               {"of", Align::left},
               {"", Align::left, {.if_any = true}}});
    std::size_t passed = 0;
    for (const StabilityRow& row : rows) {
        const bool good = row.passed.value_or(false);
        passed += good;
        out.add({row.group, row.stability_case, number(row.error), number(row.allowed_error),
                 row.seconds ? fmt::format("{:.2f}", *row.seconds) : "", row.quantity, good ? "" : "FAILED"});
    }
    out.notes.push_back(fmt::format("{} of {} cases passed", passed, rows.size()));
    return out;
}

}  // namespace regather::results
