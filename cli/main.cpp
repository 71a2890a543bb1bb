// cli/main.cpp -- the binary `regather`. What concerns the whole process stands here, all else in
// cli/command_line.h.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <unistd.h>

#include "cli/command_line.h"

namespace {

/// A mapped column that shrinks while it is read cannot be seen coming.
void on_bus_error(int) {
    constexpr std::string_view text =
        "regather: found a file that was cut short while it was read, expected it to stay as it was\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    std::_Exit(regather::cli::bad_data);
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGBUS, on_bus_error);
    std::signal(SIGXFSZ,
                SIG_IGN);  // a file larger than the shell's limit then is a write that fails, with its reason
    return regather::cli::run({stdout, stderr, {argv, argv + argc}});
}
