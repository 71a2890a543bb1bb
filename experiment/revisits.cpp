#include "experiment/revisits.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "trace/field.h"

namespace regather::experiment {

using trace::Field, trace::Json, trace::Kind;

namespace {

constexpr std::string_view count = "a whole number", counts = "a list of whole numbers";
const Kind line_kind{"line size",
                     {{"line_bytes", true, count},
                      {"accesses", true, count},
                      {"levels", true, "a list of levels"},
                      {"by_distance", true, counts}}};
const Kind level_kind{"level",
                      {{"sets", true, count}, {"misses", true, counts}, {"conflicts", true, counts}}};

std::uint64_t whole(const Field& field) {
    return field.whole<std::uint64_t>(0, std::numeric_limits<std::uint64_t>::max());
}
std::vector<std::uint64_t> wholes(const Field& field) {
    std::vector<std::uint64_t> all;
    for (const Field& one : field.elements(counts)) all.push_back(whole(one));
    return all;
}

}  // namespace

std::string text_of(const replay::Revisits& revisits) {
    Json::List lines;
    for (const auto& [line_bytes, found] : revisits) {
        Json::List levels;
        for (const cachesim::FamilyCounts::Level& level : found.levels)
            levels.push_back(Json::object(
                {{"sets", level.level.sets}, {"misses", level.misses}, {"conflicts", level.conflicts}}));
        lines.push_back(Json::object({{"line_bytes", line_bytes},
                                      {"accesses", found.accesses},
                                      {"levels", std::move(levels)},
                                      {"by_distance", found.by_distance}}));
    }
    return Json(std::move(lines)).dump(1) + '\n';
}

replay::Revisits revisits_in(std::string_view text, const std::filesystem::path& path) {
    const trace::Document document(text, path.string());
    replay::Revisits revisits;
    for (const Field& line :
         document.root().elements("the counts of revisits of an earlier run; delete the file")) {
        line.check(line_kind);
        const std::uint32_t line_bytes = line["line_bytes"].whole(1, 1u << 31);
        if (revisits.contains(line_bytes))
            line["line_bytes"].fail(fmt::format("{} a second time", line_bytes), "each once");
        cachesim::FamilyCounts& to = revisits[line_bytes];
        to.accesses = whole(line["accesses"]);
        to.by_distance = wholes(line["by_distance"]);
        for (const Field& level : line["levels"].elements()) {
            level.check(level_kind);
            cachesim::FamilyCounts::Level& counted = to.levels.emplace_back();
            counted.misses = wholes(level["misses"]);
            counted.conflicts = wholes(level["conflicts"]);
            counted.level = {whole(level["sets"]), static_cast<std::uint32_t>(counted.misses.size())};
        }
    }
    return revisits;
}

}  // namespace regather::experiment
