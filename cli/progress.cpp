#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace regather::cli {
namespace {

std::string rate_text(double rate) {
    if (rate >= 1e6) return fmt::format("{:.1f} M", rate / 1e6);
    if (rate >= 1e3) return fmt::format("{:.1f} k", rate / 1e3);
    return fmt::format("{:.1f} ", rate);
}

std::string time_text(double seconds) {
    const auto whole = static_cast<std::uint64_t>(seconds + 0.5);
    if (whole >= 3600) return fmt::format("{}h {:02}m", whole / 3600, whole / 60 % 60);
    return whole >= 60 ? fmt::format("{}m {:02}s", whole / 60, whole % 60) : fmt::format("{}s", whole);
}

}  // namespace

Progress::Progress(const Console& console)
    : err_(console.err), terminal_(::isatty(::fileno(console.err)) != 0) {}

Progress::~Progress() {
    clear();
}

void Progress::clear() {
    const std::lock_guard lock(mutex_);
    if (shown_) std::fputs("\r\x1b[K", err_);
    shown_ = false;
}

void Progress::note(std::string_view text) {
    const std::lock_guard lock(mutex_);
    fmt::print(err_, "{}note: {}\n", shown_ ? "\r\x1b[K" : "", trace::shown(text, most_shown_note));
    shown_ = false;
}

void Progress::update(std::string_view stage, std::string_view unit, std::uint64_t done,
                      std::uint64_t total) {
    if (!terminal_) return;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (stage != stage_) {
        stage_ = stage;
        start_ = now;
        first_ = done;
    } else if (now - drawn_ < std::chrono::milliseconds(100) && done < total) {
        return;
    }
    drawn_ = now;
    shown_ = true;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    std::string line =
        fmt::format("{}: {:.1f} %", stage,
                    total == 0 ? 100.0 : 100.0 * static_cast<double>(done) / static_cast<double>(total));
    if (seconds > 0.2 && done > first_) {
        const double rate = static_cast<double>(done - first_) / seconds;
        line += fmt::format(", {}{}/s, {} left", rate_text(rate), unit,
                            time_text(static_cast<double>(total - done) / rate));
    }
    fmt::print(err_, "\r\x1b[K{}", line);
    std::fflush(err_);
}

}  // namespace regather::cli
