#include "results/provenance.h"

#include <fmt/format.h>

#include <array>
#include <map>

#include "trace/error.h"
#include "trace/field.h"
#include "trace/file.h"

namespace regather::results {

std::filesystem::path provenance_path(const std::filesystem::path& csv) {
    std::filesystem::path json = csv;
    return json.replace_extension(".json");
}

void refuse_to_overwrite(const std::filesystem::path& csv, bool force) {
    refuse_to_overwrite(std::array{Output{"--csv", csv}}, force);
}

void refuse_to_overwrite(std::span<const Output> outputs, bool force) {
    std::vector<std::filesystem::path> files;
    std::map<std::filesystem::path, std::string_view> asked_by;  // of the JSON files
    for (const auto& [option, csv] : outputs) {
        if (csv.empty()) continue;
        const std::filesystem::path json = provenance_path(csv);
        if (json == csv)
            throw trace::UsageError(fmt::format(
                "{}: found {}, expected another ending than .json, which the provenance beside it bears",
                option, csv.string()));
        if (const auto [other, first] = asked_by.try_emplace(json, option); !first)
            throw trace::UsageError(
                fmt::format("{}: found {}, expected another name than that of {}, for the provenance "
                            "beside it",
                            option, csv.string(), other->second));
        files.push_back(csv);
        files.push_back(json);
    }
    trace::refuse_to_overwrite(files, force);
}

void write_provenance(const std::filesystem::path& csv, const Provenance& provenance,
                      const trace::Json& trace_parameters) {
    std::vector<std::string> words = provenance.command_line;
    if (!words.empty()) words.front() = std::filesystem::path(words.front()).filename().string();
    const trace::Json out = trace::Json::object({{"results", csv.filename().string()},
                                                 {"command_line", words},
                                                 {"regather_version", provenance.version},
                                                 {"git_revision", provenance.git_revision},
                                                 {"trace_checksum", provenance.trace_checksum},
                                                 {"trace_parameters", trace_parameters}});
    // A command line may hold bytes that are no UTF-8: replaced, not thrown at the end of a long run.
    trace::write_whole(provenance_path(csv), out.dump(2) + "\n");
}

Origin read_origin(const std::filesystem::path& csv) {
    const std::filesystem::path json = provenance_path(csv);
    const trace::Document document(trace::read_file(json), json.string());
    const trace::Field root = document.root();
    const trace::Field parameters = root["trace_parameters"];
    Origin origin{
        !parameters.value().is_null(), root["git_revision"].text(), root["trace_checksum"].text(), {}, {}};
    if (!parameters.value().is_object() || !parameters.has("renderer")) return origin;
    const trace::Field renderer = parameters["renderer"];
    origin.scene = renderer["scene"].text();
    origin.fingerprint = renderer["fingerprint"].text();
    return origin;
}

void write_provenance(const std::filesystem::path& csv, const Provenance& provenance) {
    write_provenance(csv, provenance, {});
}

}  // namespace regather::results
