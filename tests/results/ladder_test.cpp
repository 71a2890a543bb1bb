#include "results/ladder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/results/settings.h"

namespace regather::results {
namespace {

using testing::HasSubstr;

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

TEST(Ladder, TablesTellErrorsInPercentOfTheMean) {
    auto rows = square_root();
    rows[2].below_reference = true;
    const std::string table = text_of(convergence_table(rows));
    EXPECT_THAT(table, HasSubstr("      10  "));  // 0.2 of 2
    EXPECT_THAT(table, HasSubstr("   <=2.5 "));
    for (std::size_t from = 0, to; (to = table.find('\n', from)) != table.npos; from = to + 1)
        EXPECT_LE(to - from, 100u);
    EXPECT_EQ(text_of(time_table(square_root())),
              "seconds to an RMSE of  slope  5 %\n"
              "photons                -0.50    4\n");
    EXPECT_TRUE(convergence_table({}).empty());
    EXPECT_TRUE(time_table({}).empty());
}

TEST(EqualErrors, AreVariancesOverThatOfCosine) {
    ConvergenceRow cosine;
    cosine.scene = "room";
    cosine.mode = "final-gather";
    cosine.gather_rays = 16;
    cosine.photon_seed = 1;
    cosine.sampling = "cosine";
    cosine.indirect_variance = 6;
    cosine.indirect_variance_stderr = 0.6;
    ConvergenceRow combined = cosine;
    combined.ladder = "another";
    combined.sampling = "combined:rows=4";
    combined.indirect_variance = 1.5;
    combined.indirect_variance_stderr = 0.3;
    ConvergenceRow more_rays = combined, own_photons = combined;
    more_rays.gather_rays = 64;
    own_photons.photon_seed = {};
    const std::vector<ConvergenceRow> rows{combined, cosine, more_rays, own_photons};
    const auto found = equal_errors(rows);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].row, &rows[0]);
    EXPECT_DOUBLE_EQ(found[0].rays, 4);
    // Relative errors 0.1 and 0.2: exp(1.96 sqrt(0.05)) = 1.5500.
    EXPECT_NEAR(found[0].interval->first, 4 / 1.55, 1e-3);
    EXPECT_NEAR(found[0].interval->second, 4 * 1.55, 1e-3);
    EXPECT_EQ(text_of(equal_error_table(rows)),
              "rays of cosine for the error of one   N  rays          95 %\n"
              "combined:rows=4                      16  4.00  2.58 to 6.20\n");
    EXPECT_TRUE(equal_error_table({}).empty());
}

}  // namespace
}  // namespace regather::results
