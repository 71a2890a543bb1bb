#include "charts/kinds.h"

#include <fmt/format.h>

#include <algorithm>

#include "charts/caption.h"
#include "charts/subject.h"

namespace regather::charts {
namespace {

constexpr std::size_t most_markers = 16;

}  // namespace

Chart timeline(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    std::vector<const results::TimelineRow*> slices;
    for (const results::TimelineRow& row : rows.of<results::TimelineRow>())
        if (row.first_query && row.queries.value_or(0) > 0 && row.misses) slices.push_back(&row);
    if (slices.empty())
        return skip(fmt::format("needs {}, with first_query, queries and misses", kind.needs));
    std::stable_sort(slices.begin(), slices.end(),
                     [](auto a, auto b) { return *a->first_query < *b->first_query; });
    const auto shown = subjects<results::TimelineRow>(slices, options);
    if (!shown.skipped.empty()) return skip(shown.skipped);

    Panel panel;
    panel.up.label = "misses per query";
    panel.height = 250;
    std::vector<double> heights;
    std::string silent;
    for (const auto& subject : shown.all) {
        const results::TimelineRow& last = *subject.rows.back();
        const double total = results::number(last.first_query) + results::number(last.queries);
        Line line = line_of(subject.curve);
        line.every = 1 + (subject.rows.size() - 1) / most_markers;
        bool any = false;
        for (const results::TimelineRow* row : subject.rows) {
            const double per_query = results::number(row->misses) / results::number(row->queries);
            const double middle = results::number(row->first_query) + results::number(row->queries) / 2;
            any |= per_query > 0;
            if (per_query > 0) heights.push_back(per_query);
            // A log axis has no 0: the curve breaks off.
            line.points.push_back(per_query > 0 ? Point{100 * middle / total, per_query} : gap);
        }
        if (any)
            panel.lines.push_back(std::move(line));
        else
            silent += (silent.empty() ? "No misses: " : "; ") + subject.curve.label;
    }
    if (heights.empty()) return skip("no misses above 0");
    panel.remark = silent;
    panel.up.scale = log_scale(heights, plain_number);

    std::string text = results::geometry_text(shown.cache);
    return draw({std::string(kind.title),
                 caption(curves_of(shown), text.insert(text.find(','), " cache")),
                 {"share of the run's queries [%]", percent_scale()},
                 {std::move(panel)}});
}

}  // namespace regather::charts
