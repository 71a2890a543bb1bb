#include "reorder/tiled.h"

#include <gtest/gtest.h>

#include "reorder/catalogue.h"
#include "reorder/tiling.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers order_by(std::string_view spec, const Queries& queries) {
    return order(*make_ordering(spec), queries.workload()).permutation;
}

TEST(Tiling, WithoutAnEdgeAnImageOfAnyShapeIsOneTile) {
    for (const auto& [width, height] : {std::pair{3u, 8u}, {8u, 3u}, {5u, 5u}, {1u, 9u}}) {
        const Queries image = one_per_pixel(width, height);
        const Tiling whole(image.workload(), {});
        EXPECT_EQ(whole.tiles(), 1u) << width;
        EXPECT_EQ(whole.pixels_in_tile(), width * height);
        for (std::uint32_t pixel = 0; pixel < width * height; ++pixel) {
            EXPECT_EQ(whole.tile_of(pixel), 0u) << width << " " << pixel;
            EXPECT_EQ(whole.column_in_tile(pixel), pixel % width);
            EXPECT_EQ(whole.row_in_tile(pixel), pixel / width);
        }
    }
}

// 3 x 8 pixels in tiles of 2: two columns and four rows of them.
TEST(Tiling, CountsTheTilesOfAPortrait) {
    const Queries image = one_per_pixel(3, 8);
    const Tiling tiles(image.workload(), 2);
    EXPECT_EQ(tiles.tiles(), 8u);
    EXPECT_EQ(tiles.pixels_in_tile(), 4u);
    EXPECT_EQ(tiles.tile_of(2), 1u);
    EXPECT_EQ(tiles.tile_of(3), 0u);
    EXPECT_EQ(tiles.tile_of(6), 2u);
    EXPECT_EQ(tiles.tile_of(23), 7u);
    EXPECT_EQ(tiles.row_in_tile(23), 1u);
    EXPECT_EQ(tiles.column_in_tile(23), 0u);
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
