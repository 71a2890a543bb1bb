// tests/charts/drawing.h -- what a composed chart draws, read back from its gnuplot script.
#pragma once
#include <string>

#include "charts/chart.h"

namespace regather::charts {

inline Chart compose(std::string_view name, const results::Rows& rows, const ChartOptions& options = {}) {
    const ChartKind& kind = chart_kind(name);
    return kind.compose(kind, rows, options);
}

/// The numbers, as written, of the data block that begins with `block` ("$line_0", "$box_1") and has the
/// label.
inline std::string data_of(const Chart& chart, const std::string& block, const std::string& label) {
    const std::string text = script(chart, Picture::svg);
    const std::size_t at = text.find("# '" + label + "'\n" + block + "_");
    if (at == text.npos) return "absent";
    const std::size_t start = text.find("<< EOD\n", at) + 7;
    return text.substr(start, text.find("EOD", start) - start);
}

}  // namespace regather::charts
