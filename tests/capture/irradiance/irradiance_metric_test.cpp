// Where records serve, what they say there, and how far each metric lets them reach.
#include "capture/irradiance/irradiance_metric.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/capture/irradiance/rectangle_light.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

using testing::HasSubstr;
using testing::Property;
using testing::Throws;

IrradianceRecord flat_record(float longer, float shorter) {
    IrradianceRecord record;
    record.normal = upwards;
    record.axis = {1, 0, 0};
    record.longer = longer;
    record.shorter = shorter;
    record.irradiance = {1, 2, 3};
    return record;
}

TEST(IrradianceRecord, ItsErrorIsDistanceOverRAndTheTurnOfTheNormal) {
    EXPECT_NEAR(error_at(flat_record(2, 2), {{0.3f, 0.4f, 0}, upwards}), 0.25, 1e-7);
    const double turned = std::sqrt(1 - 0.8);
    EXPECT_NEAR(error_at(flat_record(2, 2), {{0, 0, 0}, {0.6f, 0, 0.8f}}), turned, 1e-6);
    EXPECT_NEAR(error_at(flat_record(2, 2), {{0.3f, 0.4f, 0}, {0.6f, 0, 0.8f}}), 0.25 + turned, 1e-6);
    const IrradianceRecord ellipse = flat_record(2, 1);
    EXPECT_NEAR(error_at(ellipse, {{0.6f, 0, 0}, upwards}), 0.3, 1e-7);
    EXPECT_NEAR(error_at(ellipse, {{0, 0.6f, 0}, upwards}), 0.6, 1e-7);
    EXPECT_NEAR(error_at(ellipse, {{0.6f, 0, 0.8f}, upwards}), std::sqrt(0.09 + 0.64), 1e-7)
        << "off the surface";
    EXPECT_EQ(error_at(flat_record(0, 0), {{0, 0, 0}, upwards}), 0);
    EXPECT_EQ(error_at(flat_record(0, 0), {{0, 1e-9f, 0}, upwards}), unmet);
}

TEST(IrradianceRecord, ServesWithinItsReachAndNotBehind) {
    const IrradianceRecord record = flat_record(2, 2);
    EXPECT_TRUE(serves(record, {{0.39f, 0, 0}, upwards}, 0.2));
    EXPECT_FALSE(serves(record, {{0.41f, 0, 0}, upwards}, 0.2));
    EXPECT_TRUE(serves(record, {{0.41f, 0, 0}, upwards}, 0.25));
    EXPECT_TRUE(serves(record, {{0, 0, 0.3f}, upwards}, 0.2));
    EXPECT_FALSE(serves(record, {{0, 0, -0.3f}, upwards}, 0.2)) << "behind";
    // On a sphere of radius 1 the plane midway between the normals holds both points.
    EXPECT_TRUE(
        serves(record, {{std::sin(0.1f), 0, std::cos(0.1f) - 1}, {std::sin(0.1f), 0, std::cos(0.1f)}}, 0.2));
    EXPECT_NEAR(reach_of(flat_record(3, 1), 0.2), 0.6, 1e-6);
}

TEST(IrradianceMean, WeighsByTheInverseError) {
    const IrradiancePoint point{{0.5f, 0, 0}, upwards};
    IrradianceRecord near = flat_record(2, 2), far = flat_record(1, 1);
    far.position = {1, 0, 0};
    far.irradiance = {7, 0, 1};
    IrradianceMean mean(point);
    EXPECT_TRUE(mean.empty());
    EXPECT_EQ(mean.irradiance(), Vec3{});
    mean.add(near);  // weight 4
    mean.add(far);   // weight 2
    EXPECT_NEAR(mean.irradiance().x, (4 * 1 + 2 * 7) / 6.0, 1e-6);
    EXPECT_NEAR(mean.irradiance().y, 4 * 2 / 6.0, 1e-6);
    IrradianceMean own({{0, 0, 0}, upwards});
    own.add(near);
    own.add(far);
    EXPECT_NEAR(own.irradiance().x, 1, 1e-4) << "a record is right at its own point";
}

// E = 5 + 2 x - y is what any weights give; and what its gradients say is below 0 counts as 0.
TEST(IrradianceMean, ExtrapolatesByGradients) {
    IrradianceMean mean({{0.5f, 0.25f, 0}, upwards});
    for (const Vec3 at : {Vec3{0, 0, 0}, {1, 0.5f, 0}, {0.3f, -0.4f, 0}}) {
        IrradianceRecord record = flat_record(2, 1);
        record.position = at;
        record.irradiance = {5 + 2 * at.x - at.y, 1, 1};
        record.translation = {{{2, -1, 0}, {0, 0, 0}, {-8, 0, 0}}};
        mean.add(record);
    }
    EXPECT_NEAR(mean.irradiance().x, 5 + 1 - 0.25, 1e-6);
    EXPECT_NEAR(mean.irradiance().y, 1, 1e-6);
    IrradianceMean dark({{1, 0, 0}, upwards});
    IrradianceRecord steep = flat_record(2, 2);
    steep.translation[0] = {-8, 0, 0};
    dark.add(steep);
    EXPECT_EQ(dark.irradiance().x, 0);
}

