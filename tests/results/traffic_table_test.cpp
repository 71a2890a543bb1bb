#include "results/traffic_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/results/rows.h"

namespace regather::results {
namespace {

TEST(TrafficTable, ReadsAsDrawnByHand) {
    std::vector<Row> rows = {
        made_row("naive", {}, {}, 211000000000),
        with_parameters(made_row("tiled", 16, {}, 212000000000), "tiled:tile=16,rows=left-to-right"),
        with_parameters(made_row("tiled", 16, {}, 205000000000), "tiled:tile=16,rows=alternating"),
        made_row("direction-binned", 16, 16, 36000000000),
        made_row("hilbert", {}, {}, 15000000),
    };
    for (Row& row : rows) row.compulsory_bytes = 12000000;
    rows[0].key_ops = 0;
    rows[0].buffered_bytes = 0;
    rows[3].key_ops = 1536000;
    rows[3].buffered_bytes = 12288;
    rows[4].key_ops = 127500;
    rows[4].buffered_bytes = 734003200;
    rows[4].reorder_bytes = 1468006400;
    EXPECT_EQ(
        traffic_text(rows),
        "room | 1.00 k queries | 128 KiB, 128 B lines, 8-way | lru | left-balanced-kd | heap-20\n"
        "ordering                    tile   bins  traffic  of naive  x floor  ops/query   buffer  reorder\n"
        "naive                                     211 GB     100 %    17583          0      0 B\n"
        "tiled (rows=left-to-right)    16          212 GB     100 %    17667\n"
        "tiled (rows=alternating)      16          205 GB    97.2 %    17083\n"
        "direction-binned              16  16x16  36.0 GB    17.1 %     3000       1536  12.3 kB\n"
        "hilbert                                  15.0 MB  0.0071 %     1.25        128   734 MB  1.47 GB\n"
        "floor = compulsory traffic, each line fetched once: 12.0 MB\n");
}

TEST(TrafficTable, EachCacheIsABlockAndComparesWithItsOwnNaive) {
    std::vector<Row> rows = {made_row("naive", {}, {}, 100), made_row("naive", {}, {}, 1000),
                             made_row("tiled", 8, {}, 50), made_row("tiled", 8, {}, 50)};
    rows[1].cache_bytes = rows[3].cache_bytes = 4096;
    const std::string text = traffic_text(rows);
    EXPECT_NE(text.find("50.0 %"), std::string::npos) << text;
    EXPECT_NE(text.find("5.00 %"), std::string::npos) << text;
    EXPECT_LT(text.find("128 KiB"), text.find("4 KiB"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '%'), 4);
}

TEST(TrafficTable, WithoutNaiveThereIsNoShare) {
    const std::vector<Row> rows = {made_row("tiled", 8, {}, 50)};
    EXPECT_EQ(traffic_text(rows).find('%'), std::string::npos);
    EXPECT_EQ(traffic_text({}), "");
}

TEST(TrafficTable, ShowsClassesUncertaintyAndNetTrafficWhereRowsHaveThem) {
    std::vector<Row> rows = {made_row("naive", {}, {}, 128000), made_row("hilbert", {}, {}, 12800)};
    rows[0].misses = 1000;
    rows[0].compulsory = 100;
    rows[0].capacity = 594;
    rows[0].conflict = 306;
    rows[1].misses = 100;
    rows[1].set_sampling = 16;
    rows[1].misses_low = 98;
    rows[1].misses_high = 103;
    rows[1].reorder_bytes = 5000;
    rows[1].buffer_traffic_bytes = 7200;
    EXPECT_EQ(traffic_text(rows),
              "room | 1.00 k queries | 128 KiB, 128 B lines, 8-way | lru | left-balanced-kd | heap-20\n"
              "ordering  tile  bins  traffic      +-  of naive  x floor    3C [%]  ops/query  buffer  "
              "reorder      net\n"
              "naive                  128 kB             100 %           10/59/31\n"
              "hilbert               12.8 kB  2.50 %    10.0 %                                        5.00 "
              "kB  20.0 kB\n"
              "3C = compulsory / capacity / conflict misses\n"
              "+- = half the 95 % confidence interval of the sampled misses\n"
              "net = traffic of photons and of reorder buffers\n");
}

TEST(TrafficTable, WithEveryColumnStaysWithinAHundredAndTwenty) {
    std::vector<Row> rows = {with_parameters(made_row("direction-binned+hashed", 512, 32, 999400000000),
                                             "x:tile=512,bins=32,passes=1024"),
                             with_parameters(made_row("direction-binned+hashed", 512, 32, 1230000000),
                                             "x:tile=512,bins=32,passes=1023"),
                             made_row("naive", {}, {}, 999400000000)};
    for (Row& row : rows) {
        row.compulsory_bytes = 10000000;
        row.buffered_bytes = row.reorder_bytes = row.buffer_traffic_bytes = 1230000000;
        row.key_ops = 99999000;
        row.misses = 100000;
        row.compulsory = row.capacity = row.conflict = 33333;
        row.set_sampling = 64;
        row.misses_low = 95000;
        row.misses_high = 105020;
    }
    std::istringstream lines(traffic_text(rows));
    std::size_t longest = 0;
    for (std::string line; std::getline(lines, line);) {
        longest = std::max(longest, line.size());
        EXPECT_LE(line.size(), 120u) << line;
    }
    EXPECT_EQ(longest, 120u);
}

TEST(TrafficTable, StaysWithinAHundredCharacters) {
    std::vector<Row> rows = {with_parameters(made_row("direction-binned+hashed", 512, 32, 999000000000),
                                             "x:tile=512,bins=32,passes=1024,buckets=65536,capacity=1048576"),
                             with_parameters(made_row("direction-binned+hashed", 512, 32, 123000000000),
                                             "x:tile=512,bins=32,passes=1024,buckets=65536,capacity=1048577"),
                             made_row("naive", {}, {}, 999000000000)};
    for (Row& row : rows) {
        row.compulsory_bytes = 1000000;
        row.buffered_bytes = row.reorder_bytes = 123000000;
        row.key_ops = 99999000;
    }
    std::istringstream lines(traffic_text(rows));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

}  // namespace
}  // namespace regather::results
