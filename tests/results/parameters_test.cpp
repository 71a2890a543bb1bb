#include "results/parameters.h"

#include <gtest/gtest.h>

#include "tests/results/rows.h"

namespace regather::results {
namespace {

TEST(Parameters, AWordGivesItsOwnNumberOnly) {
    EXPECT_EQ(parameter("hilbert:tile=16,bits=10", "bits"), 10u);
    EXPECT_EQ(parameter("hilbert:tile=16,bits=10", "tile"), 16u);
    EXPECT_EQ(parameter("direction-binned:bins=4+hashed:subtile=8", "tile"), Count());
    EXPECT_EQ(parameter("hilbert:tile=16x", "tile"), Count());
    EXPECT_EQ(parameter("hilbert:tile=0", "tile"), Count());
    EXPECT_EQ(parameter("hilbert", "tile"), Count());
}

TEST(Parameters, WhatTheColumnsSayAlreadyIsLeftOut) {
    EXPECT_EQ(other_parameters(with_parameters(made_row("hilbert", 16, {}, 1), "hilbert:tile=16,bits=10")),
              "bits=10");
    EXPECT_EQ(other_parameters(with_parameters(made_row("direction-binned", 8, 3, 1),
                                               "direction-binned:tile=8,bins=3,passes=9,rows=alternating")),
              "rows=alternating");
    EXPECT_EQ(
        other_parameters(with_parameters(made_row("direction-binned", 8, 3, 1), "direction-binned:passes=8")),
        "passes=8");
}

}  // namespace
}  // namespace regather::results
