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

}  // namespace
}  // namespace regather::results
