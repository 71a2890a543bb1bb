// cli/console.h -- where a command's words go. Commands print here and nowhere else, so that they can be
// called in process.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <vector>

#include "trace/text.h"

namespace regather::cli {

inline constexpr std::size_t most_shown_note = 1000;  ///< [bytes]

struct Console {
    std::FILE* out;                         ///< Data, and what was made.
    std::FILE* err;                         ///< Progress, and what is wrong.
    std::vector<std::string> command_line;  ///< As typed, the program's name first: for provenance.

    template <class... Words>
    void print(fmt::format_string<Words...> format, Words&&... words) const {
        fmt::print(out, format, std::forward<Words>(words)...);
    }

    /// What is not taken over, or was guessed: a line "note: LINE" each, on err.
    void note(const std::vector<std::string>& lines) const {
        for (const std::string& line : lines)
            fmt::print(err, "note: {}\n", trace::shown(line, most_shown_note));
    }
};

}  // namespace regather::cli
