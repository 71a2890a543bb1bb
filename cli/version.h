// cli/version.h -- which regather this is, and what it was asked: for the provenance of results.
#pragma once
#include <string>
#include <vector>

namespace regather::cli {

std::string version();       ///< "0.1.0"
std::string git_revision();  ///< Of the sources at the last configure; "unknown" outside of a git checkout.
std::string version_text();  ///< "regather 0.1.0 (revision)"

void set_command_line(int argc, char** argv);  ///< Once, by main.
const std::vector<std::string>& command_line();

}  // namespace regather::cli
