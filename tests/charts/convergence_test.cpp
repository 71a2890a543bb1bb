// Error against run time from rows made by hand.
#include "charts/convergence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/charts/drawing.h"

namespace regather::charts {
namespace {

using namespace results;

using testing::HasSubstr;
using testing::Not;

ConvergenceRow made(std::string ladder, std::string mode, std::uint64_t photons, std::uint64_t k,
                    double seconds, double rmse) {
    ConvergenceRow row;
    row.scene = "box";
    row.reference = "r";
    row.ladder = std::move(ladder);
    row.mode = std::move(mode);
    row.photons = photons;
    row.k = k;
    row.width = row.height = 8;
    row.seeds = 4;
    row.total_seconds = seconds;
    row.render_seconds = seconds / 2;
    row.rmse = rmse;
    row.mean_radiance = row.interior_mean_radiance = 2;
    row.reference_rmse = 0.01;
    row.variance = row.interior_variance = rmse * rmse;
    row.efficiency = 1 / (rmse * rmse * seconds);
    return row;
}

std::vector<ConvergenceRow> square_root() {
    return {made("photons", "final-gather", 100, 10, 4, 0.1), made("photons", "final-gather", 10, 10, 1, 0.2),
            made("photons", "final-gather", 1000, 10, 16, 0.05)};
}

TEST(Slope, IsThatOfThePowerLaw) {
    const double x[] = {1, 4, 16}, y[] = {8, 4, 2};
    EXPECT_NEAR(*fitted_slope(x, y), -0.5, 1e-12);
    EXPECT_FALSE(fitted_slope(std::span(x, 2), std::span(y, 2)));
    const double same[] = {3, 3, 3};
    EXPECT_FALSE(fitted_slope(same, y));
}

TEST(SecondsTo, LiesOnTheLineBetweenSettings) {
    const auto rows = square_root();
    const Ladder ladder = ladders(rows).at(0);
    EXPECT_NEAR(*seconds_to(ladder, 0.1 * std::sqrt(2.0)), 2, 1e-9);
    EXPECT_NEAR(*seconds_to(ladder, 0.05), 16, 1e-9);
    EXPECT_EQ(*seconds_to(ladder, 0.3), -1);
    EXPECT_FALSE(seconds_to(ladder, 0.04));
}

TEST(SecondsTo, WhatLiesBelowTheReferenceIsNotClaimed) {
    auto rows = square_root();
    rows[2].below_reference = true;
    const Ladder ladder = ladders(rows).at(0);
    EXPECT_TRUE(seconds_to(ladder, 0.1));
    EXPECT_FALSE(seconds_to(ladder, 0.07));
}

TEST(Convergence, TablesTellErrorsInPercentOfTheMean) {
    auto rows = square_root();
    rows[2].below_reference = true;
    const std::string table = convergence_table(rows);
    EXPECT_THAT(table, HasSubstr("      10 "));  // 0.2 of 2
    EXPECT_THAT(table, HasSubstr("   <=2.5 "));
    for (std::size_t from = 0, to; (to = table.find('\n', from)) != table.npos; from = to + 1)
        EXPECT_LE(to - from, 100u);
    EXPECT_EQ(time_table(square_root()),
              "seconds to an RMSE of           slope      5 %\n"
              "photons                         -0.50        4\n");
    EXPECT_EQ(convergence_table({}), "");
}

TEST(Convergence, ErrorByTimeHasSlopesAndTheReferencesError) {
    const auto rows = square_root();
    const Chart chart = compose("error-by-time", {{}, {}, {}, {}, rows});
    EXPECT_EQ(data_of(chart, "$line_0", "photons, slope −0.50"), "1 10\n4 5\n16 2.5\n");
    EXPECT_THAT(data_of(chart, "$line_0", "error of the reference"), HasSubstr(" 0.5\n"));
    EXPECT_EQ(chart.caption, "box, 8×8 pixels · 4 seeds");
    const Chart render = compose("error-by-render-time", {{}, {}, {}, {}, rows});
    EXPECT_EQ(data_of(render, "$line_0", "photons, slope −0.50"), "0.5 10\n2 5\n8 2.5\n");
    const Chart effort = compose("efficiency", {{}, {}, {}, {}, rows});
    EXPECT_EQ(data_of(effort, "$line_0", "photons"), "1 100\n4 100\n16 100\n");
}

TEST(Convergence, BiasIsDrawnWithItsBarAndTheExpectedLine) {
    std::vector<ConvergenceRow> rows = {made("direct-photons", "direct", 100, 10, 1, 0.2),
                                        made("direct-photons", "direct", 400, 10, 2, 0.2),
                                        made("direct-photons", "direct", 1600, 10, 4, 0.2)};
    for (std::size_t i = 0; i < 3; ++i) {
        const double bias = 0.4 / std::pow(4.0, static_cast<double>(i));
        rows[i].interior_bias_squared = bias * bias;
        rows[i].interior_bias_squared_stderr = 0.0004;
    }
    rows[2].interior_bias_squared = -0.0001;  // noise
    const Chart chart = compose("bias-by-photons", {{}, {}, {}, {}, rows});
    ASSERT_EQ(chart.skipped, "");
    EXPECT_EQ(data_of(chart, "$line_0", "direct-photons"), "100 20\n400 5\n");
    EXPECT_THAT(chart.commands, HasSubstr("400 5 4.8989"));
    EXPECT_THAT(chart.commands, HasSubstr("1 point not told apart from 0"));
    EXPECT_THAT(data_of(chart, "$line_0", "as theory expects, from the first point"),
                HasSubstr("100 20\n400 5\n"));
    EXPECT_THAT(compose("bias-by-k", {{}, {}, {}, {}, rows}).skipped, HasSubstr("with the photons held"));
}

TEST(Convergence, RowsSurviveTheirCsv) {
    auto rows = square_root();
    rows[0].bias_squared = -0.25;
    rows[0].below_reference = false;
    rows[1].radius = 0.125;
    const std::string text = to_csv<ConvergenceRow>(rows);
    EXPECT_EQ(row_kind(text, "x.csv"), RowKind::convergence);
    const auto back = from_csv<ConvergenceRow>(text, "x.csv");
    EXPECT_EQ(to_csv<ConvergenceRow>(back), text);
    EXPECT_EQ(back[0].bias_squared, -0.25);
}

}  // namespace
}  // namespace regather::charts
