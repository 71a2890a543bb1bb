// Irradiance, its gradients and the distances of what is met, against closed forms.
#include "capture/irradiance/irradiance_estimate.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/capture/irradiance/rectangle_light.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

Vec3d rotated(Vec3d v, Vec3d axis, double angle) {
    return v * std::cos(angle) + trace::cross(axis, v) * std::sin(angle) +
           axis * (trace::dot(axis, v) * (1 - std::cos(angle)));
}

TEST(HemisphereGrid, CellsHaveEqualSharesAndTheirDirectionsLieInside) {
    const HemisphereGrid grid(3, 5);
    const Vec3 low = grid.direction(7, 0, 0), high = grid.direction(7, 0x1.fffffep-1f, 0x1.fffffep-1f);
    EXPECT_NEAR(low.x * low.x + low.y * low.y, 1 / 3.0, 1e-6);  // row 1, column 2
    EXPECT_NEAR(high.x * high.x + high.y * high.y, 2 / 3.0, 1e-6);
    EXPECT_NEAR(std::atan2(low.y, low.x), 2 * std::numbers::pi * 2 / 5, 1e-5);
    EXPECT_NEAR(std::atan2(high.y, high.x), 2 * std::numbers::pi * 3 / 5 - 2 * std::numbers::pi, 1e-5);
}

TEST(HemisphereGrid, IsAboutAsWideAsHigh) {
    EXPECT_EQ(HemisphereGrid::of(100).rows(), 6u);
    EXPECT_EQ(HemisphereGrid::of(100).columns(), 16u);
    EXPECT_EQ(HemisphereGrid::of(1).cells(), 3u);
    EXPECT_THROW(HemisphereGrid(0, 3), trace::UsageError);
    EXPECT_THROW(HemisphereGrid(4, 2), trace::UsageError);
    EXPECT_THROW(HemisphereGrid(4, 1025), trace::UsageError);
}

TEST(IrradianceEstimate, AnEvenHemisphereHasNoGradients) {
    const HemisphereGrid grid(5, 13);
    const Frame frame({0.6f, 0, 0.8f});
    std::uint32_t n = 0;
    const IrradianceEstimate found = estimate_irradiance(
        grid, frame, hemisphere(grid, frame, [&](Incoming& sample) {
            sample.radiance = {3, 2, 0.25f};
            sample.distance = static_cast<float>(1 + n++ % 7);  // whatever the distances are
        }));
    EXPECT_NEAR(found.irradiance.x, 3 * std::numbers::pi, 1e-12);
    EXPECT_NEAR(found.irradiance.y, 2 * std::numbers::pi, 1e-12);
    EXPECT_NEAR(found.irradiance.z, 0.25 * std::numbers::pi, 1e-12);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(found.translation[c], Vec3d{});
        EXPECT_NEAR(trace::length(found.rotation[c]), 0, 1e-12);
    }
}

// By the closed form: a light of 1.4 x 0.8 m, 0.9 m above a point that is off its middle both ways.
TEST(IrradianceEstimate, GradientsUnderARectangleAreThoseOfTheClosedForm) {
    const Rectangle light{{-0.3, -1.1, 0.9}, {1.4, 0, 0}, {0, 0.8, 0.1}};
    const auto corners = light.corners();
    const HemisphereGrid grid(120, 380);
    for (const Vec3 from : {Vec3{0, 0, 0}, Vec3{0.7f, -1.2f, 0}, Vec3{-1.1f, 0.5f, 0}}) {
        const Vec3d at = from, up{0, 0, 1};
        const Frame frame({0, 0, 1});
        const IrradianceEstimate found =
            estimate_irradiance(grid, frame, hemisphere(grid, frame, light_of(light, from, {2, 0, 5})));
        const double expected = lambert(corners, at, up);
        EXPECT_NEAR(found.irradiance.x, 2 * expected, 0.01 * expected);
        EXPECT_EQ(found.irradiance.y, 0);
        const auto moved = [&](Vec3d step) { return lambert(corners, at + step, up); };
        const auto turned = [&](Vec3d by) {
            return lambert(corners, at, rotated(up, trace::normalize(by), trace::length(by)));
        };
        const Vec3d move{slope(moved, {1e-4, 0, 0}), slope(moved, {0, 1e-4, 0}), 0};
        const Vec3d turn{slope(turned, {1e-4, 0, 0}), slope(turned, {0, 1e-4, 0}), 0};
        EXPECT_NEAR(trace::length(found.translation[0] - move * 2), 0, 0.03 * trace::length(move)) << from.x;
        EXPECT_NEAR(trace::length(found.translation[2] - move * 5), 0, 0.08 * trace::length(move)) << from.x;
        EXPECT_NEAR(trace::length(found.rotation[0] - turn * 2), 0, 0.01 * trace::length(turn)) << from.x;
        EXPECT_NEAR(trace::length(found.rotation[2] - turn * 5), 0, 0.03 * trace::length(turn)) << from.x;
        EXPECT_EQ(found.translation[1], Vec3d{});
        EXPECT_EQ(found.rotation[1], Vec3d{});
    }
}

