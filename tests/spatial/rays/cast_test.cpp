#include "spatial/rays/cast.h"

#include <embree3/rtcore.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "tests/spatial/rays/soup.h"

namespace regather::spatial {
namespace {

using trace::Vec3;

RayBvh ray_bvh_of(const Soup& soup) {
    return RayBvh(soup.vertices, soup.triangles);
}

Vec3 direction_of(std::mt19937& random) {
    for (;;) {
        const Vec3 d = uniform3(random) * 2 - Vec3{1, 1, 1};
        if (dot(d, d) > 0.01f && dot(d, d) < 1) return normalize(d);
    }
}

// --- the rule, triangle by triangle
// ---------------------------------------------------------------------------

/// Where one triangle is met by the paper's rule (sheared corners as floats, exact signs), or endless.
float distance_by_the_rule(const std::array<Vec3, 3>& corners, const Ray& ray) {
    const Vec3 size{std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)};
    const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    const float shear_x = ray.direction[x] / ray.direction[z], shear_y = ray.direction[y] / ray.direction[z];
    double px[3], py[3], pz[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 from = corners[i] - ray.origin;
        px[i] = std::fma(-shear_x, from[z], from[x]);
        py[i] = std::fma(-shear_y, from[z], from[y]);
        pz[i] = from[z];
    }
    const double u = px[1] * py[2] - py[1] * px[2], v = px[2] * py[0] - py[2] * px[0],
                 w = px[0] * py[1] - py[0] * px[1];
    if (std::min({u, v, w}) < 0 && std::max({u, v, w}) > 0) return endless;
    if (u == 0 && v == 0 && w == 0) return endless;
    return float((u * pz[0] + v * pz[1] + w * pz[2]) / ((u + v + w) * double(ray.direction[z])));
}

/// All triangles, no hierarchy. Expects a soup without degenerate ones.
std::pair<float, std::uint32_t> closest_by_the_rule(const Soup& soup, const Ray& ray) {
    std::pair best{ray.farthest, Meeting::nothing};
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
        const std::pair found{
            distance_by_the_rule({soup.corner(t, 0), soup.corner(t, 1), soup.corner(t, 2)}, ray), t};
        if (found.first > ray.nearest && found.first <= ray.farthest && found.first < endless && found < best)
            best = found;
    }
    return best;
}

void expect_the_rule(const Soup& soup, const RayBvh& tree, const Ray& ray) {
    const auto [distance, triangle] = closest_by_the_rule(soup, ray);
    const Meeting met = closest(tree, ray);
    ASSERT_EQ(met.triangle, triangle) << met.distance << " for " << distance;
    ASSERT_EQ(met.distance, distance);
    ASSERT_EQ(occluded(tree, ray), triangle != Meeting::nothing);
    if (!met.found() || distance == 0) return;
    Ray up_to = ray;
    up_to.farthest = distance;
    ASSERT_TRUE(occluded(tree, up_to));
    ASSERT_EQ(closest(tree, up_to).triangle, triangle);
    up_to.farthest = std::nextafter(distance, 0.0f);
    ASSERT_FALSE(occluded(tree, up_to));
    ASSERT_FALSE(closest(tree, up_to).found());
}

/// A grid of unit squares, two triangles each, in the planes x, y and z = 0 .. n: all boxes, edges and
/// corners coincide.
Soup grid(int n) {
    Soup soup;
    for (int axis = 0; axis < 3; ++axis)
        for (int plane = 0; plane <= n; ++plane)
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int di, int dj) {
                        Vec3 v;
                        v[axis] = float(plane);
                        v[(axis + 1) % 3] = float(i + di);
                        v[(axis + 2) % 3] = float(j + dj);
                        return v;
                    };
                    soup.add(corner(0, 0), corner(1, 0), corner(1, 1));
                    soup.add(corner(1, 1), corner(0, 1), corner(0, 0));
                }
    return soup;
}

