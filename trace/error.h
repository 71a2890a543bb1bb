// trace/error.h -- what goes wrong and whose fault it is. Libraries throw; only cli/main.cpp prints and
// exits.
#pragma once
#include <stdexcept>
#include <string_view>

#include "trace/text.h"

namespace regather::trace {

/// Bad data: missing, damaged, unfinished or inconsistent input. what() is one line that names the file, the
/// field, what was found and what was expected, whatever bytes came from the file (shown()). Exit code 3.
struct DataError : std::runtime_error {
    explicit DataError(std::string_view message)
        : std::runtime_error(shown(message, std::string_view::npos)) {}
};

/// The user asked for what does not exist or makes no sense (unknown ordering, 0 ways). Exit code 2 from a
/// command line; a file that asks for it is bad data and is reported as DataError with the file's name. One
/// line, as that of DataError.
struct UsageError : std::invalid_argument {
    explicit UsageError(std::string_view message)
        : std::invalid_argument(shown(message, std::string_view::npos)) {}
};

}  // namespace regather::trace