// A dark screen hangs before an endless bright ceiling: what moves is the screen's border, at its distance.
TEST(IrradianceEstimate, AnEdgeMovesWithTheNearerSurface) {
    const Rectangle screen{{0.2, -0.9, 0.5}, {0.6, 0, 0}, {0, 1.1, 0.2}};
    const auto corners = screen.corners();
    const HemisphereGrid grid(120, 380);
    const Frame frame({0, 0, 1});
    const IrradianceEstimate found =
        estimate_irradiance(grid, frame, hemisphere(grid, frame, [&](Incoming& sample) {
                                sample.radiance = {1, 1, 1};
                                sample.distance = 30 / sample.direction.z;
                                if (const auto met = screen.met({}, sample.direction))
                                    sample.radiance = {}, sample.distance = static_cast<float>(*met);
                            }));
    const auto shaded = [&](Vec3d step) { return -lambert(corners, step, {0, 0, 1}); };
    const Vec3d move{slope(shaded, {1e-4, 0, 0}), slope(shaded, {0, 1e-4, 0}), 0};
    EXPECT_NEAR(trace::length(found.translation[1] - move), 0, 0.02 * trace::length(move));
}

TEST(IrradianceEstimate, TurnsWithTheScene) {
    const HemisphereGrid grid(80, 250);
    const auto of = [&](const Frame& frame, const std::function<Vec3d(Vec3d)>& to_scene) {
        return estimate_irradiance(grid, frame, hemisphere(grid, frame, [&](Incoming& sample) {
                                       const Vec3d d = to_scene(sample.direction);
                                       const double light = 1 + d.x + 0.5 * d.y * d.y;
                                       sample.radiance = {static_cast<float>(light), 1, 1};
                                       sample.distance = static_cast<float>(2 + d.y);
                                   }));
    };
    const Vec3d axis = trace::normalize(Vec3d{1, -2, 0.5});
    const Vec3d z{0, 0, 1}, turned_z = rotated(z, axis, 1.1);
    const IrradianceEstimate still = of(Frame({0, 0, 1}), [](Vec3d d) { return d; });
    const IrradianceEstimate turned =
        of(Frame(trace::to_float(turned_z)), [&](Vec3d d) { return rotated(d, axis, -1.1); });
    EXPECT_NEAR(turned.irradiance.x, still.irradiance.x, 1e-3);
    EXPECT_NEAR(turned.harmonic_distance, still.harmonic_distance, 1e-3);
    EXPECT_GT(trace::length(still.rotation[0]), 0.5);
    EXPECT_GT(trace::length(still.translation[0]), 0.3);
    EXPECT_NEAR(trace::length(turned.rotation[0] - rotated(still.rotation[0], axis, 1.1)), 0, 0.02);
    EXPECT_NEAR(trace::length(turned.translation[0] - rotated(still.translation[0], axis, 1.1)), 0, 0.02);
    EXPECT_NEAR(trace::dot(turned.translation[0], turned_z), 0, 1e-6);
}

// Under a ceiling at 2 m the distance is 2 / cos, and the cosine's mean over the cosine density is 2 / 3.
// Inside a sphere of 3 m a chord is 6 cos, and the mean of 1 / cos is 2.
TEST(IrradianceEstimate, HarmonicMeansOfKnownRooms) {
    const HemisphereGrid grid(100, 30);
    const Frame frame({0, 1, 0});
    const auto with = [&](auto&& distance) {
        return estimate_irradiance(grid, frame, hemisphere(grid, frame, [&](Incoming& sample) {
                                       sample.distance = distance(sample.direction.y);
                                   }));
    };
    const IrradianceEstimate ceiling = with([](float cosine) { return 2 / cosine; });
    EXPECT_NEAR(ceiling.harmonic_distance, 3, 0.003);
    EXPECT_NEAR(ceiling.nearest, 2, 0.02);
    EXPECT_NEAR(with([](float cosine) { return 6 * cosine; }).harmonic_distance, 3, 0.15);
    EXPECT_NEAR(with([](float cosine) { return cosine > 0.6f ? 4 : unmet; }).harmonic_distance,
                4 / (1 - 0.36), 0.1);
    EXPECT_EQ(with([](float) { return unmet; }).harmonic_distance, unmet);
    EXPECT_EQ(with([](float) { return unmet; }).nearest, unmet);
}

TEST(IrradianceEstimate, IsFiniteForAnySamples) {
    const HemisphereGrid grid(4, 7);
    const Frame frame({0, 0, 1});
    const float odd[] = {0, -1, std::numeric_limits<float>::quiet_NaN(), unmet, 1e-45f, 3e38f};
    std::uint32_t n = 0;
    const IrradianceEstimate found =
        estimate_irradiance(grid, frame, hemisphere(grid, frame, [&](Incoming& sample) {
                                sample.distance = odd[n % 6];
                                sample.radiance = {odd[n / 6 % 6], odd[n / 4 % 6], 3e38f};
                                ++n;
                            }));
    EXPECT_TRUE(trace::is_finite(found.irradiance));
    EXPECT_GE(found.irradiance.x, 0);
    EXPECT_TRUE(trace::is_finite(found.brightness_translation()));
    EXPECT_TRUE(trace::is_finite(found.rotation[1]));
    EXPECT_GT(found.harmonic_distance, 0);
    EXPECT_LT(found.nearest, 1e-20);
}

}  // namespace
}  // namespace regather::capture
