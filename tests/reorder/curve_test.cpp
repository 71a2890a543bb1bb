#include "reorder/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reorder/catalogue.h"
#include "reorder/cell_block.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

TEST(Morton, InterleavesBitsWithXHighest) {
    EXPECT_EQ(morton_code({0, 0, 0}), 0u);
    EXPECT_EQ(morton_code({1, 0, 0}), 4u);
    EXPECT_EQ(morton_code({0, 1, 0}), 2u);
    EXPECT_EQ(morton_code({0, 0, 1}), 1u);
    EXPECT_EQ(morton_code({5, 3, 6}), 0b101'011'110u);  // x 101, y 011, z 110: (1,0,1) (0,1,1) (1,1,0)
    constexpr std::uint32_t top = 1u << 20;
    EXPECT_EQ(morton_code({top, 0, 0}), std::uint64_t{1} << 62);
    EXPECT_EQ(morton_code({2 * top - 1, 2 * top - 1, 2 * top - 1}), (std::uint64_t{1} << 63) - 1);
}

TEST(Swizzle, IsMortonOfSmallCells) {
    for (std::uint32_t x = 0; x < 256; ++x) {
        const Cell cell{x, 255 - x, x * 7 % 256};
        EXPECT_EQ(swizzle_code(cell), morton_code(cell));
    }
}

class HilbertWalk : public testing::TestWithParam<std::uint32_t> {};

TEST_P(HilbertWalk, VisitsEachCellOnceAndStepsToAFaceNeighbour) {
    const std::uint32_t bits = GetParam(), edge = 1u << bits;
    std::vector<int> visits(std::size_t{1} << 3 * bits);
    std::vector<Cell> walk(visits.size());
    for (std::uint32_t x = 0; x < edge; ++x)
        for (std::uint32_t y = 0; y < edge; ++y)
            for (std::uint32_t z = 0; z < edge; ++z) {
                const std::uint64_t code = hilbert_code(morton_code({x, y, z}), bits);
                ASSERT_LT(code, visits.size());
                ++visits[code];
                walk[code] = {x, y, z};
            }
    for (const int visit : visits) ASSERT_EQ(visit, 1);
    for (std::size_t i = 1; i < walk.size(); ++i) {
        int steps = 0;
        for (int axis = 0; axis < 3; ++axis)
            steps += std::abs(static_cast<int>(walk[i][axis]) - static_cast<int>(walk[i - 1][axis]));
        ASSERT_EQ(steps, 1) << "from code " << i - 1;
    }
}

// 3, 6: whole steps of three levels; the others begin with single levels.
INSTANTIATE_TEST_SUITE_P(Bits, HilbertWalk, testing::Values(1u, 2u, 3u, 4u, 5u, 6u));

TEST(Hilbert, FineCurvesRefineCoarseOnes) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const std::uint64_t morton = scrambled(i) >> 1;  // 21 bits an axis
        const std::uint64_t code = hilbert_code(morton, 21);
        EXPECT_EQ(hilbert_code(morton >> 3, 20), code >> 3);
        EXPECT_EQ(hilbert_code(morton >> 33, 10), code >> 33);
    }
}

// The table and the lanes share no code but the curve's definition.
TEST(Hilbert, BlocksOfCellsHaveTheCodesOfSingleCells) {
    for (std::uint32_t bits = 1; bits <= max_curve_bits; ++bits) {
        const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
        CellBlock block;
        for (std::size_t i = 0; i < CellBlock::cells; ++i) {
            block.x[i] = static_cast<std::uint32_t>(scrambled(3 * i) & mask);
            block.y[i] = static_cast<std::uint32_t>(scrambled(3 * i + 1) & mask);
            block.z[i] = static_cast<std::uint32_t>(scrambled(3 * i + 2) & mask);
        }
        CellBlock turned = block;
        turn_along_hilbert(turned, bits);
        for (std::size_t i = 0; i < CellBlock::cells; ++i)
            ASSERT_EQ(morton_code({turned.x[i], turned.y[i], turned.z[i]}),
                      hilbert_code(morton_code({block.x[i], block.y[i], block.z[i]}), bits))
                << bits << " bits";
    }
}

// More queries than a block, and a block that is not full; every third position has no cell.
TEST(CurveSorted, KeysOfManyQueriesAreTheCodesOfTheirCells) {
    Queries queries = one_per_pixel(700, 1);
    for (std::size_t i = 0; i < 700; ++i) {
        queries.position[i] = {static_cast<float>(scrambled(i) % 1024),
                               static_cast<float>(scrambled(i + 700) % 1024), static_cast<float>(i % 1024)};
        if (i % 3 == 1) queries.position[i].y = NAN;
    }
    queries.position[0] = {0, 0, 0};
    queries.position[699] = {1024, 1024, 1024};
    std::vector<std::uint64_t> keys(700);
    make_ordering("hilbert:bits=10")->assign_keys(queries.workload(), default_onchip_bytes, keys);
    for (std::size_t i = 0; i < 699; ++i) {
        const Vec3 p = queries.position[i];
        const Cell cell{static_cast<std::uint32_t>(p.x), i % 3 == 1 ? 0 : static_cast<std::uint32_t>(p.y),
                        static_cast<std::uint32_t>(p.z)};
        ASSERT_EQ(keys[i], i % 3 == 1 ? 1u << 30 : hilbert_code(morton_code(cell), 10)) << i;
    }
}

