#include "charts/envelope.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/results/rows.h"

namespace regather::charts {
namespace {

using namespace results;

using testing::ElementsAre;
using testing::Pair;

Row point(std::string ordering, std::uint64_t cache, std::uint64_t buffered, std::uint64_t net) {
    Row row = made_row(std::move(ordering), {}, {}, net);
    row.cache_bytes = cache;
    row.buffered_bytes = buffered;
    row.onchip_bytes = 100;
    row.buffer_traffic_bytes = 0;
    return row;
}

std::vector<std::pair<std::uint64_t, std::uint64_t>> steps(const Envelope& envelope) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> out;
    for (const Step& step : envelope.steps) out.emplace_back(step.budget_bytes, step.net_bytes);
    return out;
}

TEST(Envelope, ABudgetIsTheCacheAndWhatStaysOnTheChip) {
    EXPECT_EQ(budget_bytes(point("hilbert", 1000, 100, 1)), 1100u);
    EXPECT_EQ(budget_bytes(point("hilbert", 1000, 101, 1)), 1000u);  // goes to memory
    Row row = point("hilbert", 1000, 300, 1);
    row.onchip_bytes.reset();
    EXPECT_EQ(budget_bytes(row), 1300u);  // nothing is said to go off the chip
    row.reorder_bytes = 600;
    EXPECT_EQ(budget_bytes(row), 1000u);
    row.cache_bytes.reset();
    EXPECT_EQ(budget_bytes(row), std::nullopt);
}

//  net                     naive    hilbert (any tile)
//  90 | n----------.
//  80 |            n-----------
//  70 |      h--.
//  40 |         h--------.
//  20 |                  h-----     h at (30, 75) and (40, 40) lie above their curve
//     +--10--20-25-30-40-50---- budget
TEST(Envelope, IsTheLeastNetTrafficWithinABudgetAsDrawnByHand) {
    std::vector<Row> rows = {point("naive", 10, 0, 90),    point("naive", 30, 0, 80),
                             point("hilbert", 20, 30, 20), point("hilbert", 10, 10, 70),
                             point("hilbert", 25, 0, 40),  point("hilbert", 30, 0, 75),
                             point("hilbert", 40, 0, 40),  point("hilbert", 25, 0, 60)};
    for (Row& row : rows) row.tile = 8;
    const auto all = envelopes(rows);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].ordering, "naive");
    EXPECT_THAT(steps(all[0]), ElementsAre(Pair(10, 90), Pair(30, 80)));
    EXPECT_THAT(steps(all[1]), ElementsAre(Pair(20, 70), Pair(25, 40), Pair(50, 20)));
    EXPECT_EQ(all[1].steps[2].row, &rows[2]);
    EXPECT_THAT(reigns(all), ElementsAre(Reign{10, 0}, Reign{20, 1}));
}

TEST(Envelope, CountsTheTrafficOfBuffersAndLeavesOutWhatIsNotKnown) {
    std::vector<Row> rows = {point("hilbert", 10, 0, 5), point("hilbert", 20, 0, 5),
                             point("morton", 10, 0, 5)};
    rows[0].buffer_traffic_bytes = 7;
    rows[1].buffer_traffic_bytes.reset();
    rows[1].reorder_bytes = 2;
    rows[2].buffer_traffic_bytes.reset();
    const auto all = envelopes(rows);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_THAT(steps(all[0]), ElementsAre(Pair(10, 12), Pair(20, 7)));
    EXPECT_TRUE(envelopes({}).empty());
    EXPECT_TRUE(reigns({}).empty());
}

TEST(Envelope, AReignEndsWhereAnotherGetsLowerAndTiesStayWithTheFirst) {
    const std::vector<Row> rows = {point("a", 10, 0, 50), point("b", 10, 0, 50), point("b", 20, 0, 40),
                                   point("a", 30, 0, 40), point("a", 40, 0, 30), point("b", 60, 0, 29),
                                   point("a", 50, 0, 28)};
    // 10: both 50, a is first. 20: b alone at 40. 30: a draws level and, being first, takes over. Then a
    // stays.
    EXPECT_THAT(reigns(envelopes(rows)), ElementsAre(Reign{10, 0}, Reign{20, 1}, Reign{30, 0}));
}

}  // namespace
}  // namespace regather::charts
