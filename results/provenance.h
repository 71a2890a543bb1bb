// results/provenance.h -- how a result came to be: X.json beside X.csv. Nothing of the machine or the clock,
// so that the same run writes the same bytes anywhere.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trace/json.h"

namespace regather::results {

struct Provenance {
    std::vector<std::string> command_line;  ///< As typed; of the program only the file name is kept.
    std::string version;                    ///< Of regather.
    std::string git_revision;
    std::string trace_checksum;  ///< Empty when no trace was read.
};

/// "runs/room.csv" -> "runs/room.json".
std::filesystem::path provenance_path(const std::filesystem::path& csv);

/// Throws trace::UsageError when `csv` or the JSON beside it exists, unless forced: somebody's X.json is not
/// ours to replace. And when `csv` bears the JSON's name, forced or not.
void refuse_to_overwrite(const std::filesystem::path& csv, bool force);

/// A file of rows that an option of the command line asks for.
struct Output {
    std::string_view option;    ///< "--csv"
    std::filesystem::path csv;  ///< Empty: not asked for.
};
/// The same for several, and when two would share the JSON beside them.
void refuse_to_overwrite(std::span<const Output> outputs, bool force);

/// What a file of results says of the renderer that it came from.
struct Origin {
    bool is_rendered = false;  ///< Something was rendered for it: a trace or images.
    std::string git_revision;
    std::string trace_checksum;  ///< Of the capture; empty when no trace was read.
    std::string scene,
        fingerprint;  ///< Of the renderer on that scene: capture/fingerprint.h; empty: not told.
};

/// Of the JSON beside `csv`. Throws trace::DataError where there is none or it is none of ours.
Origin read_origin(const std::filesystem::path& csv);

/// Writes the JSON beside `csv`; `trace_parameters` goes in as it is (null when no trace was read).
void write_provenance(const std::filesystem::path& csv, const Provenance& provenance,
                      const trace::Json& trace_parameters);
/// Of rows that are of no trace.
void write_provenance(const std::filesystem::path& csv, const Provenance& provenance);

}  // namespace regather::results
