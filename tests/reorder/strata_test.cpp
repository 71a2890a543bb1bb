#include "reorder/strata.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "reorder/catalogue.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

using Numbers = std::vector<std::uint32_t>;

std::vector<std::uint32_t> permuted(std::string_view spec, const Queries& queries) {
    return order(*make_ordering(spec), queries.workload()).permutation;
}

/// The middle of a cell of a grid of rows x columns, as a capture writes it.
std::uint32_t middle(std::uint32_t row, std::uint32_t rows, std::uint32_t column, std::uint32_t columns) {
    return (2 * row + 1) * 32768 / rows << 16 | (2 * column + 1) * 32768 / columns;
}

Queries two_pixels() {  // of a 2 x 1 image, each with a sample in each cell of 2 x 2, in two sequences
    Queries queries;
    queries.width = 2;
    queries.pixel = {0, 0, 0, 0, 1, 1, 1, 1};
    queries.position.resize(8);
    for (const auto& [row, column] :
         {std::pair{1, 1}, {0, 1}, {1, 0}, {0, 0}, {0, 1}, {0, 0}, {1, 1}, {1, 0}})
        queries.stratum.push_back(
            middle(static_cast<std::uint32_t>(row), 2, static_cast<std::uint32_t>(column), 2));
    return queries;
}

TEST(Strata, EachPassMakesOneStratumOfEveryPixelOfATile) {
    const Queries queries = two_pixels();
    EXPECT_EQ(permuted("strata:tile=2,strata=2", queries), (Numbers{3, 5, 1, 4, 2, 7, 0, 6}));
    EXPECT_EQ(permuted("strata:tile=2,strata=2,order=columns", queries), (Numbers{3, 5, 2, 7, 1, 4, 0, 6}));
    EXPECT_EQ(permuted("strata:tile=1,strata=2", queries), (Numbers{3, 1, 2, 0, 5, 4, 7, 6}));
    EXPECT_EQ(permuted("strata:tile=2,strata=1", queries), (Numbers{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(Strata, MortonOrderGoesOverQuartersOfTheGrid) {
    // One pixel with 4 x 4 strata, drawn in row order: the quarters one after the other.
    Queries queries;
    queries.pixel.assign(16, 0);
    queries.position.resize(16);
    for (std::uint32_t cell = 0; cell < 16; ++cell)
        queries.stratum.push_back(middle(cell / 4, 4, cell % 4, 4));
    EXPECT_EQ(permuted("strata:strata=4,order=morton", queries),
              (Numbers{0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15}));
}

TEST(Strata, CoarserGridsMakeSeveralStrataInAPass) {
    // 10 rows of one column into 4 rows: the middles 0.05, 0.15 ... of a row of height 0.25.
    Queries queries;
    queries.pixel.assign(10, 0);
    queries.position.resize(10);
    for (std::uint32_t row = 0; row < 10; ++row) queries.stratum.push_back(middle(9 - row, 10, 0, 1));
    EXPECT_EQ(permuted("strata:strata=4", queries), (Numbers{8, 9, 5, 6, 7, 3, 4, 0, 1, 2}));
}

TEST(Strata, BinsOfTheWorldAreThePassesOfDirectionBinned) {
    ASSERT_TRUE(rc::check([] {
        const Queries queries = any_queries();
        const auto n = *rc::gen::inRange(1, 9), tile = *rc::gen::inRange(1, 9);
        RC_ASSERT(permuted(fmt::format("strata:frame=world,tile={},strata={}", tile, n), queries) ==
                  permuted(fmt::format("direction-binned:tile={},bins={}", tile, n), queries));
    }));
}

}  // namespace
}  // namespace regather::reorder
