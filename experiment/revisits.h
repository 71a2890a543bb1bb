// experiment/revisits.h -- what no order changes (replay::Revisits), kept in a file between runs.
#pragma once
#include <filesystem>
#include <optional>

#include "replay/replay.h"

namespace regather::experiment {

/// Whole or not at all.
void write_revisits(const std::filesystem::path& path, const replay::Revisits& revisits);
/// Throws trace::DataError when the file is not what write_revisits() writes.
replay::Revisits read_revisits(const std::filesystem::path& path);

}  // namespace regather::experiment
