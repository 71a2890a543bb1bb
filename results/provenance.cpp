#include "results/provenance.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "trace/error.h"
#include "trace/file.h"

namespace regather::results {

std::filesystem::path provenance_path(const std::filesystem::path& csv) {
    std::filesystem::path json = csv;
    return json.replace_extension(".json");
}

void refuse_to_overwrite(const std::filesystem::path& csv, bool force) {
    const std::filesystem::path json = provenance_path(csv);
    if (json == csv)
        throw trace::UsageError(
            fmt::format("--csv: found {}, expected another ending than .json, which the provenance "
                        "beside it bears",
                        csv.string()));
    if (force) return;
    for (const std::filesystem::path& file : {csv, json})
        if (std::filesystem::exists(file))
            throw trace::UsageError(fmt::format("{}: exists; --force overwrites it", file.string()));
}

void write_provenance(const std::filesystem::path& csv, const Provenance& provenance,
                      const nlohmann::json& trace_parameters) {
    std::vector<std::string> words = provenance.command_line;
    if (!words.empty()) words.front() = std::filesystem::path(words.front()).filename().string();
    nlohmann::ordered_json out;
    out["results"] = csv.filename().string();
    out["command_line"] = words;
    out["regather_version"] = provenance.version;
    out["git_revision"] = provenance.git_revision;
    out["trace_checksum"] = provenance.trace_checksum;
    out["trace_parameters"] = trace_parameters;
    // A command line may hold bytes that are no UTF-8: replaced, not thrown at the end of a long run.
    trace::write_whole(provenance_path(csv),
                       out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace regather::results
