// cli/progress.h -- one line on the console with what is done, the rate and the time left; nothing when that
// is no terminal.
#pragma once
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "cli/console.h"
#include "experiment/progress.h"

namespace regather::cli {

class Progress {
public:
    explicit Progress(const Console& console);
    ~Progress();   ///< clear()
    void clear();  ///< Takes the line away, until the next update.
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// From any thread. A change of `stage` starts the clock again; `unit` is what is counted ("pixels").
    void update(std::string_view stage, std::string_view unit, std::uint64_t done, std::uint64_t total);
    /// A line that stays, on stderr, whatever stderr is: "note: TEXT".
    void note(std::string_view text);
    /// note(), for as long as this lives.
    experiment::NoteListener note_listener() {
        return [this](std::string_view line) { note(line); };
    }
    /// update(), for as long as this lives.
    experiment::ProgressListener listener() {
        return [this](std::string_view stage, std::string_view unit, std::uint64_t done,
                      std::uint64_t total) { update(stage, unit, done, total); };
    }

private:
    using Clock = std::chrono::steady_clock;
    std::FILE* err_;
    bool terminal_;
    bool shown_ = false;
    std::mutex mutex_;
    std::string stage_;
    Clock::time_point start_, drawn_;
    std::uint64_t first_ = 0;
};

}  // namespace regather::cli