TEST(Cast, FindsWhatTheRuleFindsInASoup) {
    for (const float size : {0.01f, 0.1f, 1.0f}) {
        const Soup soup = random_soup(600, size, 1);
        const RayBvh tree = ray_bvh_of(soup);
        std::mt19937 random(2);
        for (int i = 0; i < 1500; ++i) {
            const Vec3 from = uniform3(random) * 3 - Vec3{1, 1, 1};
            expect_the_rule(soup, tree, {from, direction_of(random)});
            if (HasFatalFailure()) return;
        }
    }
}

// From and to points of the grid: rays in the planes of triangles, along edges, through corners, with
// components that are 0 and -0, from origins on the planes of boxes.
TEST(Cast, FindsWhatTheRuleFindsOnAGrid) {
    const Soup soup = grid(4);
    const RayBvh tree = ray_bvh_of(soup);
    std::mt19937 random(3);
    for (int i = 0; i < 6000; ++i) {
        Vec3 from, to;
        for (int axis = 0; axis < 3; ++axis) {
            from[axis] = float(random() % 13) / 2 - 1;
            to[axis] = random() % 3 == 0 ? from[axis] : float(random() % 13) / 2 - 1;
        }
        Vec3 direction = to - from;
        for (int axis = 0; axis < 3; ++axis)
            if (direction[axis] == 0 && random() % 2) direction[axis] = -0.0f;
        if (dot(direction, direction) == 0) continue;
        if (random() % 2) direction = normalize(direction);
        expect_the_rule(soup, tree, {from, direction});
        if (HasFatalFailure()) return;
    }
}

// Where triangles of the grid meet several times over, the smallest number is found, whatever their sequence.
TEST(Cast, TheSequenceOfTrianglesDecidesTiesOnly) {
    const Soup soup = grid(3);
    std::mt19937 random(4);
    std::vector<std::uint32_t> order(soup.triangles.size());
    for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
    for (std::size_t t = order.size() - 1; t > 0; --t) std::swap(order[t], order[random() % (t + 1)]);
    Soup shuffled = soup;
    for (std::size_t t = 0; t < order.size(); ++t) shuffled.triangles[t] = soup.triangles[order[t]];
    const RayBvh tree = ray_bvh_of(soup), other = ray_bvh_of(shuffled);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 from = uniform3(random) * 3;
        const Vec3 to{float(random() % 4), float(random() % 4), float(random() % 4)};
        if (from == to) continue;
        const Ray ray{from, normalize(to - from)};
        const Meeting a = closest(tree, ray), b = closest(other, ray);
        ASSERT_TRUE(a.found());
        ASSERT_EQ(a.distance, b.distance);
        ASSERT_LE(a.triangle, order[b.triangle]);
    }
}

// --- independent answers
// --------------------------------------------------------------------------------------

