#include "cli/version.h"

#include <fmt/format.h>

#include "revision.h"

namespace regather::cli {
namespace {

std::vector<std::string>& stored_command_line() {
    static std::vector<std::string> words;
    return words;
}

}  // namespace

std::string version() {
    return REGATHER_VERSION;
}
std::string git_revision() {
    return REGATHER_REVISION;
}
std::string version_text() {
    return fmt::format("regather {} ({})", version(), git_revision());
}

void set_command_line(int argc, char** argv) {
    stored_command_line().assign(argv, argv + argc);
}
const std::vector<std::string>& command_line() {
    return stored_command_line();
}

}  // namespace regather::cli
