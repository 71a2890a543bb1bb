#include "trace/median.h"

#include <gtest/gtest.h>

namespace regather::trace {
namespace {

TEST(Median, OfAnOddNumberIsTheMiddleOne) {
    EXPECT_EQ(median({9, -3, 4, 100, 5}), 5);
    EXPECT_EQ(upper_median({9, -3, 4, 100, 5}), 5);
    EXPECT_EQ(median({7}), 7);
    EXPECT_EQ(upper_median({7}), 7);
}

TEST(Median, OfAnEvenNumberIsBetweenTheMiddleTwoAndTheUpperOneIsTheLarger) {
    EXPECT_EQ(median({9, -3, 4, 100}), 6.5);
    EXPECT_EQ(upper_median({9, -3, 4, 100}), 9);
    EXPECT_EQ(upper_median({2, 1}), 2);
}

}  // namespace
}  // namespace regather::trace