/// A triangle's plane and edges in double, for the true ray: where it is met, and how far inside its edges,
/// as the smallest barycentric coordinate.
struct Oracle {
    double distance, inside;
};
Oracle oracle(const Soup& soup, std::uint32_t t, const Ray& ray) {
    using Double3 = std::array<double, 3>;
    const auto minus = [](Vec3 a, Vec3 b) {
        return Double3{double{a.x} - double{b.x}, double{a.y} - double{b.y}, double{a.z} - double{b.z}};
    };
    const auto cross = [](const Double3& a, const Double3& b) {
        return Double3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto dot = [](const Double3& a, const Double3& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    // Moeller and Trumbore 1997.
    const Double3 ab = minus(soup.corner(t, 1), soup.corner(t, 0)),
                  ac = minus(soup.corner(t, 2), soup.corner(t, 0)), ao = minus(ray.origin, soup.corner(t, 0)),
                  d{double{ray.direction.x}, double{ray.direction.y}, double{ray.direction.z}};
    const Double3 p = cross(d, ac), q = cross(ao, ab);
    const double determinant = dot(ab, p);
    const double u = dot(ao, p) / determinant, v = dot(d, q) / determinant;
    return {dot(ac, q) / determinant, std::min({u, v, 1 - u - v})};
}

TEST(Cast, AgreesWithDoublePrecisionOnClearCases) {
    const Soup soup = random_soup(1000, 0.2f, 5);
    const RayBvh tree = ray_bvh_of(soup);
    std::mt19937 random(6);
    int clear = 0, hits = 0;
    constexpr int rays = 3000;
    for (int i = 0; i < rays; ++i) {
        const Ray ray{uniform3(random), direction_of(random)};
        // A case is clear when nothing near an edge, near the origin or near the same distance decides it.
        std::pair<double, std::uint32_t> best{endless, Meeting::nothing};
        double next = endless;
        bool sure = true;
        for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
            const Oracle found = oracle(soup, t, ray);
            if (found.inside < -1e-4 || found.distance < -1e-4) continue;
            if (found.inside < 1e-4 || found.distance < 1e-4)
                sure = sure && found.distance > best.first + 1e-4;
            if (found.distance < best.first) {
                next = best.first;
                best = {found.distance, t};
                sure = found.inside >= 1e-4 && found.distance >= 1e-4;
            } else {
                next = std::min(next, found.distance);
            }
        }
        if (!sure || next - best.first < 1e-4) continue;
        ++clear;
        const Meeting met = closest(tree, ray);
        ASSERT_EQ(met.triangle, best.second);
        if (!met.found()) continue;
        ++hits;
        ASSERT_NEAR(met.distance, best.first, 1e-5);
        double inside = 1;
        for (const double weight : met.weights) inside = std::min(inside, weight / met.weight_sum);
        ASSERT_NEAR(inside, oracle(soup, met.triangle, ray).inside, 1e-3);
    }
    EXPECT_GT(clear, rays * 9 / 10);
    EXPECT_GT(hits, rays / 2);
}

/// Embree's own traversal and triangle test, in robust mode.
class EmbreeScene {
public:
    explicit EmbreeScene(const Soup& soup) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, soup.vertices.size()));
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, soup.triangles.size()));
        for (const Vec3 v : soup.vertices)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = v[axis];
        for (const auto& triangle : soup.triangles)
            for (const std::uint32_t corner : triangle) *indices++ = corner;
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    std::pair<float, std::uint32_t> closest(const Ray& ray) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query;
        query.ray = {.org_x = ray.origin.x,
                     .org_y = ray.origin.y,
                     .org_z = ray.origin.z,
                     .tnear = ray.nearest,
                     .dir_x = ray.direction.x,
                     .dir_y = ray.direction.y,
                     .dir_z = ray.direction.z,
                     .time = 0,
                     .tfar = ray.farthest,
                     .mask = 0xffffffffu,
                     .id = 0,
                     .flags = 0};
        query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        return {query.ray.tfar, query.hit.primID};
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

