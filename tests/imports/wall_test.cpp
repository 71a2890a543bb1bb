#include "imports/homes/wall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/scenes/closed_surface.h"
#include "trace/bounds.h"

namespace regather::imports {

namespace {

using scenes::is_closed;

HomeWall wall(std::string id, PlanPoint start, PlanPoint end, double thickness = 10) {
    HomeWall w;
    w.id = std::move(id);
    w.start = start;
    w.end = end;
    w.thickness = thickness;
    w.height = w.height_at_end = 250;
    return w;
}

Surface joined(const WallSurfaces& parts) {
    Surface all;
    for (const Surface* part : {&parts.left, &parts.right, &parts.top}) {
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), part->vertices.begin(), part->vertices.end());
        for (const auto& [a, b, c] : part->triangles)
            all.triangles.push_back({a + first, b + first, c + first});
    }
    return all;
}

// By the divergence theorem: of a closed surface that faces outward.
double volume(const Surface& surface) {
    double sum = 0;
    for (const auto& [a, b, c] : surface.triangles)
        sum += static_cast<double>(dot(surface.vertices[a], cross(surface.vertices[b], surface.vertices[c])));
    return sum / 6;
}

WallHole door(double from, double to, double low, double high, double y = 0, double depth = 20) {
    return {{PlanPoint{from, y - depth / 2}, {to, y - depth / 2}, {to, y + depth / 2}, {from, y + depth / 2}},
            low,
            high,
            {}};
}

TEST(Wall, AWallIsAClosedBoxOfItsSize) {
    const HomeWall w = wall("a", {0, 0}, {400, 0});
    const Surface surface = joined(extrude(w, wall_outlines({&w, 1})[0], 0, {}));
    EXPECT_TRUE(is_closed(surface));
    EXPECT_NEAR(volume(surface), 4 * 0.1 * 2.5, 1e-5);
    const trace::Bounds3 bounds = trace::bounds_of(surface.vertices);
    EXPECT_EQ(bounds.min, (Vec3{0, -0.05f, 0}));
    EXPECT_EQ(bounds.max, (Vec3{4, 0.05f, 2.5f}));
}

TEST(Wall, ItsLeftIsOnTheLeftHandOfWhoWalksAlongIt) {
    // On the plan y is down: who walks to the right has smaller y, and larger scene y, on the left.
    const HomeWall w = wall("a", {0, 0}, {400, 0});
    const WallSurfaces surfaces = extrude(w, wall_outlines({&w, 1})[0], 0, {});
    for (const auto& [a, b, c] : surfaces.right.triangles)
        EXPECT_NEAR(
            surfaces.right.vertices[a].y + surfaces.right.vertices[b].y + surfaces.right.vertices[c].y,
            -0.15f, 1e-6);
}

TEST(Wall, ADoorAndAWindowAreCutOutAndTheWallStaysClosed) {
    const HomeWall w = wall("a", {0, 0}, {400, 0});
    const std::vector<WallHole> holes{door(50, 140, 0, 210), door(200, 320, 90, 220)};
    const Surface surface = joined(extrude(w, wall_outlines({&w, 1})[0], 0, holes));
    EXPECT_TRUE(is_closed(surface));
    EXPECT_NEAR(volume(surface), 0.1 * (4 * 2.5 - 0.9 * 2.1 - 1.2 * 1.3), 1e-5);
}

TEST(Wall, HolesThatOverlapReachTheEndOrTheTopAreCutOnce) {
    const HomeWall w = wall("a", {0, 0}, {400, 0});
    const std::vector<WallHole> holes{door(100, 200, 0, 200), door(150, 250, 100, 220),
                                      door(350, 500, 0, 999)};
    const Surface surface = joined(extrude(w, wall_outlines({&w, 1})[0], 0, holes));
    EXPECT_TRUE(is_closed(surface));
    EXPECT_NEAR(volume(surface), 0.1 * (4 * 2.5 - (1 * 2 + 1 * 1.2 - 0.5 * 1) - 0.5 * 2.5), 1e-5);
}

TEST(Wall, ADoorInAnotherWallOrBesideItLeavesItWhole) {
    const HomeWall w = wall("a", {0, 0}, {400, 0});
    for (const WallHole& hole : {door(100, 200, 0, 200, 100), door(100, 200, 0, 200, 14),
                                 door(500, 600, 0, 200), door(100, 200, 300, 400)})
        EXPECT_NEAR(volume(joined(extrude(w, wall_outlines({&w, 1})[0], 0, {&hole, 1}))), 1, 1e-5);
}

TEST(Wall, FourJoinedWallsMeetInMitresThatLeaveNoGapAndNoOverlap) {
    std::vector<HomeWall> walls{wall("a", {0, 0}, {400, 0}), wall("b", {400, 0}, {400, 300}),
                                wall("c", {400, 300}, {0, 300}), wall("d", {0, 300}, {0, 0})};
    for (std::size_t i = 0; i < 4; ++i) {
        walls[i].at_end = walls[(i + 1) % 4].id;
        walls[i].at_start = walls[(i + 3) % 4].id;
    }
    const std::vector<WallOutline> outlines = wall_outlines(walls);
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Surface surface = joined(extrude(walls[i], outlines[i], 0, {}));
        EXPECT_TRUE(is_closed(surface));
        sum += volume(surface);
        EXPECT_EQ(in_metres(outlines[i].left.back(), 0), in_metres(outlines[(i + 1) % 4].left.front(), 0));
        EXPECT_EQ(in_metres(outlines[i].right.back(), 0), in_metres(outlines[(i + 1) % 4].right.front(), 0));
    }
    EXPECT_NEAR(sum, 2.5 * (4.1 * 3.1 - 3.9 * 2.9), 1e-4);
}

