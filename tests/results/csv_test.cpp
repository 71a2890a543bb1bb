#include "results/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "tests/results/folder.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::results {
namespace {

constexpr const char* issue_header =
    "scene,frame,ordering,tile,bins,structure,layout,policy,cache_bytes,line_bytes,ways,queries,accesses,"
    "raw_bytes,oracle_bytes,compulsory_bytes,misses,traffic_bytes,reorder_bytes,key_ops,moved_records,"
    "buffered_bytes,recast_rays,order_seconds,replay_seconds";

/// What from_csv() says against `text`; "" when it takes it.
std::string refusal(std::string_view text) {
    try {
        from_csv(text, "mine.csv");
    } catch (const trace::DataError& error) {
        return error.what();
    }
    return "";
}

rc::Gen<std::string> any_text() {
    return rc::gen::container<std::string>(rc::gen::element('a', ',', '"', '\n', '\r', ' ', '7', '\xC3'));
}
rc::Gen<Count> any_count() {
    return rc::gen::oneOf(
        rc::gen::just(Count()),
        rc::gen::map(rc::gen::arbitrary<std::uint64_t>(), [](std::uint64_t n) { return Count(n); }),
        rc::gen::just(Count(UINT64_MAX)), rc::gen::just(Count(0)));
}

TEST(Csv, BeginsWithTheColumnsOfTheContractInTheirOrder) {
    EXPECT_EQ(to_csv({}), std::string(issue_header) + ",parameters,keys,sort_passes,stalls\n");
}

TEST(Csv, WritesAMeasurementAsDrawnByHand) {
    Row row;
    row.scene = "room";
    row.ordering = "direction-binned";
    row.tile = 16;
    row.bins = 8;
    row.parameters = "direction-binned:tile=16,bins=8";
    row.structure = "left-balanced-kd";
    row.layout = "heap-20";
    row.policy = "lru";
    row.cache_bytes = 131072;
    row.line_bytes = 128;
    row.ways = 0;
    row.queries = 1000;
    row.accesses = 140000;
    row.misses = 0;
    row.traffic_bytes = 0;
    row.order_seconds = 0.25;
    row.replay_seconds = 12;
    EXPECT_EQ(to_csv(std::span(&row, 1)),
              std::string(issue_header) + ",parameters,keys,sort_passes,stalls\n" +
                  "room,,direction-binned,16,8,left-balanced-kd,heap-20,lru,131072,128,full,1000,140000,"
                  ",,,0,0,,,,,,0.250000,12.000000,\"direction-binned:tile=16,bins=8\",,,\n");
}

TEST(Csv, GivesBackEveryFieldOfAnyRows) {
    ASSERT_TRUE(rc::check([] {
        std::vector<Row> rows(static_cast<std::size_t>(*rc::gen::inRange(0, 4)));
        for (Row& row : rows) {
            for (const auto field :
                 {&Row::scene, &Row::structure, &Row::layout, &Row::policy, &Row::parameters})
                row.*field = *any_text();
            row.ordering = "x" + *any_text();
            for (const auto field : {&Row::frame,
                                     &Row::tile,
                                     &Row::bins,
                                     &Row::cache_bytes,
                                     &Row::line_bytes,
                                     &Row::ways,
                                     &Row::queries,
                                     &Row::accesses,
                                     &Row::raw_bytes,
                                     &Row::oracle_bytes,
                                     &Row::compulsory_bytes,
                                     &Row::misses,
                                     &Row::traffic_bytes,
                                     &Row::keys,
                                     &Row::key_ops,
                                     &Row::sort_passes,
                                     &Row::moved_records,
                                     &Row::buffered_bytes,
                                     &Row::reorder_bytes,
                                     &Row::recast_rays,
                                     &Row::stalls})
                row.*field = *any_count();
            for (const auto field : {&Row::order_seconds, &Row::replay_seconds})
                if (*rc::gen::arbitrary<bool>()) row.*field = *rc::gen::inRange(0, 100000000) / 1e6;
        }
        const auto back = from_csv(to_csv(rows), "memory");
        RC_ASSERT(back.size() == rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const auto fields = [](const Row& r) {
                return std::tie(r.scene, r.frame, r.ordering, r.tile, r.bins, r.parameters, r.structure,
                                r.layout, r.policy, r.cache_bytes, r.line_bytes, r.ways, r.queries,
                                r.accesses, r.raw_bytes, r.oracle_bytes, r.compulsory_bytes, r.misses,
                                r.traffic_bytes, r.keys, r.key_ops, r.sort_passes, r.moved_records,
                                r.buffered_bytes, r.reorder_bytes, r.recast_rays, r.stalls, r.order_seconds,
                                r.replay_seconds);
            };
            RC_ASSERT(fields(back[i]) == fields(rows[i]));
        }
    }));
}

TEST(Csv, TakesRowsThatSomebodyElseWrote) {
    const auto rows = from_csv(
        "\xEF\xBB\xBF"
        "traffic_bytes,note,ways,ordering,line_bytes,cache_bytes\r\n"
        "17,\"a \"\"remark\"\", with\na line\",full,\"my order\",64,4096\r\n"
        "\r\n"
        ",,4,naive,64,8192",
        "mine.csv");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].ordering, "my order");
    EXPECT_EQ(rows[0].traffic_bytes, 17u);
    EXPECT_EQ(rows[0].ways, 0u);
    EXPECT_EQ(rows[1].traffic_bytes, std::nullopt);
    EXPECT_EQ(rows[1].cache_bytes, 8192u);
    EXPECT_EQ(rows[1].queries, std::nullopt);
}

