// experiment/progress.h -- how far a long piece of work is, told to whoever wants to know.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace regather::experiment {

/// Told what is being done ("replaying naive"), what is counted ("queries"), and how much of it is done of
/// how much. Empty: nobody listens. Called from any thread of ours. It may throw: the work then ends with
/// that exception.
using ProgressListener = std::function<void(std::string_view stage, std::string_view unit, std::uint64_t done,
                                            std::uint64_t total)>;

/// Told what a scene's mesh files hold that is not taken over (scenes/scene.h), a line at a time, before the
/// work begins. Empty: nobody listens.
using NoteListener = std::function<void(std::string_view line)>;

inline void tell(const NoteListener& listener, const std::vector<std::string>& lines) {
    if (listener)
        for (const std::string& line : lines) listener(line);
}

/// The listener to one stage, told only how much is done. `listener` outlives it.
inline std::function<void(std::uint64_t)> listening(const ProgressListener& listener, std::string stage,
                                                    std::string unit, std::uint64_t total) {
    return [&listener, stage = std::move(stage), unit = std::move(unit), total](std::uint64_t done) {
        if (listener) listener(stage, unit, done, total);
    };
}

}  // namespace regather::experiment
