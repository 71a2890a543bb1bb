#include "results/accuracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <vector>

namespace regather::results {
namespace {

SamplingRow run(std::string parameters, std::uint64_t rate, std::uint64_t misses, std::uint64_t exact,
                double seconds, Flag covered) {
    SamplingRow row;
    row.scene = "room";
    row.ordering = parameters.substr(0, parameters.find(':'));
    row.parameters = std::move(parameters);
    row.cache_bytes = 4096;
    row.line_bytes = 64;
    row.ways = 8;
    row.set_sampling = rate;
    row.misses = misses;
    row.exact_misses = exact;
    row.seconds = seconds;
    row.exact_seconds = 12;
    row.covered = covered;
    return row;
}

TEST(Accuracy, IsTheRootMeanSquareOverRunsAsWorkedOutByHand) {
    // 3 % over, 4 % under: root of (9 + 16) / 2 = 3.5355 %.
    const std::vector<SamplingRow> rows = {run("naive", 4, 103, 100, 2, true),
                                           run("naive", 2, 1000, 1000, 6, true),
                                           run("naive", 4, 192, 200, 4, false),
                                           run("naive", 4, 50, 0, 9, true),  // no misses to be compared with
                                           run("hilbert", 4, 90, 100, 1, {})};
    const auto all = accuracies(rows);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].set_sampling, 2u);
    EXPECT_EQ(all[0].rms_error, 0);
    EXPECT_EQ(all[0].speed_up, 2);
    EXPECT_EQ(all[1].set_sampling, 4u);
    EXPECT_EQ(all[1].runs, 2u);
    EXPECT_NEAR(all[1].rms_error, 0.0353553, 1e-7);
    EXPECT_NEAR(all[1].worst_error, 0.04, 1e-12);
    EXPECT_EQ(all[1].seconds, 3);
    EXPECT_EQ(all[1].speed_up, 4);
    EXPECT_EQ(all[1].intervals, 2u);
    EXPECT_EQ(all[1].covered, 1u);
    EXPECT_EQ(all[2].first->ordering, "hilbert");
    EXPECT_NEAR(all[2].rms_error, 0.1, 1e-12);
    EXPECT_EQ(all[2].intervals, 0u);
}

TEST(Accuracy, AnIntervalCoversItsEnds) {
    std::vector<SamplingRow> rows(4, run("naive", 2, 100, 100, 1, {}));
    const std::uint64_t ends[][2] = {{100, 110}, {90, 100}, {101, 110}, {90, 99}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].misses_low = ends[i][0];
        rows[i].misses_high = ends[i][1];
    }
    EXPECT_EQ(accuracies(rows)[0].intervals, 4u);
    EXPECT_EQ(accuracies(rows)[0].covered, 2u);
}

TEST(Accuracy, TheMedianOfThreeRunsIsTheMiddleOne) {
    const std::vector<SamplingRow> rows = {run("naive", 2, 1, 1, 100, {}), run("naive", 2, 1, 1, 3, {}),
                                           run("naive", 2, 1, 1, 2, {})};
    EXPECT_EQ(accuracies(rows)[0].seconds, 3);
    EXPECT_EQ(accuracies(rows)[0].speed_up, 4);
}

TEST(Accuracy, TheTableReadsAsDrawnByHand) {
    const std::vector<SamplingRow> rows = {run("naive", 4, 103, 100, 2, true),
                                           run("naive", 4, 192, 200, 4, false),
                                           run("hilbert:tile=16", 16, 90, 100, 0.5, {})};
    EXPECT_EQ(text_of(accuracy_table(rows)),
              "ordering         rate  runs  RMS error  worst error  speed-up  truth in 95 % CI\n"
              "naive             1/4     2     3.54 %       4.00 %      4.0x            50.0 %\n"
              "hilbert:tile=16  1/16     1     10.0 %       10.0 %     24.0x\n");
    EXPECT_TRUE(accuracy_table({}).empty());
    std::istringstream lines(text_of(accuracy_table({{run(std::string(90, 'x'), 65536, 9, 1, 0.01, true)}})));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

}  // namespace
}  // namespace regather::results
