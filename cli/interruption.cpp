#include "cli/interruption.h"

#include <csignal>

namespace regather::cli {
namespace {

volatile std::sig_atomic_t received = 0;

}  // namespace

Interruption::Interruption() {
    received = 0;
    struct sigaction action {};
    action.sa_handler = [](int number) {
        received = number;
        std::signal(SIGINT, SIG_DFL);
        std::signal(SIGTERM, SIG_DFL);
    };
    sigaction(SIGINT, &action, &interrupt_);
    sigaction(SIGTERM, &action, &terminate_);
}

Interruption::~Interruption() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
}

int Interruption::signal() {
    return received;
}

experiment::ProgressListener Interruption::ending(experiment::ProgressListener listener) const {
    return [listener = std::move(listener)](std::string_view stage, std::string_view unit, std::uint64_t done,
                                            std::uint64_t total) {
        if (received != 0) throw Interrupted(received, "interrupted");
        if (listener) listener(stage, unit, done, total);
    };
}

}  // namespace regather::cli
