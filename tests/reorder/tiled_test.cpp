#include "reorder/tiled.h"

#include <gtest/gtest.h>

#include "reorder/catalogue.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers order_by(std::string_view spec, const Queries& queries) {
    return order(*make_ordering(spec), queries.workload()).permutation;
}

//  0  1 |  2  3
//  4  5 |  6  7
// ------+------
//  8  9 | 10 11
// 12 13 | 14 15
TEST(Tiled, FourTilesOfA4x4Image) {
    const Queries image = one_per_pixel(4, 4);
    EXPECT_EQ(order_by("tiled:tile=2", image),
              (Numbers{0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15}));
    EXPECT_EQ(order_by("tiled:tile=2,rows=alternating", image),
              (Numbers{0, 1, 5, 4, 2, 3, 7, 6, 8, 9, 13, 12, 10, 11, 15, 14}));
}

TEST(Tiled, OneTileAlternating) {
    const Queries image = one_per_pixel(4, 4);
    EXPECT_EQ(order_by("tiled:tile=4,rows=alternating", image),
              (Numbers{0, 1, 2, 3, 7, 6, 5, 4, 8, 9, 10, 11, 15, 14, 13, 12}));
    EXPECT_EQ(order_by("tiled:tile=65536,rows=alternating", image),
              (Numbers{0, 1, 2, 3, 7, 6, 5, 4, 8, 9, 10, 11, 15, 14, 13, 12}));
}

//  0  1  2 |  3  4
//  5  6  7 |  8  9
// 10 11 12 | 13 14
// ---------+------
// 15 16 17 | 18 19
TEST(Tiled, TilesAreClippedAtTheEdges) {
    EXPECT_EQ(order_by("tiled:tile=3,rows=alternating", one_per_pixel(5, 4)),
              (Numbers{0, 1, 2, 7, 6, 5, 10, 11, 12, 3, 4, 9, 8, 13, 14, 15, 16, 17, 18, 19}));
}

TEST(Tiled, SamplesOfAPixelStayTogetherInCaptureOrder) {
    Queries image;
    image.width = image.height = 2;
    image.pixel = {0, 0, 1, 1, 1, 2, 3, 3};
    image.position.resize(8);
    EXPECT_EQ(order_by("tiled:tile=2,rows=alternating", image), (Numbers{0, 1, 2, 3, 4, 6, 7, 5}));
    EXPECT_EQ(order_by("naive", image), (Numbers{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(Random, SeedsDifferAndRepeat) {
    const Queries image = one_per_pixel(16, 16);
    const Numbers first = order_by("random:seed=1", image);
    EXPECT_EQ(order_by("random", image), first);
    EXPECT_NE(order_by("random:seed=2", image), first);
    EXPECT_NE(order_by("random:seed=4294967297", image), first);  // the seed's upper half counts
    // Of a random order about one rank in n is a fixed point, and about n/2 steps go up.
    int fixed = 0, up = 0;
    for (std::uint32_t r = 0; r < 256; ++r) fixed += first[r] == r, up += r > 0 && first[r] > first[r - 1];
    EXPECT_LT(fixed, 8);
    EXPECT_GT(up, 100);
    EXPECT_LT(up, 156);
}

}  // namespace
}  // namespace regather::reorder
