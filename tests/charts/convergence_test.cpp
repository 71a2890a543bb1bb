// Error against run time from rows made by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/charts/drawing.h"
#include "tests/results/settings.h"

namespace regather::charts {
namespace {

using namespace results;

using testing::HasSubstr;
using testing::Not;

TEST(Convergence, ErrorByTimeHasSlopesAndTheReferencesError) {
    const auto rows = square_root();
    const Chart chart = compose("error-by-time", Rows(rows));
    EXPECT_EQ(data_of(chart, "$line_0", "photons, slope −0.50"), "1 10\n4 5\n16 2.5\n");
    EXPECT_THAT(data_of(chart, "$line_0", "error of the reference"), HasSubstr(" 0.5\n"));
    EXPECT_EQ(chart.caption, "box, 8×8 pixels · 4 seeds");
    const Chart render = compose("error-by-render-time", Rows(rows));
    EXPECT_EQ(data_of(render, "$line_0", "photons, slope −0.50"), "0.5 10\n2 5\n8 2.5\n");
    const Chart effort = compose("efficiency", Rows(rows));
    EXPECT_EQ(data_of(effort, "$line_0", "photons"), "1 100\n4 100\n16 100\n");
}

TEST(Convergence, TimeToErrorHasALineAPictureAndError) {
    // Of a mean of 2 the box reaches 10 % (0.2) in at most 1 s and 5 % in 4 s; the den has 5, 2 and 1 %.
    std::vector<ConvergenceRow> rows = square_root();
    rows.pop_back();
    for (const auto& [seconds, rmse] : {std::pair{8.0, 0.08}, std::pair{32.0, 0.02}}) {
        rows.push_back(made_setting("samples", "final-gather", 10, 10, seconds, rmse));
        rows.back().scene = "den";
    }
    const Chart chart = compose("time-to-error", Rows(rows));
    ASSERT_EQ(chart.skipped, "");
    const std::string photons = data_of(chart, "$line_0", "photons"),
                      samples = data_of(chart, "$line_0", "samples");
    EXPECT_THAT(photons, HasSubstr("1 5.26\n"));  // 20 %: at most
    EXPECT_THAT(photons, HasSubstr("4 3.26\n"));
    EXPECT_THAT(samples, HasSubstr("8 2.26\n"));   // 5 %: at most
    EXPECT_THAT(samples, HasSubstr("16 1.26\n"));  // half-way to 0.02, in logarithms
    EXPECT_THAT(samples, HasSubstr("32 0.26\n"));
    for (const char* text : {"'box, 20 %'", "'box, 10 %'", "'box, 5 %'", "'den, 1 %'"})
        EXPECT_THAT(chart.commands, HasSubstr(text));
    EXPECT_THAT(chart.commands, Not(HasSubstr("'box, 50 %'")));
    rows.resize(1);
    rows[0].rmse = 1.5;
    EXPECT_EQ(compose("time-to-error", Rows(rows)).skipped,
              "needs settings of a ladder that reach half of the mean radiance");
}

TEST(Convergence, BiasIsDrawnWithItsBarAndTheExpectedLine) {
    std::vector<ConvergenceRow> rows = {made_setting("direct-photons", "direct", 100, 10, 1, 0.2),
                                        made_setting("direct-photons", "direct", 400, 10, 2, 0.2),
                                        made_setting("direct-photons", "direct", 1600, 10, 4, 0.2)};
    for (std::size_t i = 0; i < 3; ++i) {
        const double bias = 0.4 / std::pow(4.0, static_cast<double>(i));
        rows[i].interior_bias_squared = bias * bias;
        rows[i].interior_bias_squared_stderr = 0.0004;
    }
    rows[2].interior_bias_squared = -0.0001;  // noise
    const Chart chart = compose("bias-by-photons", Rows(rows));
    ASSERT_EQ(chart.skipped, "");
    EXPECT_EQ(data_of(chart, "$line_0", "direct-photons"), "100 20\n400 5\n");
    EXPECT_THAT(chart.commands, HasSubstr("400 5 4.8989"));
    EXPECT_THAT(chart.commands, HasSubstr("1 point not told apart from 0"));
    EXPECT_THAT(data_of(chart, "$line_0", "as theory expects, from the first point"),
                HasSubstr("100 20\n400 5\n"));
    EXPECT_THAT(compose("bias-by-k", Rows(rows)).skipped, HasSubstr("with the photons held"));
}

}  // namespace
}  // namespace regather::charts
