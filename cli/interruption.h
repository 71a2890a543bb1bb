// cli/interruption.h -- SIGINT and SIGTERM end a run where it can be taken up again; a second one kills.
#pragma once
#include <signal.h>

#include <stdexcept>
#include <string>

#include "experiment/progress.h"

namespace regather::cli {

/// The run ended by a signal. what() is one line: what is there, and how to go on.
struct Interrupted : std::runtime_error {
    Interrupted(int number, const std::string& text) : std::runtime_error(text), signal(number) {}
    int signal;
};

/// As long as it lives, the first SIGINT or SIGTERM is kept, and the second has its usual effect. One at a
/// time.
class Interruption {
public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// The signal that came; 0: none.
    static int signal();
    /// `listener`, which from the signal on throws Interrupted: whoever tells it of progress is ended.
    experiment::ProgressListener ending(experiment::ProgressListener listener) const;

private:
    struct sigaction interrupt_ {};
    struct sigaction terminate_ {};
};

}  // namespace regather::cli
