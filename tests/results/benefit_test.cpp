#include "results/benefit.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/results/rows.h"
#include "trace/error.h"

namespace regather::results {
namespace {

Row with_buffers(Row row, Count buffer_traffic) {
    row.buffer_traffic_bytes = buffer_traffic;
    return row;
}

TEST(Benefit, IsNaivesTrafficLessTrafficOfPhotonsAndBuffers) {
    std::vector<Row> rows = {with_buffers(made_row("hilbert", 16, {}, 200), 50),
                             with_buffers(made_row("naive", {}, {}, 1000), 0),
                             with_buffers(made_row("hilbert", {}, {}, 10), 2000)};
    fill_net_benefit(rows);
    EXPECT_EQ(rows[0].net_benefit_bytes, 750);
    EXPECT_EQ(rows[1].net_benefit_bytes, 0);
    EXPECT_EQ(rows[2].net_benefit_bytes, -1010);  // more than it saves
}

TEST(Benefit, ComparesOnlyWithNaiveOfTheSameTraceCacheChipAndSampling) {
    const Row naive = with_buffers(made_row("naive", {}, {}, 1000), 0);
    const Row hilbert = with_buffers(made_row("hilbert", {}, {}, 10), 0);
    const auto benefit = [&](auto change) {
        std::vector<Row> rows = {naive, hilbert};
        change(rows[1]);
        fill_net_benefit(rows);
        return rows[1].net_benefit_bytes;
    };
    EXPECT_EQ(benefit([](Row&) {}), 990);
    EXPECT_EQ(benefit([](Row& row) { row.scene = "box"; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.frame = 1; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.structure = "grid"; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.layout = "veb"; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.policy = "opt"; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.cache_bytes = 1; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.line_bytes = 64; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.ways = 0; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.onchip_bytes = 4096; }), std::nullopt);
    EXPECT_EQ(benefit([](Row& row) { row.set_sampling = 16; }), std::nullopt);
}

TEST(Benefit, WithoutSimulatedBuffersTakesWhatTheOrderingTells) {
    std::vector<Row> rows = {made_row("naive", {}, {}, 1000), made_row("hilbert", {}, {}, 10),
                             made_row("morton", {}, {}, 10), made_row("swizzle", {}, {}, 10)};
    rows[1].reorder_bytes = 40;
    rows[2].reorder_bytes = 40;
    rows[2].buffer_traffic_bytes = 70;
    rows[3].net_benefit_bytes = 5;  // left from elsewhere, not known here
    fill_net_benefit(rows);
    EXPECT_EQ(rows[1].net_benefit_bytes, 950);
    EXPECT_EQ(rows[2].net_benefit_bytes, 920);
    EXPECT_EQ(rows[3].net_benefit_bytes, std::nullopt);
    EXPECT_EQ(net_traffic(rows[2]), 80u);
    EXPECT_EQ(net_traffic(rows[3]), std::nullopt);
}

TEST(Benefit, RefusesNaiveRowsThatContradictEachOther) {
    std::vector<Row> rows = {made_row("naive", {}, {}, 1000), made_row("naive", {}, {}, 1000)};
    fill_net_benefit(rows);
    rows[1].traffic_bytes = 999;
    EXPECT_THROW(fill_net_benefit(rows), trace::DataError);
}

}  // namespace
}  // namespace regather::results
