#include "cli/version.h"

#include <fmt/format.h>

#include "revision.h"

namespace regather::cli {

std::string version() {
    return REGATHER_VERSION;
}
std::string git_revision() {
    return REGATHER_REVISION;
}
std::string version_text() {
    return fmt::format("regather {} ({})", version(), git_revision());
}

results::Provenance provenance(const Console& console, std::string trace_checksum) {
    return {console.command_line, version(), git_revision(), std::move(trace_checksum)};
}

}  // namespace regather::cli
