#include "capture/reference/moments.h"

#include <gtest/gtest.h>

namespace regather::capture {
namespace {

/// 1, 2, 3, 4: mean 2.5, variance 5/3, of the mean 5/12.
TEST(Moments, AreThoseOfAHandfulOfNumbers) {
    Moments moments;
    for (int i = 1; i <= 4; ++i)
        moments.add({static_cast<double>(i), 5, 1e9 + i}, static_cast<std::uint64_t>(i));
    EXPECT_DOUBLE_EQ(moments.mean[0], 2.5);
    EXPECT_DOUBLE_EQ(moments.variance(0, 4), 5.0 / 12);
    EXPECT_EQ(moments.variance(1, 4), 0);
    EXPECT_NEAR(moments.variance(2, 4), 5.0 / 12, 1e-6);  // squares of 1e9 would leave nothing
    EXPECT_EQ(moments.variance(0, 1), 0);
}

}  // namespace
}  // namespace regather::capture
