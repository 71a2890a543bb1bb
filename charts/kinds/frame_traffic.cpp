#include "charts/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "charts/lettering.h"
#include "results/geometry.h"

namespace regather::charts {
namespace {

using results::FrameRow;

struct Look {
    const char *colour, *text_colour;
};
/// Okabe & Ito's palette, by the part's place in the frame.
constexpr Look looks[] = {{"#56b4e9", "#000000"}, {"#000000", "#ffffff"}, {"#009e73", "#ffffff"},
                          {"#e69f00", "#000000"}, {"#0072b2", "#ffffff"}, {"#cc79a7", "#000000"}};
constexpr double bar_pixels = 38;  // a bar's name stands above it
constexpr double phase_width = 330;

/// One run through one machine.
struct Bar {
    const FrameRow* first;
    std::vector<std::string> orderings = {};   ///< Of its parts, each once.
    std::map<std::string, double> bytes = {};  ///< By part: to and from memory.
};

bool same_run(const FrameRow& a, const FrameRow& b) {
    return a.scene == b.scene && a.frame == b.frame && a.machine == b.machine && a.unit == b.unit &&
           a.run == b.run;
}

/// Of each machine, the cache that memory is behind.
std::map<std::string, std::string> last_levels(std::span<const FrameRow> rows) {
    std::map<std::string, std::string> levels;
    for (const FrameRow& row : rows)
        if (row.bytes_in) levels[row.machine] = row.level;
    return levels;
}

/// The rows of a run stand together.
std::vector<Bar> bars_of(std::span<const FrameRow> rows, std::vector<std::string>& parts) {
    const std::map<std::string, std::string> levels = last_levels(rows);
    const auto include = [](std::vector<std::string>& all, const std::string& one) {
        if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
    };
    std::vector<Bar> bars;
    for (const FrameRow& row : rows) {
        if (!row.bytes_in || levels.at(row.machine) != row.level) continue;
        if (bars.empty() || !same_run(*bars.back().first, row)) bars.push_back({&row});
        include(parts, row.part);
        include(bars.back().orderings, row.parameters.empty() ? row.ordering : row.parameters);
        bars.back().bytes[row.part] += static_cast<double>(*row.bytes_in + row.bytes_out.value_or(0));
    }
    return bars;
}

std::string joined(const std::vector<std::string>& texts) {
    return results::joined(texts, ", ");
}

}  // namespace

Chart frame_traffic(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    std::vector<std::string> parts;
    const std::vector<Bar> bars = bars_of(rows.of<FrameRow>(), parts);
    if (bars.empty()) return skip(fmt::format("needs {}", kind.needs));
    const FrameRow& row = *bars.front().first;
    const auto differs = [&](const auto& of) {
        return std::any_of(bars.begin(), bars.end(),
                           [&](const Bar& bar) { return of(bar) != of(bars.front()); });
    };
    const bool scenes = differs([](const Bar&bar) { return std::pair(bar.first->scene, bar.first->frame); }),
               machines = differs([](const Bar&bar) { return bar.first->machine; }),
               orderings = differs([](const Bar&bar) { return bar.orderings; });
    const auto scene = [](const FrameRow& of) {
        return of.frame ? fmt::format("{}, frame {}", of.scene, *of.frame) : of.scene;
    };

    Panel panel;
    panel.height = bar_pixels * static_cast<double>(bars.size());
    panel.up.scale = {false, 0, static_cast<double>(bars.size()), {}};
    panel.bare = true;
    double most = 0;
    for (const Bar& bar : bars) {
        double sum = 0;
        for (const auto& [part, bytes] : bar.bytes) sum += bytes;
        most = std::max(most, sum);
    }
    if (most == 0) return skip("no traffic above 0");
    const Scale across = linear_scale(most, byte_number);
    for (std::size_t b = 0; b < bars.size(); ++b) {
        const double base = static_cast<double>(bars.size() - 1 - b);
        double from = 0;
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const auto bytes = bars[b].bytes.find(parts[p]);
            if (bytes == bars[b].bytes.end()) continue;
            const Look& look = looks[p % std::size(looks)];
            panel.boxes.push_back(
                {from, from + bytes->second, base + 0.08, base + 0.54, parts[p], look.colour,
                 results::decimal_bytes(static_cast<std::uint64_t>(bytes->second)), look.text_colour});
            from += bytes->second;
        }
        const FrameRow& of = *bars[b].first;
        std::vector<std::string> name;
        if (scenes) name.push_back(scene(of));
        if (machines) name.push_back(of.machine);
        name.insert(name.end(), {of.unit, of.run});
        if (orderings) name.push_back(joined(bars[b].orderings));
        panel.notes.push_back({0, base + 0.76, fitting(joined(name), 11, phase_width)});
        panel.notes.push_back(
            {across.high, base + 0.76, results::decimal_bytes(static_cast<std::uint64_t>(from)), true});
    }
    std::vector<std::string> same;
    if (!scenes) same.push_back(scene(row));
    if (!machines) same.push_back(row.machine);
    if (!orderings) same.push_back(joined(bars.front().orderings));
    same.push_back("unit of a turn, then how it ran");
    return draw({std::string(kind.title),
                 results::joined(same, " · "),
                 {"to and from memory", across},
                 {std::move(panel)}});
}

}  // namespace regather::charts
