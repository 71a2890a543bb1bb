#include "meshes/polygon.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace regather::meshes {
namespace {

using Result = Triangulator::Result;
using Polygon = std::vector<PlanPoint>;

double area_of(const Polygon& polygon, std::span<const Triangle> triangles) {
    double twice = 0;
    for (const auto& [a, b, c] : triangles) {
        const double one = twice_area(Polygon{polygon[a], polygon[b], polygon[c]});
        EXPECT_GE(one * twice_area(polygon), 0);  // runs as the polygon does
        twice += std::abs(one);
    }
    return twice / 2;
}

// The polygon's edges are there once and forwards, all others once in each direction: nothing is open or
// doubled.
void expect_edges_of(std::size_t corners, std::span<const Triangle> triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> met;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) ++met[{t[k], t[(k + 1) % 3]}];
    for (std::uint32_t i = 0; i < corners; ++i) {
        const auto next = static_cast<std::uint32_t>((i + 1) % corners);
        EXPECT_EQ((met[{i, next}]), 1);
        EXPECT_EQ((met[{next, i}]), 0);
        met.erase({i, next});
        met.erase({next, i});
    }
    for (const auto& [edge, times] : met) EXPECT_EQ((met[{edge.second, edge.first}]), times);
}

TEST(Polygon, TheDiagonalOfAConvexQuadLeavesItsFirstCorner) {
    Triangulator triangulator;
    EXPECT_EQ(triangulator.fill(Polygon{{0, 0}, {2, 0}, {3, 3}, {0, 1}}), Result::whole);
    EXPECT_EQ(std::vector(triangulator.triangles().begin(), triangulator.triangles().end()),
              (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Polygon, AConcaveQuadIsFilledWithoutLeavingIt) {
    // A dart whose corner 2 points inward: the diagonal 0-2 is right, 1-3 lies outside.
    const Polygon dart{{0, 0}, {4, 1}, {1, 1}, {1, 4}};
    for (std::size_t turn = 0; turn < 4; ++turn) {
        Polygon turned = dart;
        std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(turn), turned.end());
        Triangulator triangulator;
        EXPECT_EQ(triangulator.fill(turned), Result::whole);
        EXPECT_EQ(triangulator.triangles().size(), 2u);
        EXPECT_NEAR(area_of(turned, triangulator.triangles()), 3, 1e-12);  // 4 x 4 / 2 and the like, by hand
    }
}

TEST(Polygon, CornersOnAnEdgeAreKeptSoThatNeighboursStayJoined) {
    // A square of 2 and a triangle of 2 x 2, each with a corner in the middle of its lower side, from every
    // first corner.
    for (const auto& [polygon, area] : {std::pair{Polygon{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, 4.0},
                                        {Polygon{{1, 2}, {0, 0}, {1, 0}, {2, 0}}, 2.0}})
        for (std::size_t first = 0; first < polygon.size(); ++first) {
            Polygon turned = polygon;
            std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
            Triangulator triangulator;
            EXPECT_EQ(triangulator.fill(turned), Result::whole);
            EXPECT_EQ(triangulator.triangles().size(), turned.size() - 2);
            EXPECT_NEAR(area_of(turned, triangulator.triangles()), area, 1e-12);
            expect_edges_of(turned.size(), triangulator.triangles());
            for (const auto& [a, b, c] : triangulator.triangles())
                EXPECT_GT(twice_area(Polygon{turned[a], turned[b], turned[c]}), 0);
        }
}

TEST(Polygon, WhatCrossesItselfIsSaidAndKeepsItsEdges) {
    Triangulator triangulator;
    EXPECT_EQ(triangulator.fill(Polygon{{0, 0}, {2, 2}, {2, 0}, {0, 2}}),
              Result::crosses_itself);  // a bow tie
    expect_edges_of(4, triangulator.triangles());
    EXPECT_EQ(triangulator.fill(Polygon{{0, 3}, {1.8, -2.4}, {-2.9, 0.9}, {2.9, 0.9}, {-1.8, -2.4}}),
              Result::crosses_itself);  // a pentagram turns left everywhere
    expect_edges_of(5, triangulator.triangles());
}

TEST(Polygon, ManyCornersTakeTheirSquareAtMost) {
    // A comb of 4000 teeth, and a spiral in which an ear is only ever at the end.
    Polygon comb;
    for (int tooth = 0; tooth < 4000; ++tooth) {
        comb.push_back({2.0 * tooth, 0});
        comb.push_back({2.0 * tooth + 1, -10});
    }
    comb.push_back({8000, 1});
    comb.push_back({0, 1});
    Polygon spiral;
    for (int i = 0; i <= 3000; ++i) {
        const double angle = 0.05 * i;
        spiral.push_back({(10 + angle) * std::cos(angle), (10 + angle) * std::sin(angle)});
    }
    for (int i = 3000; i >= 0; --i) {
        const double angle = 0.05 * i;
        spiral.push_back({(12 + angle) * std::cos(angle), (12 + angle) * std::sin(angle)});
    }
    for (const Polygon& polygon : {comb, spiral}) {
        Triangulator triangulator;
        EXPECT_EQ(triangulator.fill(polygon), Result::whole);
        EXPECT_EQ(triangulator.triangles().size(), polygon.size() - 2);
        const double exact = std::abs(twice_area(polygon)) / 2;
        EXPECT_NEAR(area_of(polygon, triangulator.triangles()), exact, 1e-9 * exact);
    }
    Polygon large(most_concave_corners + 1);
    for (std::size_t i = 0; i < large.size(); ++i) large[i] = {static_cast<double>(i), i % 2 ? 0.0 : -1.0};
    EXPECT_EQ(Triangulator().fill(large), Result::too_large);
}

RC_GTEST_PROP(Polygon, AStarWithAnyRadiiIsCoveredExactly, ()) {
    const std::size_t corners = *rc::gen::inRange<std::size_t>(4, 40);
    Polygon star;
    for (std::size_t i = 0; i < corners; ++i) {
        const double radius = *rc::gen::inRange(1, 1000),
                     angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
        star.push_back({radius * std::cos(angle) + 5, radius * std::sin(angle) - 7});
    }
    if (*rc::gen::arbitrary<bool>()) std::reverse(star.begin(), star.end());
    Triangulator triangulator;
    RC_ASSERT(triangulator.fill(star) == Result::whole);
    RC_ASSERT(triangulator.triangles().size() == corners - 2);
    const double exact = std::abs(twice_area(star)) / 2;
    RC_ASSERT(std::abs(area_of(star, triangulator.triangles()) - exact) <= 1e-9 * exact);
    expect_edges_of(corners, triangulator.triangles());
}

TEST(Polygon, InSpaceItFacesAlongItsNormalWhicheverAxisThatIsNear) {
    // An L of area 3 in the plan, put on planes that face along and against each axis, tilted.
    const Polygon plan{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f}) {
            std::vector<Vec3> polygon;
            for (const PlanPoint p : plan) {
                Vec3 q;
                q[(axis + 1) % 3] = static_cast<float>(p.x);
                q[(axis + 2) % 3] = sign * static_cast<float>(p.y);
                q[axis] = 5 + 0.25f * static_cast<float>(p.x);
                polygon.push_back(q);
            }
            Triangulator triangulator;
            EXPECT_EQ(triangulator.fill(polygon), Result::whole);
            EXPECT_EQ(triangulator.triangles().size(), 4u);
            Vec3 normal;
            for (const auto& [a, b, c] : triangulator.triangles()) {
                const Vec3 n = cross(polygon[b] - polygon[a], polygon[c] - polygon[a]);
                EXPECT_GT(n[axis] * sign, 0);
                normal += n * 0.5f;
            }
            EXPECT_FLOAT_EQ(normal[axis], 3 * sign);
        }
}

/// Of its triangles, which all run as it does.
double covered_area(const Polygon& polygon) {
    double sum = 0;
    for (const auto& [a, b, c] : triangulate(polygon)) {
        const double twice = twice_area(Polygon{polygon[a], polygon[b], polygon[c]});
        EXPECT_EQ(twice > 0, twice_area(polygon) > 0);
        sum += std::abs(twice) / 2;
    }
    return sum;
}

TEST(Polygon, TrianglesCoverExactlyThePolygon) {
    const Polygon l_shape{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
    EXPECT_NEAR(covered_area(l_shape), 6, 1e-12);
    EXPECT_NEAR(covered_area({l_shape.rbegin(), l_shape.rend()}), 6, 1e-12);
    EXPECT_NEAR(covered_area({{0, 0}, {2, 0}, {2, 0}, {4, 0}, {4, 2}, {0, 2}}), 8,
                1e-12);  // with a repeated and a flat corner
    Polygon comb;
    for (int i = 0; i < 20; ++i) {
        comb.push_back({2.0 * i, 0});
        comb.push_back({2.0 * i + 1, 10});
    }
    comb.push_back({39, -1});
    comb.push_back({0, -1});
    EXPECT_NEAR(covered_area(comb), std::abs(twice_area(comb)) / 2, 1e-9);
}

TEST(Polygon, NonsenseEnds) {
    EXPECT_TRUE(triangulate(Polygon{}).empty());
    EXPECT_TRUE(triangulate(Polygon{{0, 0}, {1, 1}}).empty());
    EXPECT_TRUE(triangulate(Polygon{{0, 0}, {1, 1}, {2, 2}, {3, 3}}).empty());
    EXPECT_LE(triangulate(Polygon{{0, 0}, {2, 2}, {2, 0}, {0, 2}}).size(), 2u);  // a bow tie
}

}  // namespace
}  // namespace regather::meshes
