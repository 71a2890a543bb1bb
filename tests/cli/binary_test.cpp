// The binary's smaller subcommands: scenes, info, chart, cachesim.
#include <fmt/format.h>

#include "results/csv.h"
#include "scenes/catalogue.h"
#include "tests/cli/expect.h"
#include "tests/column.h"
#include "trace/npy.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Scenes, ListsEveryEmbeddedScene) {
    const std::string list = expect_done({"scenes"}).out;
    for (const scenes::EmbeddedScene& scene : scenes::catalogue()) {
        EXPECT_THAT(list, HasSubstr(fmt::format("\n{} ", scene.name)));
    }
}

TEST(Scenes, ShowsOneWithWhatItIs) {
    for (const scenes::EmbeddedScene& scene : scenes::catalogue()) {
        if (scene.name != "box" && scene.name != "cornell") continue;
        EXPECT_THAT(expect_done({"scenes", std::string(scene.name)}).out,
                    HasSubstr(std::string(scene.summary)));
    }
}

TEST(Scenes, AMisspeltKeyOfASceneFileIsBadData) {
    const Scratch scratch;
    write(scratch / "mine.json", R"({"camra": {}})");
    for (const char* command : {"scenes", "info"})
        expect_refused(bad_data, {command, (scratch / "mine.json").string()},
                       {"mine.json", "camra", "\"camera\""});
    expect_refused(bad_usage, {"scenes", "rom"}, {"\"rom\"", "\"room\""});
}

TEST(Info, TellsWhatATraceHolds) {
    const std::string text = expect_done({"info", box_trace()}).out;
    for (const char* part : {"scene      box", "16 x 16 pixels", "query_position", "float32 x 3",
                             "ray_gather_origin", "checksum"})
        EXPECT_THAT(text, HasSubstr(part));
    expect_refused(bad_data, {"info", captured_box().string()}, {"no trace.json", "finished trace"});
}

TEST(Info, TellsWhatASceneNeeds) {
    EXPECT_THAT(expect_done({"info", "box"}).out,
                testing::AllOf(HasSubstr("scene      box"), HasSubstr("needed")));
    expect_refused(bad_usage, {"info", "bx"}, {"\"bx\"", "\"box\""});
}

class Chart : public testing::Test {
protected:
    void SetUp() override {
        expect_done({"replay", box_trace(), "--order", "naive", "tiled:tile=4", "tiled:tile=8",
                     "hilbert:tile=4", "hilbert:tile=8", "--cache", "4K:128:8", "--csv", csv_.string()});
    }
    std::vector<std::string> words(const std::vector<std::string>& more = {}) const {
        return std::vector<std::string>{"chart", csv_.string(), "-o", charts_.string()} + more;
    }
    const Scratch scratch_;
    const fs::path csv_ = scratch_ / "rows.csv", charts_ = scratch_ / "charts";
};

TEST_F(Chart, DrawsTheRowsOfAReplay) {
    expect_done(words({"--kind", "traffic-by-tile"}));
    EXPECT_THAT(content(charts_ / "traffic-by-tile.svg"), HasSubstr("<svg"));
    EXPECT_EQ(content(charts_ / "traffic-by-tile.png").substr(1, 3), "PNG");
}

TEST_F(Chart, ForeignTextLeavesThePictureWellFormed) {
    std::string rows = content(csv_);
    const std::string foreign = "\nb\x1b[31m\xff<x&,";
    for (std::size_t at = 0; (at = rows.find("\nbox,", at)) != rows.npos; at += foreign.size())
        rows.replace(at, 5, foreign);
    write(csv_, rows);
    expect_done(words({"--kind", "traffic-by-tile"}));
    const std::string svg = content(charts_ / "traffic-by-tile.svg");
    EXPECT_THAT(svg, HasSubstr("b [31m\xef\xbf\xbd&lt;x&amp;"));
    EXPECT_EQ(std::count_if(svg.begin(), svg.end(),
                            [](char c) { return c >= 0 && c < ' ' && c != '\n' && c != '\t' && c != '\r'; }),
              0);
    EXPECT_EQ(svg.find('\xff'), svg.npos);
}