TEST(Csv, RefusesABadCellByFileLineColumnFoundAndExpected) {
    const std::string header = "ordering,cache_bytes,line_bytes,ways,traffic_bytes,order_seconds\n";
    EXPECT_EQ(refusal(header + "naive,4096,64,8,1,\nnaive,4096,64,8,12x,\n"),
              "mine.csv: line 3, column 5 (traffic_bytes): found \"12x\", expected a whole number or an "
              "empty cell");
    // A cell with a line end inside moves the lines after it.
    EXPECT_EQ(
        refusal(header + "\"na\nive\",4096,64,8,1,\nnaive,-1,64,8,1,\n"),
        "mine.csv: line 4, column 2 (cache_bytes): found \"-1\", expected a whole number or an empty cell");
    EXPECT_EQ(
        refusal(header + "naive,4096,64,0,1,\n"),
        "mine.csv: line 2, column 4 (ways): found \"0\", expected a whole number from 1 up, \"full\" or an "
        "empty cell");
    EXPECT_EQ(
        refusal(header + "naive,18446744073709551616,64,1,1,\n"),
        "mine.csv: line 2, column 2 (cache_bytes): found \"18446744073709551616\", expected a whole number "
        "below 2^64");
    for (const char* seconds : {"nan", "inf", "-0.5", "1s", "1e999"})
        EXPECT_EQ(refusal(header + "naive,4096,64,8,1," + seconds + "\n"),
                  std::string("mine.csv: line 2, column 6 (order_seconds): found \"") + seconds +
                      "\", expected seconds as a decimal number from 0 up, or an empty cell");
    EXPECT_EQ(refusal(header + ",4096,64,8,1,\n"),
              "mine.csv: line 2, column 1 (ordering): found \"\", expected the name of an ordering");
}

TEST(Csv, RefusesAFileThatIsNoTable) {
    EXPECT_EQ(refusal(""), "mine.csv: empty, expected a header line");
    EXPECT_EQ(refusal("\n\n"), "mine.csv: empty, expected a header line");
    EXPECT_EQ(refusal("ordering,cache_bytes,line_bytes,ways\n"),
              "mine.csv: line 1, column 5 (traffic_bytes): found the end of the header, expected a column "
              "\"traffic_bytes\"");
    EXPECT_EQ(refusal("ordering,cache_bytes,line_bytes,ways,traffic_bytes,ways\n"),
              "mine.csv: line 1, column 6 (ways): found the column a second time, expected each column once");
    const std::string header = "ordering,cache_bytes,line_bytes,ways,traffic_bytes\n";
    EXPECT_EQ(refusal(header + "naive,1,2,3\n"),
              "mine.csv: line 2, column 5: found 4 cells, expected 5 as in the header");
    EXPECT_EQ(refusal(header + "naive,1,2,3,4,5\n"),
              "mine.csv: line 2, column 6: found 6 cells, expected 5 as in the header");
    EXPECT_EQ(
        refusal(header + "na\"ive,1,2,3,4\n"),
        "mine.csv: line 2, column 1: found a quote inside a cell, expected quotes around the whole cell");
    EXPECT_EQ(refusal(header + "naive,\"1\"2,2,3,4\n"),
              "mine.csv: line 2, column 2: found text after a closing quote, expected a comma or the end of "
              "the line");
    EXPECT_EQ(refusal(header + "naive,1,2,3,4\nnaive,\"1,2,\n3,4\n"),
              "mine.csv: line 3, column 2: found a quote that is never closed, expected a closing quote");
    EXPECT_EQ(refusal(header), "");
}

TEST(Csv, NoCutOrAlteredFileCrashesTheReader) {
    Row row;
    row.ordering = "na\"ive,";
    row.cache_bytes = 4096;
    row.order_seconds = 1.5;
    const std::vector<Row> rows(3, row);
    const std::string whole = to_csv(rows);
    for (std::size_t size = 0; size <= whole.size(); ++size) refusal(std::string_view(whole).substr(0, size));
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const char c : {'"', ',', '\n', '\r', '\0', 'x'}) {
            std::string altered = whole;
            altered[at] = c;
            EXPECT_EQ(refusal(altered).find('\n'), std::string::npos);
        }
}

TEST(Csv, AFileIsReplacedWholeOrNotAtAll) {
    const Folder folder;
    Row row;
    row.ordering = "naive";
    write_csv(folder / "deep/rows.csv", std::span(&row, 1));
    EXPECT_EQ(read_csv(folder / "deep/rows.csv").size(), 1u);
    EXPECT_FALSE(std::filesystem::exists(folder / "deep/rows.csv.part"));

    std::filesystem::create_directories(folder / "taken");
    EXPECT_THROW(write_csv(folder / "taken", std::span(&row, 1)), std::runtime_error);
    EXPECT_FALSE(std::filesystem::exists(folder / "taken.part"));
    try {
        read_csv(folder / "absent.csv");
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_EQ(std::string(error.what()),
                  (folder / "absent.csv").string() + ": cannot be read: No such file or directory");
    }
    EXPECT_THROW(read_csv(folder.path()), trace::DataError);
}

}  // namespace
}  // namespace regather::results