TEST(CellGrid, CellsAreCubicOverTheLongestEdge) {
    const CellGrid grid({{0, 0, 0}, {8, 4, 1}}, 8);
    EXPECT_EQ(grid.cell_of({0, 0, 0}), (Cell{0, 0, 0}));
    EXPECT_EQ(grid.cell_of({2.5f, 2.5f, 0.5f}), (Cell{2, 2, 0}));
    EXPECT_EQ(grid.cell_of({8, 4, 1}), (Cell{7, 4, 1}));  // the far face belongs to the last cell
    EXPECT_EQ(grid.cell_of({-5, 100, 3e38f}), (Cell{0, 7, 7}));
}

TEST(CellGrid, WithstandsAnyBox) {
    const float least = std::numeric_limits<float>::denorm_min(), most = std::numeric_limits<float>::max();
    EXPECT_EQ(CellGrid({{3, 3, 3}, {3, 3, 3}}, 1024).cell_of({3, 3, 3}), (Cell{0, 0, 0}));
    EXPECT_EQ(CellGrid({{3, 3, 3}, {3, 3, 3}}, 1024).cell_of({4, 2, 3}), (Cell{0, 0, 0}));
    EXPECT_EQ(CellGrid({}, 1024).cell_of({3, 3, 3}), (Cell{0, 0, 0}));
    EXPECT_EQ(CellGrid({{0, 0, 0}, {least, 0, 0}}, 1 << 21).cell_of({least, 0, 0}),
              (Cell{(1 << 21) - 1, 0, 0}));
    EXPECT_EQ(CellGrid({{-most, -most, -most}, {most, most, most}}, 2).cell_of({most, -most, 1}),
              (Cell{1, 0, 1}));
    const CellGrid thin({{0, 0, 0}, {1e12f, 1, 0}}, 1 << 10);
    EXPECT_EQ(thin.cell_of({5e11f, 1, 0}), (Cell{512, 0, 0}));
    EXPECT_EQ(CellGrid({{0, 0, 0}, {most, INFINITY, 0}}, 8).cell_of({most, 1, 0}), (Cell{0, 0, 0}));
}

// Corners of a cube in the order of the codes, x highest: 000 001 010 011 100 ...; NaN and infinity last, as
// captured.
TEST(CurveSorted, MortonOrderOfACubesCornersByHand) {
    Queries queries = one_per_pixel(9, 1);
    queries.position = {{1, 1, 1}, {NAN, 0, 0},      {0, 1, 0}, {1, 0, 0}, {0, 0, 0},
                        {0, 0, 1}, {0, INFINITY, 0}, {0, 1, 1}, {1, 0, 0}};
    const std::vector<std::uint32_t> expected{4, 5, 2, 7, 3, 8, 0, 1, 6};
    EXPECT_EQ(order(*make_ordering("morton"), queries.workload()).permutation, expected);
    EXPECT_EQ(order(*make_ordering("swizzle:bits=1"), queries.workload()).permutation, expected);
}

TEST(CurveSorted, TilesAreVisitedInRowOrderAndSortedInside) {
    Queries queries = one_per_pixel(4, 2);
    for (std::uint32_t i = 0; i < 8; ++i) queries.position[i] = {static_cast<float>(7 - i), 0, 0};
    // tiles of 2: pixels 0 1 4 5 | 2 3 6 7, each from its smallest x, which is its greatest number
    const std::vector<std::uint32_t> expected{5, 4, 1, 0, 7, 6, 3, 2};
    EXPECT_EQ(order(*make_ordering("morton:tile=2"), queries.workload()).permutation, expected);
    EXPECT_EQ(order(*make_ordering("swizzle:tile=2"), queries.workload()).permutation, expected);
    queries.position[0].y = NAN;  // last of its tile, not of the image
    EXPECT_EQ(order(*make_ordering("morton:tile=2,bits=21"), queries.workload()).permutation,
              (std::vector<std::uint32_t>{5, 4, 1, 0, 7, 6, 3, 2}));
    queries.position[5].y = NAN;
    EXPECT_EQ(order(*make_ordering("morton:tile=2"), queries.workload()).permutation,
              (std::vector<std::uint32_t>{4, 1, 0, 5, 7, 6, 3, 2}));
    queries.position[7].y = NAN;
    EXPECT_EQ(order(*make_ordering("morton:tile=2"), queries.workload()).permutation,
              (std::vector<std::uint32_t>{4, 1, 0, 5, 6, 3, 2, 7}));
}

TEST(CurveSorted, ManyTilesShortenTheCodeInsteadOfOverflowing) {
    Queries queries = one_per_pixel(1, 1);
    queries.width = 1 << 16;
    queries.height = 1 << 16;
    queries.pixel = {0xffffffff, 0, 0xffffffff, 1};
    queries.position = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, {NAN, 0, 0}};
    EXPECT_EQ(order(*make_ordering("hilbert:tile=1,bits=21"), queries.workload()).permutation,
              (std::vector<std::uint32_t>{1, 3, 2, 0}));
}

TEST(LeafSorted, SortsByTheLabelOfItsColumn) {
    Queries queries = one_per_pixel(2, 2);
    queries.leaf_kd = {7, 0xffffffff, 7, 0};
    queries.leaf_bvh = {1, 2, 3, 0};
    EXPECT_EQ(order(*make_ordering("kd-leaf"), queries.workload()).permutation,
              (std::vector<std::uint32_t>{3, 0, 2, 1}));
    EXPECT_EQ(order(*make_ordering("bvh-leaf"), queries.workload()).permutation,
              (std::vector<std::uint32_t>{3, 0, 1, 2}));
    EXPECT_EQ(order(*make_ordering("kd-leaf:tile=1"), queries.workload()).permutation,
              (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace regather::reorder
