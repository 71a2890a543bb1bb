// The charts of classes, budgets, depths, time and sampling: the script holds the very points of the rows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "charts/figure.h"
#include "tests/charts/drawing.h"
#include "tests/results/rows.h"
#include "trace/error.h"

namespace regather::charts {
namespace {

using namespace results;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Rows only(const std::vector<Row>& rows) {
    return Rows(rows);
}

Row classed(std::string ordering, Count tile, std::uint64_t compulsory, std::uint64_t capacity,
            std::uint64_t conflict) {
    Row row = made_row(std::move(ordering), tile, {}, 128 * (compulsory + capacity + conflict));
    row.compulsory = compulsory;
    row.capacity = capacity;
    row.conflict = conflict;
    row.misses = compulsory + capacity + conflict;
    return row;
}

TEST(MissesByClass, StacksSharesAndPrintsTheTotals) {
    std::vector<Row> rows = {classed("naive", {}, 100, 700, 200), classed("hilbert", 16, 30, 10, 0),
                             classed("hilbert", 64, 1, 1, 0), classed("naive", {}, 9, 0, 0)};
    rows[3].cache_bytes = 4096;
    const Chart chart = compose("misses-by-class", only(rows));
    const std::string text = script(chart, Picture::svg);
    // left, right, bottom, top; the first row is the upper bar.
    EXPECT_THAT(text, HasSubstr("$box_0_0 << EOD\n0 10 1.08 1.54\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_1 << EOD\n10 80 1.08 1.54\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_2 << EOD\n80 100 1.08 1.54\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_3 << EOD\n0 75 0.08 0.54\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_4 << EOD\n75 100 0.08 0.54\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_5 << EOD\n100 100 0.08 0.54\n"));
    EXPECT_THAT(text, Not(HasSubstr("$box_0_6")));  // other tiles, another cache
    for (const char* label : {"'1.00 k misses'", "'40 misses'", "'Naive'", "'Hilbert, 16×16 tiles'", "'70 %'",
                              "'share of misses [%]'", "'compulsory: first touch'"})
        EXPECT_THAT(text, HasSubstr(label));
    EXPECT_EQ(chart.caption,
              "room · 1.00 k queries · 128 KiB cache, 128 B lines, 8-way LRU · left-balanced-kd · heap-20");
    ChartOptions small;
    small.cache = Geometry{4096, 128, 8};
    EXPECT_THAT(script(compose("misses-by-class", only(rows), small), Picture::svg), HasSubstr("'9 misses'"));
}

TEST(MissesByClass, ClassesMustSumToTheMissesUnlessSampled) {
    std::vector<Row> rows = {classed("naive", {}, 1, 2, 3)};
    rows[0].misses = 7;
    EXPECT_THROW(compose("misses-by-class", only(rows)), trace::DataError);
    rows[0].set_sampling = 16;
    EXPECT_EQ(compose("misses-by-class", only(rows)).skipped, "");
    rows[0].conflict.reset();
    EXPECT_EQ(compose("misses-by-class", only(rows)).skipped, "no row has compulsory, capacity and conflict");
}

FrameRow framed(std::string run, std::string part, std::string level, std::uint64_t bytes_in) {
    FrameRow row;
    row.scene = "room";
    row.unit = "pixel";
    row.run = std::move(run);
    row.part = std::move(part);
    row.ordering = row.parameters = "naive";
    row.machine = "mine";
    row.level = std::move(level);
    row.region = "nodes";
    row.bytes_in = bytes_in;
    return row;
}

TEST(FrameTraffic, StacksThePartsOfEachRunAtTheLastLevel) {
    std::vector<FrameRow> rows{
        framed("together", "eye rays", "L1", 9000), framed("together", "eye rays", "L2", 500),
        framed("together", "photons", "L2", 3000), framed("apart", "eye rays", "L2", 700),
        framed("apart", "photons", "L2", 2000)};
    rows[2].bytes_out = 64;
    rows.push_back(rows[2]);  // another region of the same part
    rows.back().region = "photons";
    std::rotate(rows.begin() + 3, rows.end() - 1, rows.end());
    FrameRow dram = framed("apart", "photons", "dram", 0);
    dram.bytes_in.reset();
    dram.bursts_read = 7;
    rows.push_back(dram);
    const Chart chart = compose("frame-traffic", Rows(rows));
    const std::string text = script(chart, Picture::svg);
    // left, right, bottom, top; the first run is the upper bar.
    EXPECT_THAT(text, HasSubstr("$box_0_0 << EOD\n0 500 1.08 1.54\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_1 << EOD\n500 6628 1.08 1.54\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_2 << EOD\n0 700 0.08 0.54\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_3 << EOD\n700 2700 0.08 0.54\n"));
    EXPECT_THAT(text, Not(HasSubstr("$box_0_4")));
    for (const char* label :
         {"'pixel, together'", "'pixel, apart'", "'6.63 kB'", "'2.70 kB'", "'eye rays'", "'photons'"})
        EXPECT_THAT(text, HasSubstr(label));
    EXPECT_EQ(chart.caption, "room · mine · naive · unit of a turn, then how it ran");
    rows.back() = framed("apart", "gather rays", "L2", 5);
    rows.back().parameters = "hilbert";
    EXPECT_THAT(script(compose("frame-traffic", Rows(rows)), Picture::svg),
                HasSubstr("'pixel, apart, naive, hilbert'"));
    EXPECT_EQ(compose("frame-traffic", Rows(std::vector<FrameRow>{dram})).skipped,
              "needs rows of a frame's traces, together and apart");
}

TEST(TrafficByLayout, ALineAStructureAndLayoutWithItsFloor) {
    std::vector<Row> rows = {made_row("naive", {}, {}, 9000), made_row("hilbert", {}, {}, 700),
                             made_row("naive", {}, {}, 5000), made_row("hilbert", {}, {}, 90)};
    for (Row& row : rows) row.compulsory_bytes = 80;
    for (std::size_t r = 2; r < 4; ++r) rows[r].layout = "depth-first-20";
    EXPECT_EQ(compose("traffic-by-layout", only({rows[0], rows[1]})).skipped,
              "needs at least 2 structures or layouts");
    const Chart chart = compose("traffic-by-layout", only(rows));
    const std::string text = script(chart, Picture::svg);
    for (const char* part :
         {"'left-balanced-kd, heap-20'", "'left-balanced-kd, depth-first-20'", "\n9000 1.3\n", "\n700 1.3\n",
          "\n5000 0.3\n", "\n90 0.3\n", "\n80 0.1\n80 0.5\n", "'Naive'", "'floor: each line fetched once'"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_EQ(chart.caption, "room · 1.00 k queries · 128 KiB cache, 128 B lines, 8-way");
    EXPECT_THAT(compose("traffic-by-layout", {}).skipped, HasSubstr("no row"));
}

TEST(TrafficByTechnique, ALineACaptureByWhatItWasAsked) {
    std::vector<Row> rows = {made_row("naive", {}, {}, 9000), made_row("naive", {}, {}, 5000),
                             made_row("naive", {}, {}, 4000)};
    rows[1].sampling = "combined:rows=4";
    rows[2].sampling = rows[1].sampling;
    rows[2].irradiance_cache = "bounded:tolerance=20";
    EXPECT_EQ(compose("traffic-by-technique", only({rows[0]})).skipped,
              "needs at least 2 strategies of sampling, or captures with and without a cache of irradiance");
    EXPECT_EQ(compose("traffic-by-layout", only(rows)).skipped, "needs at least 2 structures or layouts");
    const std::string text = script(compose("traffic-by-technique", only(rows)), Picture::svg);
    for (const char* part : {"'brdf, no cache'", "'combined, no cache'", "'combined, bounded cache'",
                             "\n9000 2.3\n", "\n5000 1.3\n", "\n4000 0.3\n"})
        EXPECT_THAT(text, HasSubstr(part));
}

TEST(TrafficByLayout, TellsAnOrderingInTilesFromTheWholeImage) {
    std::vector<Row> rows = {made_row("hilbert", 16, {}, 5000), made_row("hilbert", {}, {}, 90),
                             made_row("hilbert", 16, {}, 4000), made_row("hilbert", {}, {}, 70)};
    for (std::size_t r = 2; r < 4; ++r) rows[r].layout = "depth-first-20";
    const std::string text = script(compose("traffic-by-layout", only(rows)), Picture::svg);
    for (const char* part : {"pt 7", "pt 6", "'Hilbert, 16×16 tiles'", "'Hilbert, whole image'"})
        EXPECT_THAT(text, HasSubstr(part));
}

TEST(TrafficByLayout, AMarkIsOfOneOrderingWhereAStructureLacksOthers) {
    std::vector<Row> rows = {made_row("hilbert", 16, {}, 5000), made_row("hilbert", {}, {}, 90),
                             made_row("hilbert", {}, {}, 70)};
    rows[2].layout = "depth-first-20";
    const std::string text = script(compose("traffic-by-layout", only(rows)), Picture::svg);
    const auto times = [&](std::string_view part) {
        std::size_t count = 0;
        for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
        return count;
    };
    // Each mark is drawn once more in the legend.
    EXPECT_EQ(times("pt 7"), 2u);
    EXPECT_EQ(times("pt 6"), 3u);
}

Row netted(std::string ordering, std::uint64_t cache, std::uint64_t buffered, std::uint64_t traffic,
           std::uint64_t buffers) {
    Row row = made_row(std::move(ordering), {}, {}, traffic);
    row.cache_bytes = cache;
    row.buffered_bytes = buffered;
    row.onchip_bytes = 1 << 20;
    row.buffer_traffic_bytes = buffers;
    return row;
}

TEST(NetBenefit, DrawsTheEnvelopesAndNamesTheWinners) {
    const std::vector<Row> rows = {netted("naive", 16384, 0, 90000000000, 0),
                                   netted("naive", 65536, 0, 80000000000, 0),
                                   netted("hilbert", 16384, 16384, 30000000000, 0),
                                   netted("hilbert", 65536, 2097152, 5000000000, 7000000000)};
    const Chart chart = compose("net-benefit", only(rows));
    EXPECT_EQ(data_of(chart, "$line_1", "Naive"), "16384 90\n65536 80\n98304 80\n");
    EXPECT_EQ(data_of(chart, "$line_1", "Hilbert"), "32768 30\n65536 12\n98304 12\n");
    const std::string text = script(chart, Picture::svg);
    EXPECT_THAT(text, HasSubstr("$box_0_0 << EOD\n16384 32768 0 1\n"));
    EXPECT_THAT(text, HasSubstr("$box_0_1 << EOD\n32768 98304 0 1\n"));
    EXPECT_THAT(text, HasSubstr("'net traffic [GB]'"));
    EXPECT_THAT(text, HasSubstr("'on-chip budget: cache and buffers [KiB]'"));
    EXPECT_THAT(text, HasSubstr("'16' 16384, '32' 32768, '64' 65536"));
    EXPECT_THAT(text, HasSubstr("set label 'Hilbert' at 56755"));  // the band names its winner
    // The edge of the picture is no measurement: no marker there.
    EXPECT_THAT(text, HasSubstr("$line_1_1 every ::0::1 using 1:2 with points"));
}

TEST(NetBenefit, ComparesOneSettingOnly) {
    std::vector<Row> rows = {netted("naive", 16384, 0, 9, 0), netted("naive", 65536, 0, 8, 0)};
    EXPECT_EQ(compose("net-benefit", only(rows)).skipped, "");
    rows[1].scene = "box";
    EXPECT_EQ(compose("net-benefit", only(rows)).skipped,
              "needs rows of one scene, frame, structure, layout and policy");
    rows[1] = netted("naive", 16384, 0, 9, 0);
    EXPECT_THAT(compose("net-benefit", only(rows)).skipped,
                HasSubstr("found 1 budget with 128 B lines, 8-way"));
    for (Row& row : rows) row.buffer_traffic_bytes.reset();
    EXPECT_THAT(compose("net-benefit", only(rows)).skipped,
                HasSubstr("buffer_traffic_bytes or reorder_bytes"));
}

TEST(BestUnderBudget, DrawsAStepLineForEachCacheAndMarksWhoTakesTheSteps) {
    const std::vector<Row> rows = {
        netted("naive", 16384, 0, 90000000000, 0),
        netted("naive", 65536, 0, 80000000000, 0),
        netted("direction-binned", 65536, 768, 40000000000, 0),
        netted("hilbert", 65536, 16384, 30000000000, 0),
        netted("morton", 65536, 20000, 31000000000, 0),
        with_parameters(netted("hilbert", 65536, 2097152, 5000000000, 7000000000), "hilbert:bits=10")};
    const Chart chart = compose("best-under-budget", only(rows));
    ASSERT_EQ(chart.skipped, "");
    // On the chip. What needs less than 1 KiB stands at the left end; a line goes on to 64 MiB.
    EXPECT_EQ(data_of(chart, "$line_0", "16 KiB cache"), "1024 90\n67108864 90\n");
    EXPECT_EQ(data_of(chart, "$line_0", "64 KiB cache"), "1024 40\n16384 40\n16384 30\n67108864 30\n");
    EXPECT_EQ(data_of(chart, "$line_0", "Naive"), "1024 90\n");
    EXPECT_EQ(data_of(chart, "$line_0", "Direction bins"), "1024 40\n");
    EXPECT_EQ(data_of(chart, "$line_0", "Hilbert"), "16384 30\n");
    // Through memory: 12 GB for the whole chip of 1 MiB.
    EXPECT_EQ(data_of(chart, "$line_1", "64 KiB cache"),
              "1024 40\n16384 40\n16384 30\n1048576 30\n1048576 12\n67108864 12\n");
    EXPECT_EQ(data_of(chart, "$line_1", "Hilbert"), "16384 30\n1048576 12\n");
    EXPECT_EQ(data_of(chart, "$line_0", "Morton"), "absent");
    EXPECT_EQ(chart.caption, "room · 1.00 k queries · 128 B lines, 8-way LRU · left-balanced-kd · heap-20");
}

TEST(BestUnderBudget, SaysWhyItIsNotDrawn) {
    std::vector<Row> rows = {netted("naive", 16384, 0, 9, 0), netted("naive", 65536, 0, 8, 0)};
    EXPECT_THAT(compose("best-under-budget", only(rows)).skipped, HasSubstr("found no two that differ"));
    rows.push_back(netted("hilbert", 65536, 4096, 7, 0));
    EXPECT_EQ(compose("best-under-budget", only(rows)).skipped, "");
    ChartOptions other;
    other.cache = Geometry{65536, 64, 8};
    EXPECT_EQ(compose("best-under-budget", only(rows), other).skipped, "no row has 64 B lines, 8-way");
    rows[0].scene = "box";
    EXPECT_EQ(compose("best-under-budget", only(rows)).skipped,
              "needs rows of one scene, frame, structure, layout and policy");
    EXPECT_THAT(compose("best-under-budget", {}).skipped, HasSubstr("at least 2 states"));
}

DetailRow level(std::string ordering, Count depth, std::uint64_t traffic, std::uint64_t used) {
    DetailRow row;
    row.scene = "room";
    row.ordering = std::move(ordering);
    row.cache_bytes = 128 * 1024;
    row.line_bytes = 128;
    row.ways = 8;
    row.region = depth ? "photons" : "reorder_buffer";
    row.tree_depth = depth;
    row.misses = traffic / 128;
    row.traffic_bytes = traffic;
    row.used_bytes = used;
    return row;
}

TEST(TrafficByDepth, HasTrafficAboveOverfetch) {
    std::vector<DetailRow> rows = {level("naive", 2, 1280, 200), level("naive", 0, 128, 128),
                                   level("naive", 1, 0, 0),      level("naive", {}, 99968, 10),
                                   level("hilbert", 0, 256, 0),  level("hilbert", 1, 512, 128)};
    rows.back().tile = rows[4].tile = 16;
    const Chart chart = compose("traffic-by-depth", Rows(rows));
    EXPECT_EQ(data_of(chart, "$line_0", "Naive"), "0 128\n2 1280\n");
    EXPECT_EQ(data_of(chart, "$line_1", "Naive"), "0 1\n2 6.4\n");
    EXPECT_EQ(data_of(chart, "$line_0", "Hilbert, 16×16 tiles"), "0 256\n1 512\n");
    EXPECT_EQ(data_of(chart, "$line_1", "Hilbert, 16×16 tiles"), "1 4\n");
    EXPECT_THAT(script(chart, Picture::svg), HasSubstr("'depth in the tree (root 0)'"));
    EXPECT_EQ(chart.caption, "room · 128 KiB cache, 128 B lines, 8-way");
    EXPECT_EQ(compose("traffic-by-depth", {}).skipped,
              "needs rows by region and tree depth, with traffic_bytes");
    ChartOptions other;
    other.cache = Geometry{4096, 64, 0};
    EXPECT_EQ(compose("traffic-by-depth", Rows(rows), other).skipped,
              "no row has the cache 4 KiB, 64 B lines, fully associative");
}

TimelineRow slice(std::string ordering, std::uint64_t first, std::uint64_t queries, std::uint64_t misses) {
    TimelineRow row;
    row.scene = "room";
    row.ordering = std::move(ordering);
    row.cache_bytes = 128 * 1024;
    row.line_bytes = 128;
    row.ways = 8;
    row.first_query = first;
    row.queries = queries;
    row.misses = misses;
    return row;
}

TEST(Timeline, HasMissesPerQueryAtTheMiddleOfEachSlice) {
    const std::vector<TimelineRow> rows = {slice("naive", 40, 60, 600), slice("naive", 0, 40, 100),
                                           slice("morton", 0, 50, 50),  slice("morton", 50, 25, 0),
                                           slice("morton", 75, 25, 10), slice("hilbert", 0, 100, 0)};
    const Chart chart = compose("timeline", Rows(rows));
    EXPECT_EQ(data_of(chart, "$line_0", "Naive"), "20 2.5\n70 10\n");
    // No place for 0 on a log axis: the curve breaks off there.
    EXPECT_EQ(data_of(chart, "$line_0", "Morton, whole image"), "25 1\n\n87.5 0.4\n");
    const std::string text = script(chart, Picture::svg);
    EXPECT_THAT(text, HasSubstr("'No misses: Hilbert, whole image'"));
    EXPECT_THAT(text, HasSubstr("'misses per query'"));
    EXPECT_THAT(text, HasSubstr("set logscale y"));
    EXPECT_THAT(text, HasSubstr("set xrange [0:100]"));
}

SamplingRow sampled(std::string parameters, std::uint64_t rate, std::uint64_t misses, double seconds,
                    bool covered) {
    SamplingRow row;
    row.scene = "room";
    row.ordering = parameters.substr(0, parameters.find(':'));
    row.parameters = std::move(parameters);
    row.set_sampling = rate;
    row.misses = misses;
    row.exact_misses = 1000;
    row.covered = covered;
    row.seconds = seconds;
    return row;
}

TEST(SamplingError, HasErrorInPercentAgainstSecondsAndTheNominalLine) {
    const std::vector<SamplingRow> rows = {
        sampled("naive", 1, 1000, 50, true),          sampled("naive", 4, 1020, 10, true),
        sampled("naive", 2, 990, 20, true),           sampled("naive", 4, 980, 10, false),
        sampled("hilbert:tile=16", 2, 1004, 8, true), sampled("hilbert:tile=64", 2, 1003, 7, true),
        sampled("hilbert:tile=64", 4, 1000, 7, true)};
    const Chart chart = compose("sampling-error", Rows(rows));
    EXPECT_EQ(data_of(chart, "$line_0", "Naive"), "20 1\n10 2\n");
    EXPECT_EQ(data_of(chart, "$line_0", "Hilbert, 16×16 tiles"), "8 0.4\n");
    EXPECT_EQ(data_of(chart, "$line_0", "Hilbert, 64×64 tiles"), "7 0.3\n");
    EXPECT_EQ(data_of(chart, "$line_1", "Naive"), "20 100\n10 50\n");
    EXPECT_THAT(data_of(chart, "$line_1", "nominal 95 %"), testing::MatchesRegex("[0-9.]+ 95\n[0-9.]+ 95\n"));
    const std::string text = script(chart, Picture::svg);
    EXPECT_THAT(text, HasSubstr("set label '1/4' at 10,2 "));
    EXPECT_THAT(text, Not(HasSubstr("at 8,0.4 ")));  // of many curves only the uppermost bears the rates
    EXPECT_THAT(text, HasSubstr("'RMS error of misses [%]'"));
    EXPECT_EQ(chart.caption, "room · 1/4 ... 1/2 of the sets");
    EXPECT_THAT(compose("sampling-error", Rows(std::vector{rows[0]})).skipped, HasSubstr("above 0"));
}

TEST(Figure, ScalesEncloseTheirValues) {
    const double values[] = {3, 60};
    const Scale scale = log_scale(values, plain_number);
    EXPECT_LT(scale.low, 3);
    EXPECT_GT(scale.high, 60);
    EXPECT_THAT(scale.ticks, ElementsAre(testing::Pair(5, "5"), testing::Pair(10, "10"),
                                         testing::Pair(20, "20"), testing::Pair(50, "50")));
    const Scale linear = linear_scale(6.4, plain_number);
    EXPECT_THAT(linear.ticks, ElementsAre(testing::Pair(0, "0"), testing::Pair(2, "2"), testing::Pair(4, "4"),
                                          testing::Pair(6, "6"), testing::Pair(8, "8")));
    EXPECT_EQ(linear.high, 8);
    EXPECT_EQ(linear_scale(1, plain_number).high, 1);
}

TEST(Chart, TheKindsThatAreWantedAreThoseWithRows) {
    const std::vector<DetailRow> details = {level("naive", 0, 128, 128)};
    const std::vector<Row> rows = {made_row("naive", {}, {}, 1)};
    const auto names = [](const std::vector<const ChartKind*>& kinds) {
        std::vector<std::string_view> out;
        for (const ChartKind* kind : kinds) out.push_back(kind->name);
        return out;
    };
    EXPECT_THAT(names(wanted_kinds(Rows(details), {})), ElementsAre("traffic-by-depth"));
    EXPECT_THAT(names(wanted_kinds(only(rows), {})),
                ElementsAre("traffic-by-tile", "traffic-by-cache", "cost-by-tile", "cost-by-bins",
                            "misses-by-class", "net-benefit", "best-under-budget", "traffic-by-frame",
                            "traffic-by-layout", "traffic-by-technique"));
    const std::string asked[] = {"timeline"};
    EXPECT_THAT(names(wanted_kinds(only(rows), asked)), ElementsAre("timeline"));
    EXPECT_TRUE(wanted_kinds({}, {}).empty());
}

TEST(Chart, EveryFurtherKindBecomesAPictureWhateverTheNames) {
    const std::string name = "it's `id` \\ {/x} <b>&\nexit 3";
    std::vector<Row> rows = {classed(name, {}, 1, 2, 3), netted(name, 16384, 0, 9000, 0),
                             netted(name, 65536, 0, 80, 0),
                             with_parameters(netted(name, 65536, 4096, 70, 0), "x:bits=3")};
    std::vector<Row> elsewhere(2, rows[1]);
    elsewhere[1].layout = name;
    const std::vector<DetailRow> details = {level(name, 0, 128, 128), level(name, 1, 256, 128)};
    const std::vector<TimelineRow> slices = {slice(name, 0, 10, 10), slice(name, 10, 10, 20)};
    const std::vector<SamplingRow> runs = {sampled(name, 2, 990, 2, true), sampled(name, 4, 980, 1, true)};
    const Rows layouts(elsewhere);
    Rows all(rows);
    all.of<DetailRow>() = details;
    all.of<TimelineRow>() = slices;
    all.of<SamplingRow>() = runs;
    for (const char* kind : {"misses-by-class", "net-benefit", "best-under-budget", "traffic-by-layout",
                             "traffic-by-depth", "timeline", "sampling-error"}) {
        const Rows& given = kind == std::string_view("traffic-by-layout") ? layouts : all;
        const Chart chart = compose(kind, given);
        ASSERT_EQ(chart.skipped, "") << kind;
        EXPECT_EQ(chart.width, 440u);  // a column of a paper
        const std::string svg = render(chart, Picture::svg);
        EXPECT_THAT(svg, HasSubstr("it’s `id` \\ {/x} &lt;b>&amp; exit 3")) << kind;
        EXPECT_EQ(svg, render(compose(kind, given), Picture::svg));
        EXPECT_EQ(render(chart, Picture::png).substr(0, 4), "\x89PNG");
    }
}

}  // namespace
}  // namespace regather::charts
