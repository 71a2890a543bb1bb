// experiment/progress.h -- how far a long piece of work is, told to whoever wants to know.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace regather::experiment {

/// Told what is being done ("replaying naive"), what is counted ("queries"), and how much of it is done of
/// how much. Empty: nobody listens. Called from any thread of ours. It may throw: the work then ends with
/// that exception.
using ProgressListener = std::function<void(std::string_view stage, std::string_view unit, std::uint64_t done,
                                            std::uint64_t total)>;

/// The listener to one stage, told only how much is done. `listener` outlives it.
inline std::function<void(std::uint64_t)> listening(const ProgressListener& listener, std::string stage,
                                                    std::string unit, std::uint64_t total) {
    return [&listener, stage = std::move(stage), unit = std::move(unit), total](std::uint64_t done) {
        if (listener) listener(stage, unit, done, total);
    };
}

}  // namespace regather::experiment
