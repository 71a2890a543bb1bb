// cli/version.h -- which regather this is, and what it was asked: for the provenance of results.
#pragma once
#include <string>

#include "cli/console.h"
#include "results/provenance.h"

namespace regather::cli {

std::string version();       ///< "0.1.0"
std::string git_revision();  ///< Of the sources at the last configure; "unknown" outside of a git checkout.
std::string version_text();  ///< "regather 0.1.0 (revision)"

/// Of results that this command makes; the checksum is the trace's, empty when none was read.
results::Provenance provenance(const Console& console, std::string trace_checksum);

}  // namespace regather::cli