// The same triangle, or one at the same distance to 1e-5: where triangles meet, Embree takes either. A ray
// that passes an edge within rounding may hit or miss the triangle there: fewer than 1 in 1000.
TEST(Cast, AgreesWithEmbree) {
    const Soup soup = random_soup(20'000, 0.1f, 7);
    const RayBvh tree = ray_bvh_of(soup);
    const EmbreeScene embree(soup);
    std::mt19937 random(8);
    int other = 0, hits = 0;
    constexpr int rays = 20'000;
    for (int i = 0; i < rays; ++i) {
        const Ray ray{uniform3(random) * 2 - Vec3{0.5f, 0.5f, 0.5f}, direction_of(random)};
        const auto [distance, triangle] = embree.closest(ray);
        const Meeting met = closest(tree, ray);
        hits += met.found();
        const bool near = !met.found() || std::fabs(met.distance - distance) <= 1e-5f * (1 + distance);
        if (met.triangle == triangle) {
            ASSERT_TRUE(near) << i;
        } else {
            other += !near;
        }
    }
    EXPECT_LT(other, rays / 1000);
    EXPECT_GT(hits, rays / 5);
}

// --- watertight
// -----------------------------------------------------------------------------------------------

/// A closed surface around the origin: `rings` x `sectors` of a sphere with radii from 0.5 to 1, stretched
/// and turned, in units of `scale`.
struct Closed {
    Soup soup;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
};
Closed closed_surface(std::uint32_t rings, std::uint32_t sectors, const Vec3& stretch, float turn,
                      float scale, unsigned seed) {
    std::mt19937 random(seed);
    Closed result;
    const auto add_vertex = [&](Vec3 v) {
        v = v * (0.5f + 0.5f * uniform(random)) * stretch;
        const float c = std::cos(turn), s = std::sin(turn);
        v = Vec3{c * v.x - s * v.y, s * v.x + c * v.y, v.z};
        result.soup.vertices.push_back(Vec3{v.x, c * v.y - s * v.z, s * v.y + c * v.z} * scale);
    };
    add_vertex({0, 0, 1});
    for (std::uint32_t r = 1; r <= rings; ++r)
        for (std::uint32_t s = 0; s < sectors; ++s) {
            const float down = std::numbers::pi_v<float> * float(r) / float(rings + 1),
                        round = 2 * std::numbers::pi_v<float> * float(s) / float(sectors);
            add_vertex({std::sin(down) * std::cos(round), std::sin(down) * std::sin(round), std::cos(down)});
        }
    add_vertex({0, 0, -1});
    const auto at = [&](std::uint32_t r, std::uint32_t s) {
        return r == 0 ? 0 : r > rings ? 1 + rings * sectors : 1 + (r - 1) * sectors + s % sectors;
    };
    for (std::uint32_t r = 0; r <= rings; ++r)
        for (std::uint32_t s = 0; s < sectors; ++s) {
            if (r < rings) result.soup.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
            if (r > 0) result.soup.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
        }
    for (const auto& triangle : result.soup.triangles)
        for (std::size_t i = 0; i < 3; ++i) result.edges.emplace_back(triangle[i], triangle[(i + 1) % 3]);
    return result;
}

// A star around the origin: from there every ray meets it, those at its edges and corners, too.
RC_GTEST_PROP(Cast, NoRayLeavesAClosedSurface, ()) {
    const auto rings = *rc::gen::inRange<std::uint32_t>(1, 9);
    const auto sectors = *rc::gen::inRange<std::uint32_t>(3, 12);
    const auto part = [] { return float(*rc::gen::inRange(1, 1000)) * 1e-3f; };
    const Vec3 stretch{part(), part(), part()};
    const float scale = std::ldexp(1.0f, *rc::gen::inRange(-50, 50));
    const Closed closed =
        closed_surface(rings, sectors, stretch, part() * 6, scale, *rc::gen::arbitrary<unsigned>());
    const RayBvh tree = ray_bvh_of(closed.soup);
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    // The surface is turned, so it may be thin along any direction: this near its middle is within.
    const float within = std::min({stretch.x, stretch.y, stretch.z}) * 1e-3f * scale;
    for (int i = 0; i < 200; ++i) {
        const auto [p, q] = closed.edges[random() % closed.edges.size()];
        const float along = random() % 4 == 0 ? 0 : uniform(random);
        const Vec3 to = closed.soup.vertices[p] * (1 - along) + closed.soup.vertices[q] * along;
        const Vec3 origin = Vec3{0.7f, 0.2f, 0.5f} * (random() % 2 ? 0 : uniform(random) * within);
        const Vec3 direction = (to - origin) * (1 / scale);
        RC_ASSERT(closest(tree, {origin, direction}).found());
        RC_ASSERT(occluded(tree, {origin, direction}));
        RC_ASSERT(closest(tree, {origin, -direction}).found());
    }
}

// --- limits
// ---------------------------------------------------------------------------------------------------

TEST(Cast, PowersOfTwoScaleDistancesExactly) {
    const Soup soup = random_soup(300, 0.3f, 9);
    const RayBvh tree = ray_bvh_of(soup);
    for (const int power : {-100, -60, -20, 20, 55}) {
        const float scale = std::ldexp(1.0f, power);
        Soup scaled = soup;
        for (Vec3& v : scaled.vertices) v = v * scale;
        const RayBvh other = ray_bvh_of(scaled);
        std::mt19937 random(10);
        for (int i = 0; i < 500; ++i) {
            const Vec3 from = uniform3(random), direction = direction_of(random);
            const Meeting a = closest(tree, {from, direction}), b = closest(other, {from * scale, direction});
            ASSERT_EQ(a.triangle, b.triangle) << power;
            ASSERT_EQ(a.distance * scale, b.distance) << power;
        }
    }
}

TEST(Cast, NothingIsMetInAnEmptyScene) {
    EXPECT_FALSE(closest(RayBvh(), {{}, {0, 0, 1}}).found());
    EXPECT_FALSE(occluded(ray_bvh_of({}), {{}, {0, 0, 1}}));
}

// By hand: the triangle's plane is z = 2, the ray passes it at (1/4, 1/2), so the weights are 1/4, 1/4, 1/2.
TEST(Cast, OneTriangleIsMetWhereGeometrySays) {
    Soup soup;
    soup.add({0, 0, 2}, {1, 0, 2}, {0, 1, 2});
    const RayBvh tree = ray_bvh_of(soup);
    ASSERT_TRUE(tree.nodes().empty());
    for (const float side : {1.0f, -1.0f}) {
        const Meeting met = closest(tree, {{0.25f, 0.5f, 2 - 3 * side}, {0, 0, side}});
        ASSERT_EQ(met.triangle, 0u);
        EXPECT_EQ(met.distance, 3);
        EXPECT_EQ(met.weights[0] / met.weight_sum, 0.25);
        EXPECT_EQ(met.weights[1] / met.weight_sum, 0.25);
        EXPECT_EQ(met.weights[2] / met.weight_sum, 0.5);
    }
    EXPECT_FALSE(closest(tree, {{0.25f, 0.5f, 3}, {0, 0, 1}}).found());       // behind
    EXPECT_FALSE(closest(tree, {{0.75f, 0.5f, 0}, {0, 0, 1}}).found());       // beside
    EXPECT_FALSE(closest(tree, {{0.25f, 0.5f, 2}, {0, 1, 0}}).found());       // in its plane
    EXPECT_TRUE(closest(tree, {{0.5f, 0.5f, 0}, {-0.0f, 0, 1}}).found());     // on its edge
    EXPECT_FALSE(closest(tree, {{0.25f, 0.5f, 0}, {0, 0, 1}, 2}).found());    // not over `nearest`
    EXPECT_TRUE(closest(tree, {{0.25f, 0.5f, 0}, {0, 0, 1}, 0, 2}).found());  // up to `farthest`
}

TEST(Cast, OfManyAtOnePlaceTheFirstIsMet) {
    Soup soup = random_soup(100, 0.1f, 11);
    for (int i = 0; i < 100'000; ++i) soup.add({-1, -1, 3}, {3, -1, 3}, {-1, 3, 3});
    const RayBvh tree = ray_bvh_of(soup);
    for (int i = 0; i < 20; ++i) {
        const Ray ray{{0.05f * float(i), 0.4f, 2}, {0, 0.1f, 1}};
        const Meeting met = closest(tree, ray);
        EXPECT_EQ(met.triangle, 100u);
        EXPECT_EQ(met.distance, 1);
        EXPECT_TRUE(occluded(tree, ray));
    }
}

TEST(Cast, TrianglesWithoutAreaAreNeverMet) {
    Soup soup;
    soup.add({0, 0, 1}, {0, 0, 1}, {0, 0, 1});
    soup.add({-1, 0, 1}, {1, 0, 1}, {1, 0, 1});
    soup.add({-1, -2, 1}, {1, 2, 1}, {0.5f, 1, 1});
    const RayBvh none = ray_bvh_of(soup);
    EXPECT_TRUE(none.empty());
    EXPECT_FALSE(closest(none, {{}, {0, 0, 1}}).found());
    soup.add({-1, -1, 2}, {1, -1, 2}, {0, 3, 2});
    const RayBvh one = ray_bvh_of(soup);
    EXPECT_EQ(closest(one, {{}, {0, 0, 1}}).triangle, 3u);
    EXPECT_EQ(closest(one, {{}, {0, 0, 1}}).distance, 2);
}

// Far origins, directions of any length, components next to nothing.
TEST(Cast, ExtremeRaysFollowTheRule) {
    const Soup soup = random_soup(400, 0.5f, 12);
    const RayBvh tree = ray_bvh_of(soup);
    std::mt19937 random(13);
    for (int i = 0; i < 2000; ++i) {
        const float away = std::ldexp(1.0f, int(random() % 60) - 30);
        Vec3 direction = direction_of(random);
        const Vec3 from = uniform3(random) - direction * away;
        direction = direction * std::ldexp(1.0f, int(random() % 80) - 40);
        if (i % 3 == 0) direction[int(random() % 3)] *= std::ldexp(1.0f, -int(random() % 140));
        if (dot(direction, direction) == 0) continue;
        expect_the_rule(soup, tree, {from, direction});
        if (HasFatalFailure()) return;
    }
}

// --- what a listener hears
// ------------------------------------------------------------------------------------

struct Heard {
    std::vector<std::uint32_t> steps;  ///< As children are written: blocks with the leaf bit.
    void node(std::uint32_t n) { steps.push_back(n); }
    void block(std::uint32_t b) { steps.push_back(b | RayBvh::leaf_bit); }
};

TEST(Cast, AListenerHearsEachStepOnceAfterItsParent) {
    const Soup soup = random_soup(3000, 0.05f, 14);
    const RayBvh tree = ray_bvh_of(soup);
    std::map<std::uint32_t, std::uint32_t> parent;
    for (std::uint32_t n = 0; n < tree.nodes().size(); ++n)
        for (const std::uint32_t child : tree.nodes()[n].children)
            if (child != 0) parent[child] = n;
    EXPECT_EQ(parent.size(), tree.nodes().size() + tree.blocks().size() - 1);
    std::mt19937 random(15);
    for (int i = 0; i < 200; ++i) {
        const Ray ray{uniform3(random), direction_of(random)};
        Heard heard, shadow;
        const Meeting met = closest(tree, ray, heard);
        EXPECT_EQ(met.triangle, closest(tree, ray).triangle);
        EXPECT_EQ(occluded(tree, ray, shadow), met.found());
        for (const auto& steps : {heard.steps, shadow.steps}) {
            std::set<std::uint32_t> before;
            for (const std::uint32_t step : steps) {
                EXPECT_TRUE(step == tree.root() || before.contains(parent.at(step)));
                EXPECT_TRUE(before.insert(step).second);
            }
        }
        if (met.found()) {
            EXPECT_TRUE(shadow.steps.back() & RayBvh::leaf_bit);
            const auto holds = [&](std::uint32_t step) {
                const RayBvh::Block& block = tree.blocks()[step & ~RayBvh::leaf_bit];
                return (step & RayBvh::leaf_bit) &&
                       std::count(block.triangles, block.triangles + block.count, met.triangle) == 1;
            };
            EXPECT_EQ(std::count_if(heard.steps.begin(), heard.steps.end(), holds), 1);
        }
    }
}

// Two walls of nine small squares each, one behind the other: with a hit in the near one, no triangle of the
// far one is tested.
TEST(Cast, WhatLiesBehindTheHitIsNotVisited) {
    Soup soup;
    for (const float z : {1.0f, 9.0f})
        for (int i = 0; i < 9; ++i) {
            const Vec3 at{float(i % 3), float(i / 3), z};
            soup.add(at, at + Vec3{1, 0, 0}, at + Vec3{1, 1, 0});
            soup.add(at, at + Vec3{1, 1, 0}, at + Vec3{0, 1, 0});
        }
    const RayBvh tree = ray_bvh_of(soup);
    for (const float side : {1.0f, -1.0f}) {
        Heard heard;
        const Meeting met = closest(tree, {{1.3f, 1.6f, 5 - 5 * side}, {0, 0, side}}, heard);
        ASSERT_EQ(met.distance, 1);
        for (const std::uint32_t step : heard.steps) {
            if (!(step & RayBvh::leaf_bit)) continue;
            const RayBvh::Block& block = tree.blocks()[step & ~RayBvh::leaf_bit];
            for (std::uint32_t lane = 0; lane < block.count; ++lane)
                EXPECT_EQ(block.triangles[lane]<18, side> 0);
        }
    }
}

}  // namespace
}  // namespace regather::spatial
