// charts/chart.h -- the charts: rows in, SVG and PNG out, drawn by gnuplot. How to read each:
// docs/charts.md. Each kind is composed from one kind of rows by the file that bears its noun.
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "results/csv.h"
#include "results/geometry.h"

namespace regather::charts {

struct ChartOptions {
    std::optional<results::Geometry> cache;  ///< None: commonest_geometry() of the rows.
    std::uint64_t tile = 16, bins = 16;      ///< Held where they are not the axis; series.h, Slice.
};

/// A composed chart: what gnuplot is to draw, without the kind of file.
struct Chart {
    std::string title, caption;
    unsigned width = 0, height = 0;  ///< [SVG pixels]; a PNG has twice as many.
    std::string commands;
    std::string skipped;  ///< Why there is nothing to draw; then all else is empty.
};

inline Chart skip(std::string reason) {
    Chart chart;
    chart.skipped = std::move(reason);
    return chart;
}

/// All that there is to draw from.
struct Rows {
    std::span<const results::Row> measurements;
    std::span<const results::DetailRow> details;
    std::span<const results::TimelineRow> timeline;
    std::span<const results::SamplingRow> sampling;
    std::span<const results::ConvergenceRow> convergence = {};
    std::span<const results::StabilityRow> stability = {};
};

struct ChartKind {
    std::string_view name, title, needs;
    results::RowKind rows;  ///< What it is drawn from.
    Chart (*compose)(const ChartKind&, const Rows&, const ChartOptions&);
};
std::span<const ChartKind> chart_kinds();

/// Throws trace::UsageError that lists the known names.
const ChartKind& chart_kind(std::string_view name);

enum class Picture { svg, png };

/// The whole gnuplot script of a chart that was not skipped. The same rows give the same bytes.
std::string script(const Chart& chart, Picture picture);

/// The bytes of the picture. Throws std::runtime_error with one line when gnuplot is missing or fails.
std::string render(const Chart& chart, Picture picture);

struct Drawn {
    std::string_view kind;
    std::vector<std::filesystem::path> files;  ///< KIND.svg and KIND.png; none when skipped.
    std::string skipped;
};

/// By names; without, every kind for whose rows there are any. Throws as chart_kind().
std::vector<const ChartKind*> wanted_kinds(const Rows& rows, std::span<const std::string> names);

/// Draws the wanted kinds into `folder`, made when missing; existing files are replaced.
std::vector<Drawn> write_charts(const std::filesystem::path& folder, const Rows& rows,
                                std::span<const std::string> kinds, const ChartOptions& options);
std::vector<Drawn> write_charts(const std::filesystem::path& folder, std::span<const results::Row> rows,
                                std::span<const std::string> kinds, const ChartOptions& options);

}  // namespace regather::charts
