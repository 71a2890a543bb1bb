// tests/cli/refused_experiment.h -- what the command says of an experiment that it does not take.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "tests/cli/expect.h"
#include "trace/error.h"

namespace regather::cli {

/// That `file` with this text is refused in one line with `place` and each of `parts` in it.
inline void expect_refused(const std::filesystem::path& file, const std::string& text,
                           const std::string& place, const std::vector<std::string>& parts) {
    write(file, text);
    try {
        experiment::load_experiment(file);
        ADD_FAILURE() << "accepted: " << text;
    } catch (const trace::DataError& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(testing::HasSubstr(place), testing::Not(testing::HasSubstr("\n"))));
        for (const std::string& part : parts) EXPECT_THAT(error.what(), testing::HasSubstr(part));
    }
}

}  // namespace regather::cli
