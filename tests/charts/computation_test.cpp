// The tornado: bars by swing, an estimate a panel, one axis for all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/charts/drawing.h"
#include "tests/charts/svg_text.h"
#include "trace/error.h"

namespace regather::charts {
namespace {

using results::ComputationRow, results::Rows;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

ComputationRow estimate(std::string model, std::string parameter, double total, double divided,
                        double times) {
    ComputationRow row;
    row.model = std::move(model);
    row.parameter = std::move(parameter);
    row.value = 7;
    row.factor = 3;
    row.total_flop = total;
    row.divided_total_flop = divided;
    row.times_total_flop = times;
    return row;
}

TEST(ComputationChart, LongestBarsAreUppermostAndIdleParametersAreLeftOut) {
    std::vector<ComputationRow> rows{
        estimate("paper", "rays", 2e9, 1.9e9, 2.3e9), estimate("paper", "idle", 2e9, 2e9, 2e9),
        estimate("paper", "k", 2e9, 1.5e9, 3.5e9), estimate("mine", "k", 4e6, 3e6, 7e6)};
    rows[0].what = "rays an eye ray";
    rows[3].scene = "room";
    const Chart chart = compose("computation", Rows(rows));
    ASSERT_EQ(chart.skipped, "");
    // left, right, bottom, top: k above rays, though it stands behind them.
    EXPECT_EQ(data_of(chart, "$box_0", "divided by 3"), "-25 0 1.14 1.86\n");
    EXPECT_EQ(data_of(chart, "$box_1", "times 3"), "0 75 0.14 0.86\n");
    EXPECT_THAT(chart.commands, HasSubstr("$box_0_2 << EOD\n-5 0 0.14 0.86\n"));
    EXPECT_THAT(chart.commands, HasSubstr("$box_0_3 << EOD\n0 15 0.14 0.86\n"));
    EXPECT_THAT(chart.commands, Not(HasSubstr("idle")));
    for (const char* text :
         {"'rays an eye ray: 7' 0.5", "'k: 7' 1.5", "'paper: 2 GFLOP'", "'room, mine: 4 MFLOP'", "'+75.0 %'",
          "'+15.0 %' at 16.8,0.5 left", "set xrange [-40:80]"})
        EXPECT_THAT(chart.commands, HasSubstr(text));
    EXPECT_THAT(collisions(render(chart, Picture::svg)), IsEmpty());
}

TEST(ComputationChart, TwoRowsOfOneParameterContradictEachOther) {
    const std::vector<ComputationRow> rows{estimate("paper", "k", 2e9, 1e9, 4e9),
                                           estimate("paper", "k", 2e9, 1e9, 5e9)};
    EXPECT_THROW(compose("computation", Rows(rows)), trace::DataError);
}

TEST(ComputationChart, ATotalThatFallsByAProductIsRefused) {
    const std::vector<ComputationRow> rows{estimate("paper", "k", 2e9, 1e9, 1.5e9)};
    EXPECT_THROW(compose("computation", Rows(rows)), trace::DataError);
}

TEST(ComputationChart, RowsThatChangeNothingAreNoPicture) {
    const std::vector<ComputationRow> rows{estimate("paper", "k", 2e9, 2e9, 2e9),
                                           estimate("paper", "rays", 0, 0, 0)};
    EXPECT_EQ(compose("computation", Rows(rows)).skipped, "needs rows of the computation by parameter");
}

}  // namespace
}  // namespace regather::charts
