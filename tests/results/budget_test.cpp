#include "results/budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "tests/results/rows.h"

namespace regather::results {
namespace {

using testing::ElementsAre, testing::FieldsAre, testing::IsEmpty;

/// On a chip of 1000 bytes.
Row point(std::string ordering, std::uint64_t cache, std::uint64_t buffered, std::uint64_t traffic,
          std::uint64_t reorder = 0) {
    Row row = made_row(std::move(ordering), {}, {}, traffic);
    row.cache_bytes = cache;
    row.buffered_bytes = buffered;
    row.reorder_bytes = reorder;
    row.onchip_bytes = 1000;
    return row;
}

std::vector<std::tuple<std::uint64_t, std::uint64_t, std::string>> steps(const Front& front) {
    std::vector<std::tuple<std::uint64_t, std::uint64_t, std::string>> out;
    for (const FrontStep& step : front.steps)
        out.emplace_back(step.state_bytes, step.net_bytes, step.row->ordering);
    return out;
}

TEST(Budget, StateThatDoesNotFitTakesTheWholeChip) {
    EXPECT_EQ(onchip_state(point("hilbert", 64, 999, 1)), 999u);
    EXPECT_TRUE(stays_on_chip(point("hilbert", 64, 1000, 1)));
    EXPECT_EQ(onchip_state(point("hilbert", 64, 1001, 1, 5)), 1000u);
    EXPECT_FALSE(stays_on_chip(point("hilbert", 64, 1001, 1, 5)));
    Row row = point("hilbert", 64, 5000, 1);
    row.onchip_bytes.reset();
    EXPECT_EQ(onchip_state(row), 5000u);  // nothing goes off the chip
    row.reorder_bytes = 1;
    EXPECT_EQ(onchip_state(row), std::nullopt);
    row = point("naive", 64, 0, 1);
    EXPECT_EQ(onchip_state(row), 0u);
    row.buffered_bytes.reset();
    EXPECT_EQ(onchip_state(row), std::nullopt);
}

//  net      64-byte cache, buffers on the chip      through memory: m buffers 2000, so it takes all 1000
//  90 | n---.
//  60 |     b-------.         x at (300, 70) lies above
//  20 |             h-----
//  15 |                       ----m (12 and 3 through memory)
//     +-0---200-----500---1000  state
std::vector<Row> drawn() {
    return {point("naive", 64, 0, 90),     point("bins", 64, 200, 60),       point("x", 64, 300, 70),
            point("hilbert", 64, 500, 20), point("memory", 64, 2000, 12, 3), point("naive", 32, 0, 95),
            point("late", 64, 500, 20)};
}

TEST(Budget, AFrontIsTheLeastNetTrafficForItsStateAsDrawnByHand) {
    const std::vector<Row> rows = drawn();
    const std::vector<Front> kept = fronts(rows, Buffers::on_chip);
    ASSERT_EQ(kept.size(), 2u);
    EXPECT_EQ(kept[0].cache_bytes, 32u);  // smaller caches first
    EXPECT_THAT(steps(kept[0]), ElementsAre(FieldsAre(0, 95, "naive")));
    EXPECT_THAT(steps(kept[1]), ElementsAre(FieldsAre(0, 90, "naive"), FieldsAre(200, 60, "bins"),
                                            FieldsAre(500, 20, "hilbert")));
    EXPECT_THAT(steps(fronts(rows, Buffers::anywhere)[1]),
                ElementsAre(FieldsAre(0, 90, "naive"), FieldsAre(200, 60, "bins"),
                            FieldsAre(500, 20, "hilbert"), FieldsAre(1000, 15, "memory")));
    EXPECT_EQ(kept[1].within(199)->row->ordering, "naive");
    EXPECT_EQ(kept[1].within(200)->row->ordering, "bins");
    EXPECT_EQ(kept[1].within(1 << 20)->row->ordering, "hilbert");
    EXPECT_EQ((Front{64, {{10, 1, nullptr}}}).within(9), nullptr);
    EXPECT_THAT(fronts({}, Buffers::anywhere), IsEmpty());
}

TEST(Budget, RowsOnAFrontAreThoseOfBothKindsInTheirOrder) {
    const std::vector<Row> rows = drawn();
    std::vector<std::string> names;
    for (const Row& row : front_rows(rows)) names.push_back(row.ordering);
    EXPECT_THAT(names, ElementsAre("naive", "bins", "hilbert", "memory", "naive"));
}

TEST(Budget, RowsOfAShapeHaveItsLinesAndWaysAndAnySize) {
    std::vector<Row> rows = drawn();
    rows[1].ways = 4;
    rows[2].line_bytes = 64;
    rows[3].traffic_bytes.reset();
    EXPECT_EQ(rows_of_shape(rows, {}).size(), 4u);
    EXPECT_EQ(rows_of_shape(rows, Geometry{1, 128, 4}).size(), 1u);
    EXPECT_THAT(rows_of_shape(rows, Geometry{64, 32, 8}), IsEmpty());
    EXPECT_TRUE(of_one_setting(rows));
    EXPECT_TRUE(of_one_setting({}));
    rows[6].layout = "heap-32";
    EXPECT_FALSE(of_one_setting(rows));
}

TEST(Budget, TablesSayWhoWinsWithinEachBudgetAndNothingTwice) {
    std::vector<Row> rows{point("naive", 65536, 0, 90'000'000'000), point("bins", 65536, 768, 70'000'000'000),
                          with_parameters(point("hilbert", 65536, 20480, 9'000'000'000), "hilbert:tile=16"),
                          point("morton", 65536, 100'000'000, 2'000'000'000, 1'000'000'000)};
    for (Row& row : rows) {
        row.onchip_bytes = 1 << 20;
        row.compulsory_bytes = 20'000'000;
    }
    const std::vector<Table> tables = budget_tables(rows);
    ASSERT_EQ(tables.size(), 1u);
    EXPECT_EQ(tables[0].title, "64 KiB, 128 B lines, 8-way");
    EXPECT_THAT(
        tables[0].lines(),
        ElementsAre(ElementsAre("bins", "1 KiB", "768 B", "70.0 GB", "3500.00", "on the chip"),
                    ElementsAre("hilbert:tile=16", "64 KiB", "20 KiB", "9.00 GB", "450.00", "on the chip"),
                    ElementsAre("morton", "1 MiB", "1 MiB", "3.00 GB", "150.00", "through memory")));
    EXPECT_THAT(budgets(), ElementsAre(1024, 4096, 16384, 65536, 262144, 1 << 20, 1 << 22, 1 << 24, 1 << 26));
}

}  // namespace
}  // namespace regather::results