TEST(Wall, WallsJoinedStartToStartAndByOneSideOnly) {
    std::vector<HomeWall> walls{wall("a", {0, 0}, {400, 0}), wall("b", {0, 0}, {0, 300})};
    walls[0].at_start = "b";
    walls[1].at_start = "a";
    std::vector<WallOutline> outlines = wall_outlines(walls);
    EXPECT_NEAR(outlines[0].left[0].x, -5, 1e-9);  // the outer corner
    EXPECT_NEAR(outlines[0].right[0].x, 5, 1e-9);
    EXPECT_NEAR(outlines[1].right[0].y, -5, 1e-9);
    walls[1].at_start = "";  // b ends in a without a's knowledge of it: nothing is mitred
    outlines = wall_outlines(walls);
    EXPECT_EQ(outlines[0].left[0], (PlanPoint{0, -5}));
}

TEST(Wall, ASlopingTopAndAnArcHaveTheirVolumes) {
    HomeWall sloping = wall("a", {0, 0}, {400, 0});
    sloping.height_at_end = 50;
    const WallHole hole = door(100, 200, 20, 100);
    const Surface slope = joined(extrude(sloping, wall_outlines({&sloping, 1})[0], 0, {&hole, 1}));
    EXPECT_TRUE(is_closed(slope));
    EXPECT_NEAR(volume(slope), 0.1 * (4 * 1.5 - 1 * 0.8), 1e-5);

    HomeWall arc = wall("b", {-100, 0}, {100, 0});
    arc.arc_extent = std::numbers::pi;
    const Surface half = joined(extrude(arc, wall_outlines({&arc, 1})[0], 0, {}));
    const double ring = std::numbers::pi / 2 * (1.05 * 1.05 - 0.95 * 0.95) * 2.5;
    EXPECT_NEAR(volume(half), ring, 0.02 * ring);  // of chords
}

TEST(Wall, AnArcOfEitherSignHasItsLeftOnTheLeftHand) {
    // A chord of 2 m and an arc of 60 degrees: the radius is 2 m, the centre 173.205 cm off the chord. A
    // positive arc has it at larger y, on the right hand of who walks along x (y is down), and bulges to
    // smaller y; a negative one the other way.
    for (const double sign : {1.0, -1.0}) {
        HomeWall arc = wall("a", {-100, 0}, {100, 0});
        arc.arc_extent = sign * std::numbers::pi / 3;
        const WallOutline outline = wall_outlines({&arc, 1})[0];
        ASSERT_EQ(outline.left.size(), 7u);
        EXPECT_NEAR(outline.left[3].x, 0, 1e-9);
        EXPECT_NEAR(outline.left[3].y, sign > 0 ? 173.2050808 - 205 : 195 - 173.2050808, 1e-6);
        EXPECT_NEAR(outline.right[3].y, sign > 0 ? 173.2050808 - 195 : 205 - 173.2050808, 1e-6);
        // The ends lie on the radius, 30 degrees off the chord's normal: half a thickness from the wall's
        // end.
        EXPECT_NEAR(outline.left[0].x, -100 - sign * 2.5, 1e-6);
        EXPECT_NEAR(outline.left[6].x, 100 + sign * 2.5, 1e-6);
        const Surface surface = joined(extrude(arc, outline, 0, {}));
        EXPECT_TRUE(is_closed(surface));
        // Six chords of 10 degrees: sectors of radius R have the area R^2 sin(10) / 2 each.
        EXPECT_NEAR(volume(surface),
                    6 * 0.5 * std::sin(std::numbers::pi / 18) * (2.05 * 2.05 - 1.95 * 1.95) * 2.5, 1e-5);
    }
}

TEST(Wall, ADoorCutsFromAQuarterOfTheThicknessOn) {
    const HomeWall w = wall("a", {0, 0}, {400, 0});  // from y = -5 to 5
    const auto volume_with = [&](double y) {
        const WallHole hole = door(100, 200, 0, 200, y);
        return volume(joined(extrude(w, wall_outlines({&w, 1})[0], 0, {&hole, 1})));
    };
    EXPECT_NEAR(volume_with(13), 1, 1e-5);  // from y = 3: a fifth
    EXPECT_NEAR(volume_with(-13), 1, 1e-5);
    EXPECT_NEAR(volume_with(12), 1 - 0.2, 1e-5);  // from y = 2: three tenths
    EXPECT_NEAR(volume_with(-12), 1 - 0.2, 1e-5);
}

TEST(Wall, WallsWithoutLengthOrThicknessGiveNothing) {
    for (const HomeWall& w : {wall("a", {0, 0}, {0, 0}), wall("a", {0, 0}, {400, 0}, 0)}) {
        const WallHole hole = door(100, 200, 0, 200);
        const Surface surface = joined(extrude(w, wall_outlines({&w, 1})[0], 0, {&hole, 1}));
        EXPECT_NEAR(volume(surface), 0, 1e-9);
        for (const Vec3 p : surface.vertices) EXPECT_TRUE(trace::is_finite(p));
    }
}

}  // namespace
}  // namespace regather::imports
