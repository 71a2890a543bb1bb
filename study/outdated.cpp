#include "study/outdated.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "capture/fingerprint.h"
#include "scenes/catalogue.h"
#include "scenes/loader.h"
#include "trace/error.h"

namespace regather::study {
namespace {

namespace fs = std::filesystem;

/// What this renderer makes of scenes, each asked for once.
class Fingerprints {
public:
    explicit Fingerprints(std::span<const fs::path> scene_files) : files_(scene_files) {}

    /// Nothing when the scene is not known.
    const std::optional<std::string>& of(const std::string& name) {
        const auto [place, is_new] = known_.try_emplace(name);
        if (is_new) place->second = make(name);
        return place->second;
    }

private:
    std::optional<std::string> make(const std::string& name) const {
        for (const scenes::EmbeddedScene& entry : scenes::catalogue())
            if (entry.name == name) return capture::fingerprint(scenes::load_scene(name));
        for (const fs::path& file : files_)
            if (const scenes::Scene scene = scenes::load_scene(file.string()); scene.name == name)
                return capture::fingerprint(scene);
        return {};
    }

    std::span<const fs::path> files_;
    std::map<std::string, std::optional<std::string>> known_;
};

Result result_of(const fs::path& csv, Fingerprints& fingerprints) {
    Result out;
    out.csv = csv;
    if (!fs::exists(results::provenance_path(csv))) {
        out.reason = fmt::format("no {} beside it", results::provenance_path(csv).filename().string());
        return out;
    }
    out.origin = results::read_origin(csv);
    if (!out.origin.is_rendered) {
        out.standing = Standing::unaffected;
        return out;
    }
    if (out.origin.fingerprint.empty()) {
        out.reason = "names no renderer";
        return out;
    }
    const auto& now = fingerprints.of(out.origin.scene);
    if (!now)
        out.reason = fmt::format("the scene {} is not embedded: --scene FILE", out.origin.scene);
    else
        out.standing = *now == out.origin.fingerprint ? Standing::current : Standing::outdated;
    return out;
}

}  // namespace

std::vector<Result> find_results(const fs::path& folder, std::span<const fs::path> scene_files) {
    if (!fs::is_directory(folder))
        throw trace::DataError(
            fmt::format("{}: found no such folder, expected one with results", folder.string()));
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == ".csv") files.push_back(entry.path());
    if (files.empty())
        throw trace::DataError(fmt::format("{}: found no CSV, expected at least one", folder.string()));
    std::sort(files.begin(), files.end());
    Fingerprints fingerprints(scene_files);
    std::vector<Result> out;
    for (const fs::path& file : files) out.push_back(result_of(file, fingerprints));
    return out;
}

results::Table result_table(std::span<const Result> all) {
    using results::Align;
    results::Table out({{"rows", Align::left},
                        {"scene", Align::left},
                        {"revision", Align::left},
                        {"capture", Align::left},
                        {"renderer", Align::left}});
    std::size_t outdated = 0, untold = 0;
    for (const Result& result : all) {
        outdated += result.standing == Standing::outdated;
        untold += result.standing == Standing::untold;
        out.add({result.csv.string(), result.origin.scene, result.origin.git_revision,
                 result.origin.trace_checksum,
                 result.standing == Standing::current      ? "as this one"
                 : result.standing == Standing::unaffected ? "none"
                 : result.standing == Standing::outdated   ? "OUTDATED"
                                                           : "not told: " + result.reason});
    }
    out.notes.push_back(fmt::format("{} of {} outdated, {} not told", outdated, all.size(), untold));
    return out;
}

}  // namespace regather::study
