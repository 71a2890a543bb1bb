#include "charts/series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/results/rows.h"
#include "trace/error.h"

namespace regather::charts {
namespace {

using namespace results;

using testing::ElementsAre;

std::vector<std::string> labels(const std::vector<Curve>& all) {
    std::vector<std::string> out;
    for (const Curve& curve : all) out.push_back(curve.label);
    return out;
}

std::vector<std::uint64_t> traffic(const Curve& curve) {
    std::vector<std::uint64_t> out;
    for (const Row* row : curve.rows) out.push_back(*row->traffic_bytes);
    return out;
}

TEST(Series, RunsAlongTilesAndKeepsWhatHasNoneLevel) {
    const std::vector<Row> rows = {made_row("naive", {}, {}, 900), made_row("hilbert", 32, {}, 50),
                                   made_row("hilbert", 8, {}, 100), made_row("hilbert", {}, {}, 5)};
    const auto all = curves(rows, Along::tile, {});
    ASSERT_THAT(labels(all), ElementsAre("Naive", "Hilbert", "Hilbert, whole image"));
    EXPECT_TRUE(all[0].flat);
    EXPECT_FALSE(all[1].flat);
    EXPECT_TRUE(all[2].flat);
    EXPECT_THAT(traffic(all[1]), ElementsAre(100, 50));
    EXPECT_EQ(all[1].colour, all[2].colour);
}

TEST(Series, HoldsTheOtherParametersAtTheNearestValueMeasured) {
    std::vector<Row> rows;
    for (const std::uint64_t tile : {4, 32, 64})
        for (const std::uint64_t bins : {2, 8})
            rows.push_back(made_row("direction-binned", tile, bins, tile * 100 + bins));
    // 32 is nearer to 16 by ratio than 4; 8 is the nearest number of bins.
    auto all = curves(rows, Along::tile, {});
    ASSERT_THAT(labels(all), ElementsAre("Direction bins 8×8"));
    EXPECT_THAT(traffic(all[0]), ElementsAre(408, 3208, 6408));
    all = curves(rows, Along::bins, {});
    ASSERT_THAT(labels(all), ElementsAre("Direction bins, 32×32 tiles"));
    EXPECT_THAT(traffic(all[0]), ElementsAre(3202, 3208));
    all = curves(rows, Along::cache, {});
    ASSERT_THAT(labels(all), ElementsAre("Direction bins 8×8, 32×32 tiles"));
    EXPECT_THAT(traffic(all[0]), ElementsAre(3208));
    // 8 and 32 are equally far from 16: the smaller one.
    const std::vector<Row> tie = {made_row("hilbert", 32, {}, 1), made_row("hilbert", 8, {}, 2)};
    EXPECT_THAT(traffic(curves(tie, Along::cache, {})[0]), ElementsAre(2));
}

TEST(Series, TakesOnlyRowsOfTheCacheAndOfTheAxis) {
    std::vector<Row> rows = {made_row("hilbert", 8, {}, 1), made_row("hilbert", 16, {}, 2),
                             made_row("tiled", 8, {}, 3), made_row("hilbert", 32, {}, 4),
                             made_row("hilbert", 0, {}, 5)};
    rows[1].cache_bytes = 4096;
    rows[2].ways = 4;
    rows[3].traffic_bytes.reset();
    const auto by_tile = curves(rows, Along::tile, {});
    ASSERT_THAT(labels(by_tile), ElementsAre("Hilbert"));
    EXPECT_THAT(traffic(by_tile[0]), ElementsAre(1));
    rows[1].tile = 8;
    const auto by_cache = curves(rows, Along::cache, {});
    ASSERT_THAT(labels(by_cache), ElementsAre("Hilbert, 8×8 tiles"));
    EXPECT_THAT(traffic(by_cache[0]), ElementsAre(2, 1));
    EXPECT_TRUE(curves(rows, Along::bins, {}).empty());

    std::vector<Row> binned = {made_row("direction-binned", 16, 4, 1),
                               made_row("direction-binned", 16, 8, 2)};
    binned[1].cache_bytes = 4096;
    EXPECT_THAT(traffic(curves(binned, Along::bins, {})[0]), ElementsAre(1));
}

TEST(Series, NamesOnlyWhatDiffers) {
    const std::vector<Row> rows = {
        with_parameters(made_row("tiled", 8, {}, 1), "tiled:tile=8,rows=left-to-right"),
        with_parameters(made_row("tiled", 8, {}, 2), "tiled:tile=8,rows=alternating"),
        with_parameters(made_row("hilbert", 8, {}, 3), "hilbert:tile=8,bits=16"),
        with_parameters(made_row("hilbert", {}, {}, 4), "hilbert:bits=21"),
    };
    EXPECT_THAT(labels(curves(rows, Along::tile, {})),
                ElementsAre("Tiled, rows=left-to-right", "Tiled, rows=alternating", "Hilbert",
                            "Hilbert, whole image"));
    std::vector<Row> layouts = {made_row("naive", {}, {}, 1), made_row("naive", {}, {}, 2)};
    layouts[1].layout = "veb-20";
    const auto all = curves(layouts, Along::tile, {});
    EXPECT_THAT(labels(all), ElementsAre("Naive, heap-20", "Naive, veb-20"));
    EXPECT_NE(all[0].variant, all[1].variant);
    std::vector<Row> asked(3, made_row("naive", {}, {}, 1));
    asked[1].sampling = "combined:rows=4";
    asked[2].sampling = "incident:rows=4";
    EXPECT_THAT(labels(curves(asked, Along::tile, {})),
                ElementsAre("Naive", "Naive, combined", "Naive, incident"));
    asked[2].sampling = "combined:rows=8";
    EXPECT_THAT(labels(curves(asked, Along::tile, {})),
                ElementsAre("Naive", "Naive, combined:rows=4", "Naive, combined:rows=8"));
    // A layout that goes with the structure needs no word.
    layouts[1].structure = "octree";
    EXPECT_THAT(labels(curves(layouts, Along::tile, {})),
                ElementsAre("Naive, left-balanced-kd", "Naive, octree"));
    layouts.push_back(layouts[1]);
    layouts[2].layout = "heap-20";
    EXPECT_THAT(
        labels(curves(layouts, Along::tile, {})),
        ElementsAre("Naive, left-balanced-kd, heap-20", "Naive, octree, veb-20", "Naive, octree, heap-20"));
}

TEST(Series, APassForEachBinIsNoParameterOfItsOwn) {
    const std::vector<Row> rows = {
        with_parameters(made_row("direction-binned", 16, 4, 1), "direction-binned:tile=16,bins=4,passes=16"),
        with_parameters(made_row("direction-binned", 16, 8, 2), "direction-binned:tile=16,bins=8,passes=64"),
        with_parameters(made_row("direction-binned", 16, 8, 3), "direction-binned:tile=16,bins=8,passes=16"),
    };
    EXPECT_THAT(labels(curves(rows, Along::bins, {})),
                ElementsAre("Direction bins, 16×16 tiles", "Direction bins, 16×16 tiles, passes=16"));
}

TEST(Series, ARepeatedRowIsOneAndAContradictionIsRefused) {
    std::vector<Row> rows = {made_row("hilbert", 8, {}, 7), made_row("hilbert", 8, {}, 7)};
    EXPECT_THAT(traffic(curves(rows, Along::tile, {})[0]), ElementsAre(7));
    rows[1].traffic_bytes = 8;
    EXPECT_THROW(curves(rows, Along::tile, {}), trace::DataError);
    rows = {made_row("naive", {}, {}, 7), made_row("naive", {}, {}, 8)};
    EXPECT_THROW(curves(rows, Along::tile, {}), trace::DataError);
}

TEST(Series, NoTwoOrderingsLookAlike) {
    const auto look_apart = [](const std::vector<std::string>& orderings) {
        std::vector<Row> known;
        for (const std::string& ordering : orderings) known.push_back(made_row(ordering, {}, {}, 1));
        std::set<std::string> colours, names;
        std::set<int> markers;
        for (const Curve& curve : curves(known, Along::cache, {})) {
            EXPECT_NE(curve.label, curve.rows.front()->ordering);  // it has a name for people
            EXPECT_TRUE(names.insert(curve.label).second) << curve.label;
            EXPECT_TRUE(colours.insert(curve.colour).second) << curve.label;
            EXPECT_TRUE(markers.insert(curve.marker).second) << curve.label;
        }
        EXPECT_EQ(names.size(), known.size());
        return colours;
    };
    std::vector<std::string> of_both{"random",  "naive",   "tiled",   "direction-binned",
                                     "hashed",  "swizzle", "morton",  "direction-binned+hashed",
                                     "hilbert", "kd-leaf", "bvh-leaf"};
    std::vector<std::string> of_photons = of_both, of_rays = of_both;
    for (const char* name : {"strata", "strata+hashed"}) of_photons.push_back(name);
    for (const char* name : {"origin-direction", "origin-guess", "origin-end"}) of_rays.push_back(name);
    std::set<std::string> colours = look_apart(of_photons);
    colours.merge(look_apart(of_rays));
    const std::vector<Row> strangers = {made_row("mine", {}, {}, 1), made_row("yours", {}, {}, 2)};
    const auto all = curves(strangers, Along::tile, {});
    EXPECT_THAT(labels(all), ElementsAre("mine", "yours"));
    EXPECT_NE(all[0].colour, all[1].colour);
    EXPECT_TRUE(colours.insert(all[0].colour).second);
}

}  // namespace
}  // namespace regather::charts
