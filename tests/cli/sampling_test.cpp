// `regather sampling`: sampled replays beside the exact one.
#include "results/csv.h"
#include "results/sampling_row.h"
#include "tests/cli/expect.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr, testing::StartsWith;

TEST(Sampling, RowsHoldWhatReplaysTell) {
    const Scratch scratch;
    const fs::path csv = scratch / "sampling.csv";
    const std::vector<std::string> caches{"--cache", "1K,2K:64:1"};
    const Outcome outcome =
        expect_done(std::vector<std::string>{"sampling", box_trace(), "--order", "naive", "hilbert",
                                             "--rates", "4,2", "--seeds", "3", "--csv", csv.string()} +
                    caches);
    EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("hilbert"), HasSubstr("1/4"), HasSubstr(csv.string())));
    EXPECT_THAT(
        content(csv),
        StartsWith("scene,ordering,parameters,cache_bytes,line_bytes,ways,set_sampling,seed,misses,"
                   "misses_stderr,misses_low,misses_high,exact_misses,covered,seconds,exact_seconds\n"));
    EXPECT_TRUE(fs::exists(scratch / "sampling.json"));

    const auto rows = results::read_csv<results::SamplingRow>(csv);
    ASSERT_EQ(rows.size(), 2 * 2 * 3 * 2u);
    std::size_t r = 0;
    for (const char* ordering : {"naive", "hilbert"}) {
        const auto replayed = [&](const std::vector<std::string>& words) {
            return results::from_csv(
                expect_done(std::vector<std::string>{"replay", box_trace(), "--order", ordering} + caches +
                            words)
                    .out,
                "stdout");
        };
        const auto exact = replayed({});
        for (const std::uint64_t rate : {4, 2})
            for (std::uint64_t seed = 1; seed <= 3; ++seed) {
                const auto sampled =
                    replayed({"--sample", std::to_string(rate), "--seed", std::to_string(seed)});
                for (std::size_t c = 0; c < 2; ++c, ++r) {
                    const results::SamplingRow& row = rows[r];
                    EXPECT_EQ(row.ordering, ordering);
                    EXPECT_EQ(row.cache_bytes, 1024u << c);
                    EXPECT_EQ(row.set_sampling, rate);
                    EXPECT_EQ(row.seed, seed);
                    EXPECT_EQ(row.misses, sampled[c].misses);
                    EXPECT_EQ(row.misses_stderr, sampled[c].misses_stderr);
                    EXPECT_EQ(row.misses_low, sampled[c].misses_low);
                    EXPECT_EQ(row.misses_high, sampled[c].misses_high);
                    EXPECT_EQ(row.exact_misses, exact[c].misses);
                    EXPECT_EQ(row.covered,
                              *row.misses_low <= *row.exact_misses && *row.exact_misses <= *row.misses_high);
                    EXPECT_TRUE(row.seconds && row.exact_seconds);
                }
            }
    }
}

TEST(Sampling, WithoutACsvRowsGoToStdout) {
    const std::string out = expect_done({"sampling", box_trace(), "--order", "naive", "--cache", "2K:64:1",
                                         "--rates", "8", "--seeds", "2"})
                                .out;
    EXPECT_EQ(results::from_csv<results::SamplingRow>(out, "stdout").size(), 2u);
}

TEST(Sampling, FilesAreOverwrittenOnlyByForce) {
    const Scratch scratch;
    const std::vector<std::string> words{"sampling", box_trace(), "--order", "naive",
                                         "--cache",  "2K:64:1",   "--rates", "2",
                                         "--seeds",  "1",         "--csv",   (scratch / "s.csv").string()};
    for (const std::string name : {"s.csv", "s.json"}) {
        write(scratch / name, "precious");
        expect_refused(bad_usage, words, {name, "--force"});
        EXPECT_EQ(contents(scratch.path()), (std::map<std::string, std::string>{{name, "precious"}}));
        fs::remove(scratch / name);
    }
    write(scratch / "s.csv", "precious");
    expect_done(words + std::vector<std::string>{"--force"});
    EXPECT_THAT(content(scratch / "s.csv"), StartsWith("scene,ordering,"));
    expect_refused(bad_usage, {"sampling", box_trace(), "--csv", (scratch / "t.json").string(), "--force"},
                   {"t.json", ".json"});
}

TEST(Sampling, WhatCannotBeSampledIsAUsageError) {
    expect_refused(bad_usage, {"sampling", box_trace(), "--cache", "2K:64:1", "--rates", "2,3"}, {"1/3"});
    expect_refused(bad_usage, {"sampling", box_trace(), "--cache", "2K:64:1", "--rates", "32"},
                   {"1/32", "at least 64 sets"});
    expect_refused(bad_usage, {"sampling", box_trace(), "--cache", "2K:64:full", "--rates", "2"}, {"all"});
    expect_refused(bad_usage, {"sampling", box_trace(), "--cache", "2K:64:1", "--seeds", "0"}, {"--seeds"});
    expect_refused(bad_usage, {"sampling", box_trace(), "--cache", "2K:64:1", "--order", "naif"}, {"naif"});
}

}  // namespace
}  // namespace regather::cli
