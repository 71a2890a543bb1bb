#include "study/computation/sampling_operations.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace regather::study {
namespace {

constexpr std::pair<std::string_view, double capture::Operations::*> kinds[] = {
    {"multiply", &capture::Operations::multiply}, {"add", &capture::Operations::add},
    {"divide", &capture::Operations::divide},     {"function", &capture::Operations::function},
    {"compare", &capture::Operations::compare},   {"read", &capture::Operations::read},
    {"random", &capture::Operations::random},
};

std::vector<std::string> line(const std::string& spec, const char* surface,
                              const capture::SamplingCost& cost) {
    std::vector<std::string> cells{spec, surface, fmt::format("{}", cost.bytes),
                                   fmt::format("{}", cost.searches), fmt::format("{}", cost.rays)};
    for (const capture::Operations* const of : {&cost.table, &cost.sample}) {
        for (const auto& [name, kind] : kinds) cells.push_back(fmt::format("{:.0f}", of->*kind));
        cells.push_back(fmt::format("{:.0f}", of->flop()));
    }
    return cells;
}

}  // namespace

results::Table sampling_operations(std::string_view spec) {
    using results::Align;
    std::vector<results::Table::Head> heads{
        {"strategy", Align::left}, {"surface", Align::left}, {"bytes"}, {"searches"}, {"rays"}};
    for (const char* const of : {"table", "sample"}) {
        for (const auto& [name, kind] : kinds) heads.push_back({fmt::format("{}: {}", of, name)});
        heads.push_back({fmt::format("{}: FLOP", of)});
    }
    results::Table table(std::move(heads));
    table.title = "importance sampling: operations a shaded point (table) and a gather ray (sample)";
    std::vector<std::string> specs;
    if (spec == "all")
        for (const capture::SamplingStrategy& strategy : capture::sampling_strategies())
            specs.emplace_back(strategy.name);
    else
        specs.emplace_back(spec);
    for (const std::string& one : specs) {
        const capture::SamplingSpec parsed = capture::parse_sampling(one);
        std::vector<std::string> diffuse = line(one, "diffuse", parsed.cost(false)),
                                 glossy = line(one, "glossy", parsed.cost(true));
        glossy[1] = diffuse[1];
        const bool same = glossy == diffuse;
        glossy[1] = "glossy";
        if (same) diffuse[1] = "any";
        table.add(std::move(diffuse));
        if (!same) table.add(std::move(glossy));
    }
    return table;
}

}  // namespace regather::study
