#include "charts/ladder_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "results/geometry.h"

namespace regather::charts {
namespace {

struct LadderStyle {
    std::string_view name, colour;
    int marker;
};
// Okabe & Ito's colours, as of the orderings in series.cpp.
constexpr LadderStyle styles_table[] = {
    {"gather-rays", "#0072b2", 7},
    {"samples", "#56b4e9", 11},
    {"photons", "#d55e00", 5},
    {"k", "#009e73", 9},
    {"radius", "#882255", 13},
    {"caustic-photons", "#e69f00", 15},
    {"direct-photons", "#d55e00", 4},
    {"direct-k", "#009e73", 8},
    {"direct-both", "#cc79a7", 6},
    // Techniques, of scenes/experiments/techniques-ladder.csv.
    {"cosine", "#777777", 6},
    {"brdf", "#0072b2", 7},
    {"combined", "#009e73", 9},
    {"mis", "#44aa99", 8},
    {"lobes", "#117733", 13},
    {"bounded", "#aa4499", 11},
    {"hessian", "#882255", 15},
    {"precomputed", "#e69f00", 12},
};
constexpr std::string_view spare[] = {"#332288", "#44aa99", "#aa4499", "#661100", "#6699cc", "#117733"};

}  // namespace

bool is_direct(const results::Ladder& ladder) {
    return ladder.rows.front()->mode == "direct";
}

/// The name without "direct-": what is varied.
Line line_of(const results::Ladder& ladder, std::size_t place) {
    Line line;
    const std::string& name = ladder.rows.front()->ladder;
    const auto style = std::find_if(std::begin(styles_table), std::end(styles_table),
                                    [&](const LadderStyle& s) { return s.name == name; });
    line.colour = style != std::end(styles_table) ? style->colour : spare[place % std::size(spare)];
    line.marker = style != std::end(styles_table) ? style->marker : 10 + static_cast<int>(place % 6);
    line.label = ladder.label;
    return line;
}

std::string caption(std::span<const results::Ladder> all) {
    std::vector<std::string> scenes, seeds;
    const auto add = [](std::vector<std::string>& list, std::string text) {
        if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(std::move(text));
    };
    for (const results::Ladder& ladder : all)
        for (const results::ConvergenceRow* row : ladder.rows) {
            add(scenes, row->width && row->height
                            ? fmt::format("{}, {}×{} pixels", row->scene, *row->width, *row->height)
                            : row->scene);
            if (row->seeds) add(seeds, fmt::format("{} seeds", *row->seeds));
        }
    const std::string parts[] = {results::joined(scenes, " and "), results::joined(seeds, " and ")};
    return results::joined(parts, " · ");
}

}  // namespace regather::charts
