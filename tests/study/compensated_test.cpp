#include "study/compensated.h"

#include <gtest/gtest.h>

namespace regather::study {
namespace {

TEST(Compensated, KeepsWhatCancels) {
    Compensated<double> sum;
    for (const double x : {1.0, 1e100, 1.0, -1e100})
        sum += x;  // Neumaier's example: 0 without compensation, and in Kahan's sum
    EXPECT_EQ(sum.value(), 2);
    Compensated<float> many;
    for (int i = 0; i < 20'000'000; ++i)
        many += 1.0f;  // a float alone stops at 2^24; the lost part may hold as much again
    EXPECT_EQ(many.value(), 2e7f);
    Compensated<double> a, b;
    a += 1e100;
    a += 1.0;
    b += -1e100;
    b += 1.0;
    a += b;
    EXPECT_EQ(a.value(), 2);
}

}  // namespace
}  // namespace regather::study
