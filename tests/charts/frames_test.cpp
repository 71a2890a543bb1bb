// Rows of several frames: medians with bars along sweeps, and a curve along the camera path.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/charts/drawing.h"
#include "tests/results/rows.h"
#include "trace/error.h"

namespace regather::charts {
namespace {

using namespace results;

using testing::HasSubstr;
using testing::Not;

Row at_frame(std::string ordering, Count tile, std::uint64_t frame, std::uint64_t traffic) {
    Row row = made_row(std::move(ordering), tile, {}, traffic);
    row.frame = frame;
    return row;
}

std::vector<Row> walk() {
    return {at_frame("hilbert", 8, 10, 30'000'000), at_frame("hilbert", 8, 0, 10'000'000),
            at_frame("hilbert", 8, 5, 20'000'000),  at_frame("hilbert", 16, 0, 4'000'000),
            at_frame("hilbert", 16, 5, 9'000'000),  at_frame("naive", {}, 0, 50'000'000),
            at_frame("naive", {}, 5, 70'000'000)};
}

TEST(Frames, ASweepShowsTheMedianAndTheRange) {
    const std::vector<Row> rows = walk();
    const Chart chart = compose("traffic-by-tile", Rows(rows));
    ASSERT_EQ(chart.skipped, "");
    EXPECT_EQ(data_of(chart, "$line_0", "Hilbert"), "8 20\n16 6.5\n");
    EXPECT_THAT(chart.commands, HasSubstr("8 20 10 30\n16 6.5 4 9\n"));
    EXPECT_THAT(chart.commands, HasSubstr(" 60 50 70\n"));  // naive's level line
    EXPECT_THAT(chart.caption, HasSubstr("frames 0:15:5, median and range"));
}

TEST(Frames, OneFrameHasNoBars) {
    const std::vector<Row> rows = {at_frame("hilbert", 8, 3, 2'000'000),
                                   at_frame("hilbert", 16, 3, 1'000'000)};
    const Chart chart = compose("traffic-by-tile", Rows(rows));
    EXPECT_THAT(chart.commands, Not(HasSubstr("yerrorbars")));
    EXPECT_THAT(chart.caption, Not(HasSubstr("frames")));
}

TEST(Frames, TwoRowsOfOneFrameStillContradictEachOther) {
    std::vector<Row> rows = walk();
    rows.push_back(at_frame("hilbert", 8, 5, 21'000'000));
    EXPECT_THROW(compose("traffic-by-tile", Rows(rows)), trace::DataError);
}

TEST(Frames, UnevenFramesAreNamedOneByOne) {
    std::vector<Row> rows = walk();
    rows.push_back(at_frame("hilbert", 8, 11, 20'000'000));
    EXPECT_THAT(compose("traffic-by-tile", Rows(rows)).caption, HasSubstr("frames 0, 5, 10, 11, median"));
}

TEST(Frames, AChartAlongThePathHasACurveAnOrdering) {
    const std::vector<Row> rows = walk();
    ChartOptions options;
    options.tile = 8;
    const Chart chart = compose("traffic-by-frame", Rows(rows), options);
    ASSERT_EQ(chart.skipped, "");
    EXPECT_EQ(data_of(chart, "$line_0", "Hilbert, 8×8 tiles"), "0 10\n5 20\n10 30\n");
    EXPECT_EQ(data_of(chart, "$line_0", "Naive"), "0 50\n5 70\n");
}

TEST(Frames, AStandingCameraHasNoPath) {
    const std::vector<Row> rows = {made_row("naive", {}, {}, 5)};
    EXPECT_THAT(compose("traffic-by-frame", Rows(rows)).skipped,
                HasSubstr("needs at least 2 frames; found 0"));
}

}  // namespace
}  // namespace regather::charts
