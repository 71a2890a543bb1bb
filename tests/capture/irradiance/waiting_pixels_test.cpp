// Points that wait for records in the making, on time lines drawn by hand; and how far apart gathers begin.
#include "capture/irradiance/waiting_pixels.h"

#include <gtest/gtest.h>

#include "capture/irradiance/gather_scatter.h"

namespace regather::capture {
namespace {

SeedPoint on_floor(std::uint32_t column, std::uint32_t row, float x, float y) {
    return {{{x, y, 0}, {0, 0, 1}}, column, row, 0};
}
IrradianceRecord reaching(const SeedPoint& at, float radius) {
    return {at.point.position, at.point.normal, {1, 1, 1}, {}, {}, {1, 0, 0}, radius, radius};
}
constexpr trace::Bounds3 whole{{-1, -1, -1}, {12, 12, 1}};

// Records reach 2.5 from 0, 3 and 10. Looked up: 0 at time 0, begins and ends at 3; 1 at time 1, waits 2; 2
// at time 2 finds the only place taken until 3, when it is served; 3 at time 4, as 0 is too far; 10 at time
// 5, ends at 8; 11 at time 6 waits 2.
TEST(WaitingPixels, APointWaitsForTheRecordThatWillServeIt) {
    std::vector<SeedPoint> points;
    IrradianceOctree octree(whole, 0.5, false);
    for (const float x : {0.f, 1.f, 2.f, 3.f, 10.f, 11.f})
        points.push_back(on_floor(static_cast<std::uint32_t>(points.size()), 0, x, 0));
    for (const std::size_t i : {0u, 3u, 4u}) octree.insert(reaching(points[i], 5));
    const WaitingPixels one = waiting_pixels(points, octree, whole, {.latency = 3, .entries = 1, .tile = 16});
    EXPECT_EQ(one.points, 6u);
    EXPECT_EQ(one.records, 3u);
    EXPECT_EQ(one.records_unheld, 6u) << "none is finished in time";
    EXPECT_EQ(one.waited, 2u);
    EXPECT_EQ(one.most_waiting, 1u);
    EXPECT_EQ(one.stopped, 1u);
    EXPECT_EQ(one.half, 2u);
    // With a second place 2 waits for 1, and all behind it comes one earlier.
    const WaitingPixels two = waiting_pixels(points, octree, whole, {.latency = 3, .entries = 2, .tile = 16});
    EXPECT_EQ(two.records, 3u);
    EXPECT_EQ(two.waited, 3u);
    EXPECT_EQ(two.most_waiting, 2u);
    EXPECT_EQ(two.stopped, 0u);
    EXPECT_EQ(two.half, 2u);
    EXPECT_EQ(two.longest, 2u);
    const WaitingPixels at_once = waiting_pixels(points, octree, whole, {.latency = 0, .entries = 1});
    EXPECT_EQ(at_once.records, 3u);
    EXPECT_EQ(at_once.records_unheld, 3u);
    EXPECT_EQ(at_once.waited, 0u);
    EXPECT_EQ(at_once.longest, 0u);
}

// Four columns and two rows at distance 1; records reach 1.2. In tiles of 2 x 2 the waits are 3, 2, 3 and 1;
// row by row 3 and 3.
TEST(WaitingPixels, PointsComeTileByTile) {
    std::vector<SeedPoint> points;
    IrradianceOctree octree(whole, 0.1, false);
    for (std::uint32_t row = 0; row < 2; ++row)
        for (std::uint32_t column = 0; column < 4; ++column) {
            points.push_back(on_floor(column, row, static_cast<float>(column), static_cast<float>(row)));
            octree.insert(reaching(points.back(), 12));
        }
    const WaitingPixels tiled =
        waiting_pixels(points, octree, whole, {.latency = 4, .entries = 9, .tile = 2});
    EXPECT_EQ(tiled.records, 4u);
    EXPECT_EQ(tiled.waited, 4u);
    EXPECT_EQ(tiled.half, 2u);
    EXPECT_EQ(tiled.nine_tenths, 3u);
    const WaitingPixels rows = waiting_pixels(points, octree, whole, {.latency = 4, .entries = 9, .tile = 4});
    EXPECT_EQ(rows.records, 4u);
    EXPECT_EQ(rows.waited, 2u);
    EXPECT_EQ(rows.half, 3u);
    const WaitingPixels single =
        waiting_pixels(points, octree, whole, {.latency = 4, .entries = 9, .tile = 1});
    EXPECT_EQ(single.waited, 2u) << "row by row, too";
}

TEST(WaitingPixels, NoPointsNoWaits) {
    const WaitingPixels none = waiting_pixels({}, IrradianceOctree({}, 0.2, false), {}, {});
    EXPECT_EQ(none.records + none.waited + none.stopped + none.ninety_nine, 0u);
}

// A tile of 3 x 4 scene units: 5 from its first point to its last; 3, 5 and 3 from each to the next. A second
// tile of two points.
TEST(GatherScatter, IsTheWayFromOneOriginToTheNextOverTheTilesExtent) {
    const std::vector<SeedPoint> points{on_floor(0, 0, 0, 0), on_floor(1, 0, 3, 0), on_floor(2, 0, 10, 0),
                                        on_floor(0, 1, 0, 4), on_floor(1, 1, 3, 4), on_floor(2, 1, 10, 1)};
    EXPECT_DOUBLE_EQ(gather_scatter(points, std::vector<std::uint8_t>{1, 1, 1, 1, 1, 1}, 2),
                     (11 / 3.0 / 5 + 1) / 2);
    EXPECT_DOUBLE_EQ(gather_scatter(points, std::vector<std::uint8_t>{0, 1, 1, 1, 1, 0}, 2), 8 / 2.0 / 5);
    EXPECT_EQ(gather_scatter(points, std::vector<std::uint8_t>(6), 2), 0);
    EXPECT_EQ(gather_scatter({}, {}, 16), 0);
}

}  // namespace
}  // namespace regather::capture
