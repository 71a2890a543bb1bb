#include "results/table.h"

#include <gtest/gtest.h>

#include "results/cache_row.h"

namespace regather::results {
namespace {

Table drawn() {
    Table table({{"name", Align::left, {.most = 8}}, {"count"}, {"note", Align::left, {.if_any = true}}});
    table.title = "Two things";
    table.add({"é, \"x\"", "7"});
    table.add({"much too long", "12345"});
    table.notes = {"that is all"};
    return table;
}

TEST(Table, StandsInColumnsAsDrawnByHand) {
    EXPECT_EQ(text_of(drawn()),
              "Two things\n"
              "name      count\n"
              "é, \"x\"        7\n"
              "much ...  12345\n"
              "that is all\n");
}

TEST(Table, AColumnThatMayBeLeftAwayStandsWhereOneCellSaysSomething) {
    Table table = drawn();
    table.add({"z", "1", "odd"});
    EXPECT_EQ(text_of(table),
              "Two things\n"
              "name      count  note\n"
              "é, \"x\"        7\n"
              "much ...  12345\n"
              "z             1  odd\n"
              "that is all\n");
}

TEST(Table, TheFirstColumnGivesWayToTheWidth) {
    Table table({{"what", Align::left}, {"a"}});
    table.add({"thirteen letters and more", "123456"});
    EXPECT_EQ(text_of(table, 24), "what                   a\nthirteen lett...  123456\n");
    EXPECT_EQ(text_of(table, 5), "what               a\nthirteen ...  123456\n");  // 12 at the least
}

TEST(Table, SeveralStandApart) {
    Table one({{"a"}});
    one.add({"1"});
    const Table both[] = {one, one};
    EXPECT_EQ(text_of(both), "a\n1\n\na\n1\n");
}

TEST(Table, OfRowsShowsTheColumnsThatSaySomething) {
    CacheRow rows[2];
    rows[0].policy = "lru";
    rows[0].ways = 0;
    rows[1].policy = "fifo";
    rows[1].misses = 30;
    EXPECT_EQ(text_of(table_of<CacheRow>(rows)),
              "policy  ways  misses\n"
              "lru     full\n"
              "fifo              30\n");
}

TEST(Letters, AreCountedAndCutWhole) {
    EXPECT_EQ(letters("16×16 °"), 7u);
    EXPECT_EQ(cut("16×16 direction", 7), "16×1...");
    EXPECT_EQ(cut("×××", 3), "×××");
    EXPECT_EQ(cut("abcd", 2), "..");
}

}  // namespace
}  // namespace regather::results
