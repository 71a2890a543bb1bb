// No text of a chart lies on another, over the rows that are committed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "charts/figure.h"
#include "charts/heat_map.h"
#include "charts/lettering.h"
#include "tests/charts/drawing.h"
#include "tests/charts/svg_text.h"

namespace regather::charts {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::filesystem::path source() {
    const char* folder = std::getenv("REGATHER_SOURCE_DIR");
    return folder == nullptr ? "." : folder;
}

void draw_all(const results::Rows& rows, const std::string& of, std::set<std::string_view>& drawn) {
    for (const ChartKind* kind : wanted_kinds(rows, {})) {
        const Chart chart = kind->compose(*kind, rows, {});
        if (!chart.skipped.empty()) continue;
        drawn.insert(kind->name);
        EXPECT_THAT(collisions(render(chart, Picture::svg)), IsEmpty()) << of << ' ' << kind->name;
    }
}

/// Draws each kind of chart that a file below the folder allows, and those of the folder `together`, looks
/// for collisions, and gives their names.
std::set<std::string_view> drawn_without_collisions(const std::filesystem::path& folder,
                                                    const std::filesystem::path& together = {}) {
    std::set<std::string_view> drawn;
    results::Rows joined;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source() / folder)) {
        if (entry.path().extension() != ".csv") continue;
        const std::string text = results::read_csv_text(entry.path());
        results::Rows rows;
        rows.add(text, entry.path().string());
        draw_all(rows, entry.path().string(), drawn);
        if (entry.path().parent_path().filename() == together) joined.add(text, entry.path().string());
    }
    draw_all(joined, together.string(), drawn);
    return drawn;
}

std::vector<std::string> collisions_of(const Chart& chart) {
    return collisions(render(chart, Picture::svg));
}

TEST(Layout, NoTextOfAnyKindOfChartLiesOnAnother) {
    EXPECT_EQ(drawn_without_collisions("results/guard", "asked").size(), chart_kinds().size());
}

TEST(Layout, NorOverTheRowsOfTheFigures) {
    for (const char* folder : {"results/figure4", "results/family", "results/sampling", "results/rays",
                               "results/structures", "results/budget", "results/computation"})
        EXPECT_GT(drawn_without_collisions(folder).size(), 0u) << folder;
}

TEST(Layout, AKeyThatIsTooLongTakesAnotherLine) {
    const auto chart_of = [](const std::string& label) {
        Panel panel;
        panel.up.scale = {false, 0, 1, {}};
        panel.bare = true;
        for (const std::string& key : {label, std::string("the other one")})
            panel.lines.push_back({.label = key, .colour = "#000000", .points = {{0, 0}, {1, 1}}});
        return draw({"title", "caption", {"across", {false, 0, 1, {}}}, {panel}});
    };
    // Words enough for two lines and a half.
    std::string label = "word";
    while (text_width(label, 12) < 2.5 * chart_of("x").width) label += " word";
    const Chart chart = chart_of(label), wide = chart_of(std::string(200, 'x'));
    EXPECT_EQ(chart.height, wide.height + 2 * 18);
    EXPECT_THAT(collisions_of(chart), IsEmpty());
}

TEST(Layout, AHeatMapHasRoomForItsTitlesAndItsScale) {
    std::vector<HeatMap> maps;
    for (const char* title : {"naive", "hilbert:tile=16", "direction-binned:tile=16,bins=16", "morton"})
        maps.push_back({title, {0, 5, 70, 123456789, 12, 3}});
    EXPECT_THAT(collisions_of(heat_map(maps, 3, 2, "room · 6 queries · 128 KiB, 128 B lines, 8-way")),
                IsEmpty());
}

TEST(Layout, AHeatMapOfOneRowOrColumnIsDrawn) {
    // A rectangle a pixel and some for the colours' bar: as many as of two rows or columns that are the same.
    const auto rectangles = [](std::uint32_t width, std::uint32_t height, std::vector<std::uint64_t> bytes) {
        const std::vector<HeatMap> maps{{"naive", std::move(bytes)}};
        const std::string svg = render(heat_map(maps, width, height, "queries"), Picture::svg);
        std::size_t count = 0;
        for (std::size_t at = svg.find("<polygon"); at != svg.npos; at = svg.find("<polygon", at + 1))
            ++count;
        return count;
    };
    EXPECT_EQ(rectangles(3, 1, {1, 5, 70}), rectangles(3, 2, {1, 5, 70, 1, 5, 70}));
    EXPECT_EQ(rectangles(1, 3, {1, 5, 70}), rectangles(2, 3, {1, 1, 5, 5, 70, 70}));
    EXPECT_EQ(rectangles(1, 1, {5}), rectangles(2, 2, {5, 5, 5, 5}));
    EXPECT_EQ(rectangles(2, 2, {5, 5, 5, 5}), rectangles(2, 3, {5, 5, 5, 5, 5, 5}) - 2);
}