// Under the rectangle, what a record says of a point beside it and a normal that is turned is nearer to the
// closed form than its own irradiance is.
TEST(IrradianceMean, GradientsOfARectangleLead) {
    const Rectangle light{{-0.3, -1.1, 0.9}, {1.4, 0, 0}, {0, 0.8, 0.1}};
    const auto corners = light.corners();
    const HemisphereGrid grid(60, 190);
    const Vec3 at{0.4f, 0.3f, 0};
    const auto incoming = hemisphere(grid, Frame(upwards), light_of(light, at, {1, 1, 1}));
    const IrradianceRecord record =
        make_record(parse_irradiance_cache("split-sphere"), {grid, {at, upwards}, incoming, 0, 100});
    const auto check = [&](Vec3 position, Vec3 normal) {
        IrradianceMean mean({position, normal});
        mean.add(record);
        const double truth = lambert(corners, position, normal);
        const double led = std::fabs(static_cast<double>(mean.irradiance().x) - truth);
        const double constant = std::fabs(static_cast<double>(record.irradiance.x) - truth);
        EXPECT_LT(led, 0.25 * constant) << position.x << ", " << normal.x;
    };
    check(at + Vec3{0, 0.1f, 0}, upwards);
    check(at + Vec3{0, -0.1f, 0}, upwards);
    check(at + Vec3{0.05f, -0.1f, 0}, upwards);
    check(at, {0.05f, 0.1f, std::sqrt(0.9875f)});
    check(at, {0, 0.1f, std::sqrt(0.99f)});
    check(at, {0, -0.1f, std::sqrt(0.99f)});
}

IrradianceRecord under_ceiling(const char* spec, double spacing, double far = 100) {
    const HemisphereGrid grid(60, 40);
    const auto incoming = hemisphere(grid, Frame(upwards), [](Incoming& sample) {
        sample.distance = 2 / sample.direction.z;
        sample.radiance = {1, 1, 1};
    });
    return make_record(parse_irradiance_cache(spec), {grid, {{}, upwards}, incoming, spacing, far});
}

TEST(IrradianceMetric, RIsTheDistanceOfWhatIsMet) {
    EXPECT_NEAR(under_ceiling("split-sphere", 0.01).longer, 3, 0.01);  // irradiance_estimate_test.cpp
    EXPECT_NEAR(under_ceiling("split-sphere", 0.01).shorter, 3, 0.01);
    EXPECT_NEAR(under_ceiling("split-sphere:distance=minimum", 0.01).longer, 2, 0.03);
    EXPECT_EQ(under_ceiling("split-sphere", 0.01, 2.5).longer, 2.5f);
}

TEST(IrradianceMetric, BoundsAreReachesInSpacingsOfPixels) {
    // The reach is R times a fifth.
    EXPECT_NEAR(under_ceiling("bounded", 0.1).longer, 3, 0.01) << "0.6 is between 0.3 and 2";
    EXPECT_NEAR(under_ceiling("bounded", 0.25).longer, 0.75 * 5, 1e-5) << "at least 3 spacings";
    EXPECT_NEAR(under_ceiling("bounded", 0.02).longer, 0.4 * 5, 1e-5) << "at most 20";
    EXPECT_NEAR(under_ceiling("bounded:tolerance=10,least=1,most=7", 0.02).longer, 0.14 * 10, 1e-5);
    EXPECT_NEAR(under_ceiling("hessian", 0.25, 3).longer, 3 * 5, 1e-5) << "no curvature: as far as it sees";
    EXPECT_NEAR(under_ceiling("hessian:most=8", 0.25, 3).longer, 2 * 5, 1e-5);
    for (const double unknown : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), double{unmet}})
        EXPECT_NEAR(under_ceiling("bounded", unknown).longer, 3, 0.01);
}

TEST(IrradianceMetric, RIsAtMostWhereTheGradientWouldTakeAllLight) {
    const Rectangle light{{0.8, -0.3, 0.4}, {0.1, 0, 0}, {0, 0.5, 0}};
    const HemisphereGrid grid(200, 628);
    const auto incoming = hemisphere(grid, Frame(upwards), light_of(light, {}, {1, 1, 1}));
    const auto corners = light.corners();
    const auto moved = [&](Vec3d step) { return lambert(corners, step, {0, 0, 1}); };
    const Vec3d move{slope(moved, {1e-4, 0, 0}), slope(moved, {0, 1e-4, 0}), 0};
    const double expected = lambert(corners, {}, {0, 0, 1}) / trace::length(move);
    const auto of = [&](const char* spec, double spacing) {
        return make_record(parse_irradiance_cache(spec), {grid, {{}, upwards}, incoming, spacing, 100});
    };
    EXPECT_NEAR(of("bounded", 0).longer, expected, 0.1 * expected);
    EXPECT_GT(of("split-sphere", 0).longer, 5 * expected);
    // Where the least reach is longer, the gradient is scaled down, so that a record never says less than 0.
    const IrradianceRecord raised = of("bounded", 1);
    EXPECT_NEAR(raised.longer, 15, 1e-4);
    EXPECT_NEAR(trace::length(raised.translation[1]) * reach_of(raised, 0.2), raised.irradiance.y,
                1e-4 * raised.irradiance.y);
    EXPECT_EQ(of("bounded:gradients=0", 0).translation[1], Vec3{});
    EXPECT_EQ(of("bounded:gradients=0", 0).rotation[1], Vec3{});
}

