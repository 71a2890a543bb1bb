// tests/cli/expect.h -- what every command must show, by its exit code; and one small capture to work with.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/cli/command.h"

namespace regather::cli {

/// Exit code 0 and silence on stderr.
inline Outcome expect_done(const std::vector<std::string>& words) {
    const Outcome outcome = regather(words);
    EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(words);
    EXPECT_EQ(outcome.err, "") << testing::PrintToString(words);
    return outcome;
}

/// This exit code, nothing on stdout, and on stderr one line "regather: ..." that holds each of `parts`.
inline void expect_refused(int exit_code, const std::vector<std::string>& words,
                           const std::vector<std::string>& parts) {
    const Outcome outcome = regather(words);
    EXPECT_EQ(outcome.exit_code, exit_code) << testing::PrintToString(words) << outcome.err;
    EXPECT_EQ(outcome.out, "") << testing::PrintToString(words);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, testing::AllOf(testing::StartsWith("regather: "), testing::EndsWith("\n")));
    for (const std::string& part : parts)
        EXPECT_THAT(outcome.err, testing::HasSubstr(part)) << testing::PrintToString(words);
}

/// The words of a capture of the scene `box` that takes a moment.
inline std::vector<std::string> small_capture(const std::filesystem::path& folder) {
    return {"capture",
            "box",
            "-o",
            folder.string(),
            "--width",
            "16",
            "--height",
            "16",
            "--photons",
            "2000",
            "--k",
            "20",
            "--gather-rays",
            "8",
            "--shadow-rays",
            "4"};
}

/// A finished small capture, made once a process. Copy what you damage.
inline const std::filesystem::path& captured_box() {
    static const Scratch scratch;
    static const std::filesystem::path folder = [] {
        const Outcome outcome = regather(small_capture(scratch / "box"));
        if (outcome.exit_code != 0) throw std::runtime_error(outcome.err);
        return scratch / "box";
    }();
    return folder;
}

/// Its trace.
inline std::string box_trace() {
    return (captured_box() / "trace").string();
}

/// A copy of its trace.
inline std::filesystem::path copied_trace(const Scratch& scratch, const std::string& name = "trace") {
    std::filesystem::copy(captured_box() / "trace", scratch / name, std::filesystem::copy_options::recursive);
    return scratch / name;
}

inline std::vector<std::string> operator+(std::vector<std::string> words,
                                          const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace regather::cli