Figure crowded() {
    Line curve;
    curve.label = "a curve";
    curve.colour = "#000000";
    curve.points = {{1, 1}, {10, 1000}};
    Panel panel;
    panel.up = {"a label that is longer than its panel is high, and some more of it", {true, 1, 1000, {}}};
    panel.up.scale.ticks = {{1, "1"}, {1000, "1000"}};
    panel.height = 120;
    panel.lines = {curve};
    panel.remark =
        "No computation: one; two with a long name; three; four, whole image; five; six, 16×16 tiles";
    Figure figure{"A title",
                  "room · and a caption that is long enough for a second line · and more of it · end",
                  {"across", {true, 1, 10, {}}},
                  {panel, panel}};
    for (double at = 1; at <= 10; at += 0.25) figure.across.scale.ticks.emplace_back(at, plain_number(at));
    for (int i = 0; i < 5; ++i) {
        curve.label = "curve " + std::string(static_cast<std::size_t>(i) * 20, 'w');
        figure.panels[0].lines.push_back(curve);
    }
    return figure;
}

TEST(Layout, LongTextsAreWrappedCutOrLeftAway) {
    EXPECT_THAT(collisions_of(draw(crowded())), IsEmpty());
}

// What the check itself sees: drawn by hand in gnuplot's way of writing.
TEST(Layout, TheCheckSeesTextsOnTextsAndOutsideAndUnderMarkers) {
    const auto text = [](double x, double y, const char* anchor, const char* words, const char* turned = "") {
        return fmt::format(
            "<g transform=\"translate({},{}){}\" stroke=\"none\" fill=\"black\" font-family=\"DejaVu "
            "Sans\" font-size=\"10.00\"  text-anchor=\"{}\">\n\t\t<text><tspan >{}</tspan></text>\n",
            x, y, turned, anchor, words);
    };
    const std::string head = "<svg \n width=\"200\" height=\"100\"\n";
    EXPECT_THAT(collisions(head + text(10, 50, "start", "abc") + text(10, 61, "start", "abc")), IsEmpty());
    EXPECT_THAT(collisions(head + text(10, 50, "start", "abc") + text(20, 55, "start", "def")),
                ElementsAre("\"abc\" lies on \"def\""));
    EXPECT_THAT(collisions(head + text(10, 50, "end", "abc")),
                ElementsAre("\"abc\" leaves the picture: -8 to 10, 43 to 52"));
    EXPECT_THAT(
        collisions(head + text(100, 50, "middle", "w", " rotate(-90.00)") + text(95, 46, "start", "")),
        IsEmpty());
    EXPECT_THAT(
        collisions(head + text(100, 80, "start", "wwww", " rotate(-90.00)") + text(90, 60, "start", "ww")),
        ElementsAre("\"wwww\" lies on \"ww\""));
    EXPECT_THAT(
        collisions(head + text(10, 50, "start", "abc") +
                   "<use xlink:href='#gpPt6' transform='translate(15.2,47.0) scale(3.6)' color='red'/>"),
        ElementsAre("a marker at 15,47 lies on \"abc\""));
}

TEST(Lettering, ATextIsAsWideAsItsLettersInTheFont) {
    for (const char* text : {"Hilbert, 16x16 tiles", "seconds [s]", "{}~!Wi"}) {
        const std::string svg = fmt::format(
            "<g transform=\"translate(0,50)\" font-size=\"11.00\"  text-anchor=\"start\">\n<text>{}</text>",
            text);
        const std::vector<Text> found = texts_of(svg);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(text_width(text, 11), found[0].right - found[0].left, 1e-9) << text;
    }
}

TEST(Lettering, LinesAreCutAtTheirSeparators) {
    const double two = text_width("bb · ccc", 10) + 0.01;
    EXPECT_THAT(wrapped("a · bb · ccc · d", 10, two), ElementsAre("a · bb", "ccc · d"));
    EXPECT_THAT(wrapped("none: a; b, c; d", 10, text_width("none: a; b, c;", 10)),
                ElementsAre("none: a; b, c;", "d"));
    EXPECT_THAT(wrapped("one two three", 10, text_width("one two", 10)), ElementsAre("one two", "three"));
    EXPECT_THAT(wrapped("unbreakable", 10, 1), ElementsAre("unbreakable"));
    EXPECT_EQ(fitting("abcdefgh", 10, text_width("abcd...", 10)), "abcd...");
}

}  // namespace
}  // namespace regather::charts
