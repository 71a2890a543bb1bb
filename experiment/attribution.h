// experiment/attribution.h -- what `regather detail` is asked, and the doing of it: one trace, orderings and
// caches in; rows by region and tree depth, rows by slice of the run, and a table out.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace regather::cli {

struct Attribution {
    std::filesystem::path trace, csv, timeline;  ///< An empty one is not written.
    std::vector<std::string> orders, caches{"128K:128:8"};
    std::string onchip = "1M";
    std::uint64_t slices = 200;  ///< At least 1.
    bool no_buffers = false, force = false;
};

/// Prints the table. Throws trace::UsageError before anything is computed when a file is in the way.
void attribute(const Attribution& asked);

}  // namespace regather::cli
