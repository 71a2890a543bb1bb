// cli/command_line.h -- a whole command line: from words to an exit code.
#pragma once
#include "cli/console.h"

namespace regather::cli {

enum Exit { done = 0, run_failed = 1, bad_usage = 2, bad_data = 3 };  ///< And 128 + N: ended by signal N.

/// Does what console.command_line asks for (the program's name first). Whatever is wrong is one line on
/// console.err. Nothing is left behind for the next call.
int run(const Console& console);

}  // namespace regather::cli
