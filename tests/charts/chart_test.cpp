#include "charts/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "charts/scale.h"
#include "tests/charts/drawing.h"
#include "tests/results/folder.h"
#include "tests/results/rows.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::charts {
namespace {

using namespace results;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// The paper's Figure 4 in miniature: two tile sizes, three orderings, two caches, two numbers of bins.
std::vector<Row> figure() {
    std::vector<Row> rows = {
        made_row("naive", {}, {}, 211000000000),           made_row("direction-binned", 16, 16, 36000000000),
        made_row("direction-binned", 64, 16, 52000000000), made_row("direction-binned", 16, 4, 63000000000),
        made_row("hilbert", 16, {}, 11000000000),          made_row("hilbert", 64, {}, 2200000000),
        made_row("hilbert", 16, {}, 14000000000),          made_row("hilbert", {}, {}, 15000000),
    };
    rows[6].cache_bytes = 64 * 1024;
    for (Row& row : rows) {
        row.compulsory_bytes = 12000000;
        row.key_ops = row.ordering == "naive" ? 0 : row.bins ? *row.bins * *row.bins * 6000 : 127000;
        row.buffered_bytes = row.ordering == "naive" ? 0 : row.tile ? *row.tile * *row.tile * 48 : 734003200;
    }
    return rows;
}

Chart composed(std::string_view name, const std::vector<Row>& rows, const ChartOptions& options = {}) {
    return compose(name, results::Rows(rows), options);
}

/// The data block of the curve `label` in panel `panel`, its numbers as written.
std::string data(const Chart& chart, const std::string& label, int panel = 0) {
    return data_of(chart, "$line_" + std::to_string(panel), label);
}

TEST(Chart, TrafficByTileHoldsThePointsInGigabytes) {
    const Chart chart = composed("traffic-by-tile", figure());
    EXPECT_EQ(data(chart, "Direction bins 16×16"), "16 36\n64 52\n");
    EXPECT_EQ(data(chart, "Hilbert"), "16 11\n64 2.2\n");
    // A level line from edge to edge: past the first and the last tile size.
    const std::string level = data(chart, "Naive");
    double from = 0, to = 0, left = 0, right = 0;
    ASSERT_EQ(std::sscanf(level.c_str(), "%lf %lf %lf %lf", &from, &left, &to, &right), 4) << level;
    EXPECT_LT(from, 16);
    EXPECT_GT(to, 64);
    EXPECT_EQ(left, 211);
    EXPECT_EQ(right, 211);
    EXPECT_THAT(data(chart, "Hilbert, whole image"), HasSubstr(" 0.015\n"));

    const std::string text = script(chart, Picture::svg);
    EXPECT_THAT(text, HasSubstr("'traffic from memory to cache [GB]'"));
    EXPECT_THAT(text, HasSubstr("'tile edge [pixels]'"));
    EXPECT_THAT(text, HasSubstr("('16' 16, '64' 64)"));
    EXPECT_THAT(text, HasSubstr("set logscale x\n"));
    EXPECT_THAT(text, HasSubstr("set logscale y\n"));
    EXPECT_THAT(data(chart, "Compulsory: each line once"), HasSubstr(" 0.012\n"));
    EXPECT_THAT(text, HasSubstr("set label 'Compulsory: each line once'"));
    EXPECT_THAT(chart.caption, testing::Eq("room · 1.00 k queries · 128 KiB cache, 128 B lines, 8-way LRU · "
                                           "left-balanced-kd · heap-20"));
    // The legend runs from the top of the picture downwards.
    const auto entry = [&](const char* label) { return text.find(std::string("set label '") + label); };
    EXPECT_LT(entry("Naive"), entry("Direction bins 16×16"));
    EXPECT_LT(entry("Direction bins 16×16"), entry("Hilbert'"));
    EXPECT_LT(entry("Hilbert'"), entry("Hilbert, whole image"));
}

TEST(Chart, TrafficByCacheHoldsTilesNearSixteen) {
    const Chart chart = composed("traffic-by-cache", figure());
    EXPECT_EQ(data(chart, "Hilbert, 16×16 tiles"), "65536 14\n131072 11\n");
    EXPECT_EQ(data(chart, "Naive"), "131072 211\n");
    EXPECT_THAT(script(chart, Picture::svg), HasSubstr("('64' 65536, '128' 131072)"));
    EXPECT_THAT(script(chart, Picture::svg), HasSubstr("'cache size [KiB]'"));
    EXPECT_THAT(chart.caption, HasSubstr("· 128 B lines, 8-way LRU ·"));
}

TEST(Chart, SmallTrafficGetsASmallerUnit) {
    std::vector<Row> rows = {made_row("tiled", 8, {}, 999999999), made_row("tiled", 16, {}, 2000)};
    EXPECT_EQ(data(composed("traffic-by-tile", rows), "Tiled"), "8 999.999999\n16 0.002\n");
    EXPECT_THAT(script(composed("traffic-by-tile", rows), Picture::svg), HasSubstr("[MB]"));
}

TEST(Chart, CostByTileHasOperationsPerQueryAboveBufferedBytes) {
    const Chart chart = composed("cost-by-tile", figure());
    EXPECT_EQ(data(chart, "Hilbert", 0), "16 127\n64 127\n");
    EXPECT_EQ(data(chart, "Hilbert", 1), "16 12288\n64 196608\n");
    EXPECT_EQ(data(chart, "Direction bins 16×16", 0), "16 1536\n64 1536\n");
    // A log axis has no 0: what costs nothing is named, not drawn.
    EXPECT_EQ(data(chart, "Naive", 0), "absent");
    const std::string text = script(chart, Picture::svg);
    EXPECT_THAT(text, HasSubstr("'No computation: Naive'"));
    EXPECT_THAT(text, HasSubstr("'Nothing buffered: Naive'"));
    EXPECT_THAT(text, HasSubstr("'key operations per query'"));
    EXPECT_THAT(text, HasSubstr("'10 kB' 10000"));
    EXPECT_THAT(text, Not(HasSubstr("set label 'Naive'")));
}

TEST(Chart, CostByBinsRunsOverDirectionBinnedOrderingsOnly) {
    const Chart chart = composed("cost-by-bins", figure());
    EXPECT_EQ(data(chart, "Direction bins, 16×16 tiles", 0), "4 96\n16 1536\n");
    EXPECT_EQ(data(chart, "Direction bins, 16×16 tiles", 1), "4 12288\n16 12288\n");
    EXPECT_THAT(script(chart, Picture::svg), HasSubstr("'4×4' 4, '16×16' 16"));
    EXPECT_THAT(script(chart, Picture::svg), Not(HasSubstr("Hilbert")));
}

TEST(Chart, WithoutRowsForItIsSkippedWithAReason) {
    EXPECT_EQ(composed("traffic-by-tile", {}).skipped, "no row has cache_bytes, line_bytes and ways");
    const std::vector<Row> naive = {made_row("naive", {}, {}, 211)};
    EXPECT_EQ(composed("traffic-by-tile", naive).skipped,
              "needs at least 2 tile sizes; found 0 with the cache 128 KiB, 128 B lines, 8-way");
    EXPECT_EQ(composed("traffic-by-cache", naive).skipped,
              "needs at least 2 cache sizes; found 1 with the cache 128 KiB, 128 B lines, 8-way");
    EXPECT_EQ(composed("cost-by-bins", naive).skipped,
              "needs at least 2 numbers of bins; found 0 with the cache 128 KiB, 128 B lines, 8-way");
    ChartOptions other;
    other.cache = Geometry{4096, 64, 0};
    EXPECT_EQ(composed("traffic-by-tile", figure(), other).skipped,
              "no row has the cache 4 KiB, 64 B lines, fully associative");
    std::vector<Row> uncosted = {made_row("tiled", 8, {}, 1), made_row("tiled", 16, {}, 1)};
    EXPECT_EQ(composed("cost-by-tile", uncosted).skipped,
              "no row has key_ops with queries, or buffered_bytes, above 0");
    for (Row& row : uncosted) row.traffic_bytes = 0;
    EXPECT_EQ(composed("traffic-by-tile", uncosted).skipped, "no traffic above 0");
}

TEST(Chart, AnUnknownKindIsRefusedWithTheKnownOnes) {
    try {
        chart_kind("pie");
        FAIL();
    } catch (const trace::UsageError& error) {
        EXPECT_STREQ(
            error.what(),
            "chart \"pie\" is not known, expected one of traffic-by-tile, traffic-by-cache, cost-by-tile, "
            "cost-by-bins, misses-by-class, net-benefit, best-under-budget, traffic-by-frame, "
            "traffic-by-layout, traffic-by-technique, traffic-by-depth, timeline, sampling-error, "
            "frame-traffic, error-by-time, error-by-render-time, time-to-error, efficiency, bias-by-photons, "
            "bias-by-k, computation, stability");
    }
}

TEST(Chart, TicksAreRoundAndEnclose) {
    EXPECT_THAT(log_ticks(3, 60), ElementsAre(2, 5, 10, 20, 50, 100));
    EXPECT_THAT(log_ticks(1, 100), ElementsAre(1, 2, 5, 10, 20, 50, 100));
    EXPECT_THAT(log_ticks(0.03, 211), ElementsAre(0.01, 0.1, 1, 10, 100, 1000));
    EXPECT_THAT(log_ticks(7, 7), ElementsAre(5, 10));
}

TEST(Chart, EveryKindBecomesTwoPicturesWithItsLabels) {
    const Folder folder;
    const auto drawn = write_charts(folder.path(), Rows(figure()), {}, {});
    ASSERT_EQ(drawn.size(), 10u);
    EXPECT_EQ(drawn[4].skipped, "no row has compulsory, capacity and conflict");
    EXPECT_EQ(drawn[5].kind, "net-benefit");
    for (const Drawn& one : std::span(drawn).first(4)) {
        ASSERT_EQ(one.files.size(), 2u) << one.kind << one.skipped;
        const std::string svg = trace::read_file(one.files[0]), png = trace::read_file(one.files[1]);
        EXPECT_THAT(svg, HasSubstr("<title>" + std::string(chart_kind(one.kind).title) + "</title>"));
        EXPECT_THAT(svg, HasSubstr("Direction bins"));
        EXPECT_THAT(svg, Not(HasSubstr("GNUPLOT")));
        EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
        EXPECT_GT(png.size(), 10000u);
    }
    EXPECT_EQ(drawn[0].files[0].filename(), "traffic-by-tile.svg");
    EXPECT_THAT(trace::read_file(drawn[0].files[0]), HasSubstr("tile edge [pixels]"));
    EXPECT_THAT(trace::read_file(drawn[0].files[0]), HasSubstr("traffic from memory to cache [GB]"));
}

TEST(Chart, TheSameRowsGiveTheSameBytes) {
    const Chart a = composed("traffic-by-tile", figure()), b = composed("traffic-by-tile", figure());
    EXPECT_EQ(script(a, Picture::svg), script(b, Picture::svg));
    EXPECT_EQ(render(a, Picture::svg), render(b, Picture::svg));
    EXPECT_EQ(render(a, Picture::png), render(b, Picture::png));
}

TEST(Chart, NamesFromOutsideCannotBreakTheScript) {
    std::vector<Row> rows = {made_row("it's `id` \\ {/x} <b>&", 8, {}, 5000),
                             made_row("it's `id` \\ {/x} <b>&", 16, {}, 6000),
                             made_row("a\nexit 3\n", {}, {}, 7000)};
    for (Row& row : rows) row.scene = "ro'om\nEOD";
    const std::string svg = render(composed("traffic-by-tile", rows), Picture::svg);
    EXPECT_THAT(svg, HasSubstr(">it’s `id` \\ {/x} &lt;b>&amp;<"));
    EXPECT_THAT(svg, HasSubstr("a exit 3 "));
    EXPECT_THAT(svg, HasSubstr(">ro’om EOD · "));
}

}  // namespace
}  // namespace regather::charts