TEST_F(Chart, WhatTheRowsDoNotAllowIsSaid) {
    // Without a kind it is no error that one cache size makes no chart over sizes.
    EXPECT_THAT(expect_done(words()).out, HasSubstr("traffic-by-cache: not drawn"));
    const Outcome outcome = regather(words({"--kind", "traffic-by-cache", "--force"}));
    EXPECT_EQ(outcome.exit_code, bad_data);
    EXPECT_THAT(outcome.err, testing::StartsWith("regather: traffic-by-cache: not drawn"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

TEST_F(Chart, ExistingOnesAreReplacedOnlyByForce) {
    fs::create_directories(charts_);
    write(charts_ / "traffic-by-tile.svg", "precious");
    expect_refused(bad_usage, words({"--kind", "traffic-by-tile"}), {"traffic-by-tile.svg", "--force"});
    EXPECT_EQ(contents(charts_), (std::map<std::string, std::string>{{"traffic-by-tile.svg", "precious"}}));
    expect_done(words({"--kind", "traffic-by-tile", "--force"}));
}

TEST_F(Chart, TheBestUnderABudgetAreATableAndRows) {
    const std::string front = (scratch_ / "front.csv").string();
    const std::vector<std::string> asked = words({"--kind", "best-under-budget", "--front", front});
    EXPECT_THAT(expect_done(asked).out,
                testing::AllOf(HasSubstr("4 KiB, 128 B lines, 8-way"), HasSubstr("hilbert:tile=8,bits=16"),
                               HasSubstr("on the chip"), HasSubstr("front.csv")));
    // Every row on the front stands among those of the replay; the whole of naive's costs nothing.
    const auto all = results::read_csv(csv_), best = results::read_csv(front);
    ASSERT_GE(best.size(), 2u);
    EXPECT_EQ(best.back().parameters, "hilbert:tile=8,bits=16");
    for (const results::Row& row : best)
        EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const results::Row& other) {
            return other.parameters == row.parameters && other.traffic_bytes == row.traffic_bytes;
        }));
    expect_refused(bad_usage, asked, {"best-under-budget.svg", "--force"});
    fs::remove_all(charts_);
    expect_refused(bad_usage, asked, {"front.csv", "--force"});
    expect_refused(bad_usage, words({"--kind", "traffic-by-tile", "--front", front, "--force"}),
                   {"--front", "best-under-budget"});
}

TEST_F(Chart, ADamagedCsvIsRefusedWithTheLine) {
    const std::string whole = content(csv_);
    write(csv_, whole.substr(0, whole.size() - 40));
    expect_refused(bad_data, words(), {"rows.csv", "line 6"});
    EXPECT_FALSE(fs::exists(charts_));
    expect_refused(bad_data, {"chart", (scratch_ / "none.csv").string(), "-o", charts_.string()},
                   {"none.csv"});
    expect_refused(bad_usage, words({"--kind", "traffic-by-tiles"}), {"traffic-by-tiles", "traffic-by-tile"});
    expect_refused(bad_usage, words({"--cache", "128K"}), {"128K", "SIZE:LINE:WAYS"});
}

TEST(Cachesim, AnAddressTraceBecomesATable) {
    const Scratch scratch;
    write_column<std::uint64_t>(scratch / "addresses.npy", std::vector<std::uint64_t>{0, 64, 0, 128});
    const std::vector<std::string> words{
        "cachesim", (scratch / "addresses.npy").string(), "--size", "128", "--line", "64", "--ways",
        "1,full"};
    EXPECT_EQ(
        expect_done(words).out,
        "policy,size_bytes,line_bytes,ways,accesses,hits,misses,compulsory,capacity,conflict,writebacks,"
        "writes_through,traffic_bytes,write,write_miss,index,seed\n"
        "lru,128,64,1,4,1,3,3,0,0,0,0,192,back,allocate,modulo,\n"
        "lru,128,64,full,4,1,3,3,0,0,0,0,192,back,allocate,modulo,\n");
    write(scratch / "notes.din", "0 0\r1 40\r0 4 x\r");
    const Outcome noted = regather(
        {"cachesim", (scratch / "notes.din").string(), "--size", "1K", "--line", "64", "--ways", "1"});
    EXPECT_NE(noted.out.find("lru,1024,64,1,3,1,2,"), std::string::npos) << noted.out;
    EXPECT_NE(noted.err.find("notes.din: line 3: \"x\" behind the address is not read\n"), std::string::npos)
        << noted.err;
    write(scratch / "program.din", "0 0\n0 zero\n");
    expect_refused(
        bad_data,
        {"cachesim", (scratch / "program.din").string(), "--size", "1K", "--line", "64", "--ways", "1"},
        {"program.din", "zero"});
}

}  // namespace
}  // namespace regather::cli
