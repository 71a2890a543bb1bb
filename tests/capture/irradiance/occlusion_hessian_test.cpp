// Second derivatives of irradiance, against differences of Lambert's closed form.
#include "capture/irradiance/occlusion_hessian.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/capture/irradiance/rectangle_light.h"

namespace regather::capture {
namespace {

PlaneHessian by_differences(std::span<const Vec3d> corners, Vec3d at) {
    constexpr double h = 1e-3;
    const auto e = [&](double x, double y) { return lambert(corners, at + Vec3d{x, y, 0}, {0, 0, 1}); };
    return {(e(h, 0) - 2 * e(0, 0) + e(-h, 0)) / (h * h),
            (e(h, h) - e(h, -h) - e(-h, h) + e(-h, -h)) / (4 * h * h),
            (e(0, h) - 2 * e(0, 0) + e(0, -h)) / (h * h)};
}
PlaneHessian by_edges(std::span<const Vec3d> corners, Vec3d at) {
    PlaneHessian sum;
    for (std::size_t i = 0; i < corners.size(); ++i)
        sum += edge_hessian(corners[i] - at, corners[(i + 1) % corners.size()] - at);
    return sum;
}

TEST(OcclusionHessian, TheEdgesOfAPolygonAddUpToItsSecondDerivative) {
    const std::vector<Vec3d> triangle{{-0.3, -1.1, 0.9}, {1.4, 0.2, 0.4}, {0.1, 0.8, 1.3}};
    const std::array<Vec3d, 4> rectangle = Rectangle{{0.2, 0.1, 0.3}, {2, 0.1, 0.2}, {0, 0.7, 1.5}}.corners();
    for (const Vec3d at : {Vec3d{0, 0, 0}, {0.7, -1.2, 0}, {-2, 0.3, 0}})
        for (const std::span<const Vec3d> corners :
             {std::span<const Vec3d>(triangle), std::span<const Vec3d>(rectangle)}) {
            const PlaneHessian found = by_edges(corners, at), expected = by_differences(corners, at);
            // From where the corners run the other way about, they count as dark.
            const double turn = trace::dot(trace::cross(corners[1] - corners[0], corners[2] - corners[0]),
                                           corners[0] - at) > 0
                                    ? 1
                                    : -1;
            const double scale = std::fabs(expected.xx) + std::fabs(expected.yy);
            EXPECT_NEAR(turn * found.xx, expected.xx, 2e-4 * scale) << at.x;
            EXPECT_NEAR(turn * found.xy, expected.xy, 2e-4 * scale) << at.x;
            EXPECT_NEAR(turn * found.yy, expected.yy, 2e-4 * scale) << at.x;
        }
}

TEST(OcclusionHessian, CornersThatTurnFromXToYAreLight) {
    // Right above a small square of side s at height 1, E is about s^2 / (1 + r^2)^2: d2E/dx2 = -4 s^2.
    const std::array<Vec3d, 4> square = Rectangle{{-0.005, -0.005, 1}, {0.01, 0, 0}, {0, 0.01, 0}}.corners();
    EXPECT_NEAR(by_edges(square, {}).xx, -4e-4, 1e-6);
    EXPECT_NEAR(by_edges(square, {}).yy, -4e-4, 1e-6);
    EXPECT_NEAR(by_edges(square, {}).xy, 0, 1e-6);
}

TEST(OcclusionHessian, EdgesWithoutAnAngleCountForNothing) {
    for (const auto& [from, to] :
         {std::pair<Vec3d, Vec3d>{{1, 2, 3}, {1, 2, 3}}, {{1, 2, 3}, {2, 4, 6}}, {{0, 0, 0}, {0, 1, 1}}}) {
        const PlaneHessian found = edge_hessian(from, to);
        EXPECT_EQ(found.xx, 0);
        EXPECT_EQ(found.xy, 0);
        EXPECT_EQ(found.yy, 0);
    }
}

// A dark screen before a far bright ceiling takes away what it would send if it were as bright.
TEST(OcclusionHessian, AScreenBendsIrradianceByItsOutline) {
    const Rectangle screen{{0.3, -0.6, 0.7}, {0.5, 0, 0.1}, {0, 0.9, 0}};
    const auto corners = screen.corners();
    const HemisphereGrid grid(100, 314);
    const PlaneHessian expected = by_differences(corners, {});
    for (const Vec3 normal : {Vec3{0, 0, 1}, Vec3{0, 0.6f, 0.8f}}) {
        const Frame frame(normal);
        const Vec3d x = frame.tangent, y = frame.bitangent, z = frame.normal;
        const PlaneHessian found = occlusion_hessian(
            grid, frame,
            hemisphere(grid, frame,
                       [&](Incoming& sample) {
                           sample.radiance = {0.25f, 0.5f, 0.25f};
                           const Vec3d d = sample.direction;
                           if (const auto met = screen.met({}, {dot(d, x), dot(d, y), dot(d, z)}))
                               sample.radiance = {}, sample.distance = static_cast<float>(*met);
                       }),
            50);
        EXPECT_NEAR(found.xx, -expected.xx, 0.06 * std::fabs(expected.xx));
        EXPECT_NEAR(found.xy, -expected.xy, 0.06 * std::fabs(expected.xx));
        EXPECT_NEAR(found.yy, -expected.yy, 0.06 * std::fabs(expected.xx));
    }
}

TEST(OcclusionHessian, EvenLightDoesNotBend) {
    const HemisphereGrid grid(6, 17);
    const Frame frame({0, 1, 0});
    std::uint32_t n = 0;
    const PlaneHessian found = occlusion_hessian(grid, frame,
                                                 hemisphere(grid, frame,
                                                            [&](Incoming& sample) {
                                                                sample.radiance = {1, 2, 3};
                                                                sample.distance =
                                                                    static_cast<float>(1 + n++ % 5);
                                                            }),
                                                 100);
    EXPECT_EQ(found.xx, 0);
    EXPECT_EQ(found.xy, 0);
    EXPECT_EQ(found.yy, 0);
}

// lambda 16 along (3, 4) / 5 and 1 across it, of an irradiance of 2: (4 e / (pi 8))^(1/4) and twice that at
// most.
TEST(OcclusionHessian, TheEllipseIsLongWhereItBendsLittle) {
    const double along = 16, across = -1;
    const PlaneHessian hessian{(9 * along + 16 * across) / 25, 12 * (along - across) / 25,
                               (16 * along + 9 * across) / 25};
    const double shorter = std::pow(4 * 0.02 / (std::numbers::pi * 8), 0.25);
    const PlaneEllipse found = ellipse_of(hessian, 2, 0.02, 10);
    EXPECT_NEAR(found.shorter, shorter, 1e-12);
    EXPECT_NEAR(found.longer, 2 * shorter, 1e-12);  // the fourth root of 16
    EXPECT_NEAR(std::fabs(found.x * 0.6 + found.y * 0.8), 0, 1e-12);
    EXPECT_NEAR(found.x * found.x + found.y * found.y, 1, 1e-12);
    const PlaneEllipse flatter = ellipse_of({0, 0, 4}, 1, 0.02, 10);
    EXPECT_NEAR(flatter.longer, 2 * flatter.shorter, 1e-12) << "at most twice";
    EXPECT_NEAR(std::fabs(flatter.x), 1, 1e-12);
    const PlaneEllipse other = ellipse_of({4, 0, 0}, 1, 0.02, 10);
    EXPECT_NEAR(std::fabs(other.y), 1, 1e-12);
    const PlaneEllipse mild = ellipse_of({5, 0, 3}, 1, 0.02, 10);
    EXPECT_NEAR(mild.longer / mild.shorter, std::pow(5 / 3.0, 0.25), 1e-12);
    EXPECT_NEAR(ellipse_of({4, 0, 4}, 1, 0.02, 0.1).longer, 0.1, 0) << "bounded";
    for (const PlaneEllipse& flat : {ellipse_of({}, 1, 0.02, 10), ellipse_of({1, 0, 1}, 0, 0.02, 10)}) {
        EXPECT_EQ(flat.longer, 10);
        EXPECT_EQ(flat.shorter, 10);
    }
}

}  // namespace
}  // namespace regather::capture
