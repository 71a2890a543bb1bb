// results/provenance.h -- how a result came to be: X.json beside X.csv. Nothing of the machine or the clock,
// so that the same run writes the same bytes anywhere.
#pragma once
#include <filesystem>
#include <string>
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

/// Writes the JSON beside `csv`; `trace_parameters` goes in as it is (null when no trace was read).
void write_provenance(const std::filesystem::path& csv, const Provenance& provenance,
                      const trace::Json& trace_parameters);

}  // namespace regather::results