// A long dark bar close above, along y, before a bright ceiling: irradiance bends across it.
TEST(IrradianceMetric, TheHessiansEllipseLiesAlongTheBar) {
    const Rectangle bar{{0.1, -3, 0.3}, {0.2, 0, 0}, {0, 6, 0}};
    const HemisphereGrid grid(40, 126);
    const auto incoming = hemisphere(grid, Frame(upwards), [&](Incoming& sample) {
        sample.radiance = {1, 1, 1};
        if (const auto met = bar.met({}, sample.direction))
            sample.radiance = {}, sample.distance = static_cast<float>(*met);
    });
    const IrradianceRecord record =
        make_record(parse_irradiance_cache("hessian:error=20"), {grid, {{}, upwards}, incoming, 0, 10});
    EXPECT_GT(std::fabs(record.axis.y), 0.98);
    EXPECT_GT(record.longer, 1.6f * record.shorter);
    const auto corners = bar.corners();
    const auto e = [&](double x) { return 3 * (std::numbers::pi - lambert(corners, {x, 0, 0}, {0, 0, 1})); };
    const double lambda = std::fabs(e(1e-3) - 2 * e(0) + e(-1e-3)) * 1e6 / e(0);
    const double reach = std::pow(4 * 20e-6 * 100 / (std::numbers::pi * lambda), 0.25);
    EXPECT_NEAR(record.shorter * 0.2, reach, 0.05 * reach);
}

TEST(IrradianceMetric, RecordsAreFiniteWhateverWasGathered) {
    const HemisphereGrid grid(3, 5);
    const float odd[] = {0, -1, std::numeric_limits<float>::quiet_NaN(), unmet, 1e-45f, 3e38f, 1};
    for (const IrradianceMetric& metric : irradiance_metrics())
        for (const float light : odd)
            for (const float distance : odd)
                for (const float spacing : odd) {
                    std::uint32_t n = 0;
                    const auto incoming = hemisphere(grid, Frame(upwards), [&](Incoming& sample) {
                        sample.radiance = n++ % 3 == 0 ? Vec3{light, 1, 0} : Vec3{light, light, light};
                        sample.distance = n % 4 == 0 ? 1 : distance;
                    });
                    const IrradianceRecord record =
                        make_record(parse_irradiance_cache(metric.name),
                                    {grid, {{1, 2, 3}, upwards}, incoming, spacing, 30});
                    for (const Vec3 v : {record.irradiance, record.rotation[0], record.translation[0],
                                         record.translation[1], record.axis})
                        ASSERT_TRUE(trace::is_finite(v)) << metric.name << light << distance << spacing;
                    ASSERT_TRUE(std::isfinite(record.longer) && record.longer >= record.shorter);
                    ASSERT_GE(record.shorter, 0);
                    for (const Vec3 at : {record.position, Vec3{1, 2.01f, 3}, Vec3{3e38f, 2, 3}}) {
                        IrradianceMean mean({at, {0, 0.6f, 0.8f}});
                        mean.add(record);
                        ASSERT_TRUE(trace::is_finite(mean.irradiance()));
                        ASSERT_GE(mean.irradiance().x, 0);
                    }
                }
}

TEST(IrradianceCacheSpec, NamesWhatItDoesNotKnow) {
    const auto refuses = [](const char* spec, const char* with) {
        EXPECT_THAT([&] { parse_irradiance_cache(spec); },
                    Throws<trace::UsageError>(Property(&trace::UsageError::what, HasSubstr(with))))
            << spec;
    };
    refuses("bound", "unknown \"bound\"; nearest: bounded; known: ");
    refuses("bounded:leas=2", "unknown parameter \"leas\"; nearest: least");
    refuses("bounded:least=30", "least is 30, expected 0 to 20");
    refuses("split-sphere:tolerance=0", "tolerance is 0, expected 1 to 100");
    refuses("split-sphere:distance=mean", "distance is \"mean\"");
    refuses("hessian:overture=12", "overture is 12, expected a power of two");
    refuses("hessian:distance=minimum", "unknown parameter \"distance\"");
    EXPECT_EQ(
        parse_irradiance_cache("bounded:most=9").text,
        "bounded:tolerance=20,distance=harmonic,gradients=1,neighbours=1,overture=32,rays=0,least=3,most=9,"
        "latency=64,entries=16");
    for (const IrradianceMetric& metric : irradiance_metrics())
        EXPECT_EQ(parse_irradiance_cache(parse_irradiance_cache(metric.name).text).text,
                  parse_irradiance_cache(metric.name).text);
}

}  // namespace
}  // namespace regather::capture
