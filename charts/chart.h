// charts/chart.h -- the charts: rows in, SVG and PNG out, drawn by gnuplot. How to read each:
// docs/charts.md. Each is drawn from one kind of rows by the file in kinds/ that bears its name.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "charts/figure.h"
#include "results/geometry.h"
#include "results/rows.h"

namespace regather::charts {

struct ChartOptions {
    std::optional<results::Geometry> cache;  ///< None: commonest_geometry() of the rows.
    std::uint64_t tile = 16, bins = 16;      ///< Held where they are not the axis; series.h, Slice.
};

struct ChartKind {
    std::string_view name, title, needs;
    bool (*has_rows)(const results::Rows&);  ///< Whether there are any of the kind that it is drawn from.
    Chart (*compose)(const ChartKind&, const results::Rows&, const ChartOptions&);
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
std::vector<const ChartKind*> wanted_kinds(const results::Rows& rows, std::span<const std::string> names);

/// Where a chart is drawn to: FOLDER/KIND.svg and FOLDER/KIND.png.
std::array<std::filesystem::path, 2> files_of(const std::filesystem::path& folder, const ChartKind& kind);

/// Draws the wanted kinds into `folder`, made when missing; existing files are replaced.
std::vector<Drawn> write_charts(const std::filesystem::path& folder, const results::Rows& rows,
                                std::span<const std::string> kinds, const ChartOptions& options);

}  // namespace regather::charts
