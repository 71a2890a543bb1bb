// trace/error.h -- what goes wrong and whose fault it is. Libraries throw; only cli/main.cpp prints and
// exits.
#pragma once
#include <stdexcept>

namespace regather::trace {

/// Bad data: missing, damaged, unfinished or inconsistent input. what() is one line that names the file, the
/// field, what was found and what was expected. Exit code 3.
struct DataError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The user asked for what does not exist or makes no sense (unknown ordering, 0 ways). Exit code 2 from a
/// command line; a file that asks for it is bad data and is reported as DataError with the file's name. One
/// line.
struct UsageError : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

}  // namespace regather::trace
