// study/outdated.h -- which results a change of the renderer has outdated: the fingerprint that each names is
// made again.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "results/provenance.h"
#include "results/table.h"

namespace regather::study {

enum class Standing {
    current,     ///< This renderer gives the fingerprint that stands there.
    outdated,    ///< It gives another one.
    unaffected,  ///< Nothing was rendered for it.
    untold,      ///< Nothing stands there, or the scene is not known.
};

struct Result {
    std::filesystem::path csv;
    results::Origin origin;
    Standing standing = Standing::untold;
    std::string reason;  ///< Why it is untold.
};

/// Every CSV in `folder` and below, by path. Scenes are found among the embedded ones, else among
/// `scene_files` by their name. Throws trace::DataError for a provenance that cannot be read, or a folder
/// without a CSV.
std::vector<Result> find_results(const std::filesystem::path& folder,
                                 std::span<const std::filesystem::path> scene_files);

/// A line a file; below, how many are outdated and how many untold.
results::Table result_table(std::span<const Result> all);

}  // namespace regather::study
