// cli/fault.h -- signals that a file may cause, told in one line.
#pragma once

namespace regather::cli {

/// From here on a mapped file that somebody cuts short while it is read (SIGBUS) ends the process with one
/// line that names the file, and exit code 3; a file that reaches the user's limit of size (SIGXFSZ) is a
/// write that fails, like one on a full disk.
void tell_file_faults();

}  // namespace regather::cli
