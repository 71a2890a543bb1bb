// Cells of one size: where points lie, and which cells are met around one.
#include "spatial/photons/cell_planes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <limits>
#include <map>
#include <set>

namespace regather::spatial {
namespace {

using testing::ElementsAre;
using trace::Bounds3;

Bounds3 box_of(Vec3 min, Vec3 max) {
    Bounds3 box;
    box.include(min);
    box.include(max);
    return box;
}

TEST(CellPlanes, CellsAreThoseDrawnByHand) {
    // Four cells of 1 along x, three along y, one along z, which has no extent.
    const CellPlanes planes(box_of({2, 0, 7}, {6, 2.5f, 7}), 4);
    EXPECT_EQ(planes.count(0), 4u);
    EXPECT_EQ(planes.count(1), 3u);
    EXPECT_EQ(planes.count(2), 1u);
    EXPECT_EQ(planes.cells(), 12u);
    EXPECT_THAT(planes.cell_of({3.5f, 2.4f, 7}), ElementsAre(1, 2, 0));
    EXPECT_THAT(planes.cell_of({3, 0, 7}), ElementsAre(1, 0, 0)) << "on a plane: above it";
    EXPECT_THAT(planes.cell_of({6, 2.5f, 7}), ElementsAre(3, 2, 0)) << "the far corner";
    EXPECT_THAT(planes.cell_of({-9, 99, 0}), ElementsAre(0, 2, 0)) << "outside";
    EXPECT_EQ(planes.number({1, 2, 0}), 9u);
    EXPECT_THAT(planes.place(9), ElementsAre(1, 2, 0));
    EXPECT_EQ(planes.distance2({3, 0, 0}, {2, 0.5f, 9}), 9 + 4.0f);
}

TEST(CellPlanes, AsManyAsFit) {
    EXPECT_EQ(cells_along(box_of({0, 0, 0}, {2, 1, 1}), 54), 6u);  // 6 x 3 x 3; 7 x 4 x 4 are too many
    EXPECT_EQ(cells_along(box_of({0, 0, 0}, {2, 1, 1}), 44), 4u);  // 5 x 3 x 3 are 45, 4 x 2 x 2 are 16
    EXPECT_EQ(cells_along(box_of({0, 0, 5}, {3, 3, 5}), 100), 10u);
    EXPECT_EQ(cells_along(box_of({0, 0, 0}, {0, 0, 9}), 77), 77u);
    EXPECT_EQ(cells_along(box_of({1, 1, 1}, {1, 1, 1}), 77), 1u);
    EXPECT_EQ(cells_along({}, 77), 1u);
}

TEST(CellPlanes, EachPointLiesInItsCellAndNoNearerThanIt) {
    ASSERT_TRUE(rc::check([] {
        const auto number = [] {
            return *rc::gen::element(0.0f, 1.0f, -3.0f, 1e-30f, 3e38f, -3e38f, 0.1f, 0.7f, 16777216.0f);
        };
        const Vec3 a{number(), number(), number()}, b{number(), number(), number()},
            c{number(), number(), number()};
        const Bounds3 box = box_of(a, b);
        const CellPlanes planes(box, *rc::gen::element(1u, 2u, 7u, 1000u));
        for (const Vec3 point : {a, b, c}) {
            Bounds3 with = box;
            with.include(point);
            if (!(with == box)) continue;
            const CellPlace cell = planes.cell_of(point);
            RC_ASSERT(planes.distance2(cell, point) == 0.0f);
            RC_ASSERT(planes.place(planes.number(cell)) == cell);
            const Vec3 away = c - point;
            RC_ASSERT(planes.distance2(cell, c) <= trace::dot(away, away));
        }
    }));
}

TEST(CellPlanes, TheCellsAroundAPointAreThoseDrawnByHand) {
    // Ten cells of 1. Cell 9 begins 1.75 from 7.25, cell 5 ends 1.25 from it.
    const CellPlanes planes(box_of({0, 0, 0}, {10, 0, 0}), 10);
    const auto met = [&](float x, float bound) {
        std::vector<std::uint32_t> cells;
        planes.for_each_near(
            {x, 0, 0}, [&] { return bound; }, [&](const CellPlace& cell) { cells.push_back(cell[0]); }, 100,
            [](std::uint32_t) {});
        return cells;
    };
    EXPECT_THAT(met(7.25f, 1.75f * 1.75f), ElementsAre(7, 6, 8, 5, 9));
    EXPECT_THAT(met(7.25f, 1.74f * 1.74f), ElementsAre(7, 6, 8, 5));
    EXPECT_THAT(met(7.25f, 0.25f * 0.25f), ElementsAre(7, 6));
    EXPECT_THAT(met(7.75f, 0.25f * 0.25f), ElementsAre(7, 8));
    EXPECT_THAT(met(12, 4), ElementsAre(9));
    EXPECT_THAT(met(12, 9), ElementsAre(9, 8));
    EXPECT_THAT(met(12, 1), ElementsAre());
}

TEST(CellPlanes, EveryCellWithinTheBoundIsMetOnceShellByShell) {
    ASSERT_TRUE(rc::check([] {
        const auto side = [] { return static_cast<float>(*rc::gen::inRange(0, 6)); };
        const CellPlanes planes(box_of({0, 0, 0}, {side(), side(), side()}), *rc::gen::inRange(1u, 9u));
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-8, 20)) * 0.5f; };
        const Vec3 point{coordinate(), coordinate(), coordinate()};
        const float bound =
            *rc::gen::element(0.0f, 0.3f, 2.0f, 20.0f, std::numeric_limits<float>::infinity());
        const auto most = *rc::gen::element<std::uint64_t>(3, 40, 1 << 20);
        const CellPlace home = planes.cell_of(point);
        const auto steps_to = [&](const CellPlace& cell) {
            std::uint32_t steps = 0;
            for (std::size_t axis = 0; axis < 3; ++axis)
                steps = std::max(steps, std::max(cell[axis], home[axis]) - std::min(cell[axis], home[axis]));
            return steps;
        };
        std::set<CellPlace> met;
        std::uint32_t last = 0, rest = std::numeric_limits<std::uint32_t>::max();
        planes.for_each_near(
            point, [&] { return bound; },
            [&](const CellPlace& cell) {
                RC_ASSERT(met.insert(cell).second);
                RC_ASSERT(steps_to(cell) >= last);
                last = steps_to(cell);
            },
            most, [&](std::uint32_t steps) { rest = steps; });
        std::set<CellPlace> expected;
        std::map<std::uint32_t, std::uint64_t> in_shell;
        for (std::uint64_t number = 0; number < planes.cells(); ++number) {
            const CellPlace cell = planes.place(number);
            ++in_shell[steps_to(cell)];
            if (planes.distance2(cell, point) <= bound && steps_to(cell) < rest) expected.insert(cell);
        }
        RC_ASSERT(met == expected);
        // What is left begins with the first shell that has too many cells.
        for (const auto& [steps, cells] : in_shell)
            if (steps < rest) RC_ASSERT(cells <= most || steps > last);
        if (in_shell.contains(rest)) RC_ASSERT(in_shell[rest] > most);
    }));
}

}  // namespace
}  // namespace regather::spatial
