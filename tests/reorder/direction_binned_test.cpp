#include "reorder/direction_binned.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reorder/catalogue.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

using Numbers = std::vector<std::uint32_t>;

TEST(DirectionBin, SixAxesOfTheSphere) {
    // 4 x 4: rows by cos theta from -z, columns by phi from +x towards +y
    EXPECT_EQ(direction_bin({0, 0, -1}, 4), 0u);
    EXPECT_EQ(direction_bin({1, 0, 0}, 4), 8u);
    EXPECT_EQ(direction_bin({0, 1, 0}, 4), 9u);
    EXPECT_EQ(direction_bin({-1, 0, 0}, 4), 10u);
    EXPECT_EQ(direction_bin({0, -1, 0}, 4), 11u);
    EXPECT_EQ(direction_bin({0, 0, 1}, 4), 12u);
}

TEST(DirectionBin, NegativeZerosDoNotMoveADirection) {
    EXPECT_EQ(direction_bin({-1, -0.0f, 0}, 4), 10u);
    EXPECT_EQ(direction_bin({-0.0f, -0.0f, 1}, 4), 12u);
    EXPECT_EQ(direction_bin({1, -0.0f, -0.0f}, 4), 8u);
}

TEST(DirectionBin, LastBinTakesWhatHasNoDirection) {
    for (const Vec3 odd : {Vec3{0, 0, 0}, Vec3{NAN, 0, 0}, Vec3{0, 0, INFINITY}})
        EXPECT_EQ(direction_bin(odd, 16), 255u);
    EXPECT_EQ(direction_bin({1, -1e-30f, 0}, 16), 8u * 16 + 15);  // just below 2 pi
    EXPECT_EQ(direction_bin({0.3f, 0.4f, 5}, 1), 0u);
}

// Archimedes: z and phi of a uniform direction are uniform and independent.
TEST(DirectionBin, UniformDirectionsFillBinsEvenly) {
    constexpr std::uint32_t bins = 8, draws = 64'000;
    std::vector<double> counts(bins * bins);
    for (std::uint64_t i = 0; i < draws; ++i) {
        // Marsaglia's rejection from the cube, which knows nothing of z and phi
        Vec3 d;
        for (std::uint64_t tries = 0; d == Vec3{} || dot(d, d) > 1 || dot(d, d) < 1e-4f; ++tries)
            d = Vec3{scrambled_unit(i << 20 | tries << 2), scrambled_unit(i << 20 | tries << 2 | 1),
                     scrambled_unit(i << 20 | tries << 2 | 2)} *
                    2 +
                Vec3{-1, -1, -1};
        ++counts[direction_bin(normalize(d), bins)];
    }
    const double expected = draws / static_cast<double>(bins * bins);
    double chi_squared = 0;
    for (const double count : counts) chi_squared += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi_squared, 103.4);  // 63 degrees of freedom, 0.1 %
    EXPECT_GT(chi_squared, 32.0);   // too even would be no draw
}

Queries three_directions() {  // pixel 0 | 1 of a 2 x 1 image: +z, -z, +x each
    Queries queries;
    queries.width = 2;
    queries.pixel = {0, 0, 0, 1, 1, 1};
    queries.position.resize(6);
    queries.direction = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}};
    return queries;
}

TEST(DirectionBinned, PassAfterPassOverATile) {
    const Queries queries = three_directions();
    EXPECT_EQ(order(*make_ordering("direction-binned:tile=2,bins=4"), queries.workload()).permutation,
              (Numbers{1, 4, 2, 5, 0, 3}));
    EXPECT_EQ(order(*make_ordering("direction-binned:tile=1,bins=4"), queries.workload()).permutation,
              (Numbers{1, 2, 0, 4, 5, 3}));
}

TEST(DirectionBinned, FewerPassesCoverRunsOfBins) {
    const Queries queries = three_directions();  // bins 12, 0, 8 of 16
    // two passes: bins 0-7 and 8-15, in capture order inside
    EXPECT_EQ(
        order(*make_ordering("direction-binned:tile=2,bins=4,passes=2"), queries.workload()).permutation,
        (Numbers{1, 4, 0, 2, 3, 5}));
    EXPECT_EQ(
        order(*make_ordering("direction-binned:tile=2,bins=4,passes=1"), queries.workload()).permutation,
        (Numbers{0, 1, 2, 3, 4, 5}));
    // three passes: 0-5, 6-10, 11-15
    EXPECT_EQ(
        order(*make_ordering("direction-binned:tile=2,bins=4,passes=3"), queries.workload()).permutation,
        (Numbers{1, 4, 2, 5, 0, 3}));
}

}  // namespace
}  // namespace regather::reorder
