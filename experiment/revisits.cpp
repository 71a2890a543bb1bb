#include "experiment/revisits.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "trace/error.h"

namespace regather::experiment {

using nlohmann::json;

std::string text_of(const replay::Revisits& revisits) {
    json lines = json::array();
    for (const auto& [line_bytes, counts] : revisits) {
        json levels = json::array();
        for (const cachesim::FamilyCounts::Level& level : counts.levels)
            levels.push_back(
                {{"sets", level.level.sets}, {"misses", level.misses}, {"conflicts", level.conflicts}});
        lines.push_back({{"line_bytes", line_bytes},
                         {"accesses", counts.accesses},
                         {"levels", levels},
                         {"by_distance", counts.by_distance}});
    }
    return lines.dump(1) + '\n';
}

replay::Revisits revisits_in(std::string_view text, const std::filesystem::path& path) {
    try {
        replay::Revisits revisits;
        const json root = json::parse(text);
        for (const json& line : root.get_ref<const json::array_t&>()) {
            cachesim::FamilyCounts& counts = revisits[line.at("line_bytes").get<std::uint32_t>()];
            line.at("accesses").get_to(counts.accesses);
            line.at("by_distance").get_to(counts.by_distance);
            for (const json& level : line.at("levels")) {
                cachesim::FamilyCounts::Level& to = counts.levels.emplace_back();
                level.at("misses").get_to(to.misses);
                level.at("conflicts").get_to(to.conflicts);
                to.level = {level.at("sets").get<std::uint64_t>(),
                            static_cast<std::uint32_t>(to.misses.size())};
            }
        }
        return revisits;
    } catch (const json::exception& error) {
        throw trace::DataError(
            fmt::format("{}: found no counts of revisits ({}), expected those of an earlier run; delete it",
                        path.string(), error.what()));
    }
}

}  // namespace regather::experiment
