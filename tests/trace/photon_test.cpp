#include "trace/photon.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

namespace regather::trace {
namespace {

// A step is 1/256 of the power of two above the largest channel: at most 1/128 of that channel. Half a step
// is what a channel may be off; less than a step is nothing.
TEST(Photon, RgbeKeepsEachChannelWithinHalfAStepWhichIsAtMost256thOfTheLargest) {
    ASSERT_TRUE(rc::check([] {
        const auto channel = [] {
            return std::ldexp(static_cast<float>(*rc::gen::inRange(0, 1 << 20)), -*rc::gen::inRange(0, 12));
        };
        const float scale = std::ldexp(1.0f, *rc::gen::inRange(-100, 90));
        const Vec3 power{channel() * scale, channel() * scale, channel() * scale};
        std::uint8_t rgbe[4];
        encode_power(power, rgbe);
        const Vec3 decoded = decode_power(rgbe);
        const float largest = max_component(power);
        const float step = largest > 0 ? std::exp2(std::floor(std::log2(largest)) + 1) / 256 : 0;
        for (int c = 0; c < 3; ++c) {
            if (power[c] < step) {
                RC_ASSERT(decoded[c] == 0);
            } else {
                RC_ASSERT(std::fabs(decoded[c] - power[c]) <= step / 2);
            }
        }
        RC_ASSERT(std::fabs(max_component(decoded) - largest) <= largest / 256);
    }));
}

TEST(Photon, RgbeOfKnownTriples) {
    std::uint8_t rgbe[4];
    encode_power({1, 0.5f, 0.25f}, rgbe);  // 1 = 0.5 x 2^1: mantissas 128, 64, 32; exponent 1 + 128
    EXPECT_EQ(rgbe[0], 128);
    EXPECT_EQ(rgbe[1], 64);
    EXPECT_EQ(rgbe[2], 32);
    EXPECT_EQ(rgbe[3], 129);
    encode_power({0, 0, 0}, rgbe);
    EXPECT_EQ(decode_power(rgbe), Vec3{});
    encode_power({1e38f, 0, 0}, rgbe);
    EXPECT_TRUE(is_finite(decode_power(rgbe)));
    encode_power({1e-42f, 0, 0}, rgbe);
    EXPECT_EQ(decode_power(rgbe), Vec3{});
}

TEST(Photon, RgbeHasNoBiasOverManyPowers) {
    double sum = 0, decoded_sum = 0;
    for (int i = 0; i < 100000; ++i) {
        const float value = 0.5f + static_cast<float>(i) / 200000;
        std::uint8_t rgbe[4];
        encode_power({value, value, value}, rgbe);
        sum += value;
        decoded_sum += decode_power(rgbe).x;
    }
    EXPECT_NEAR(decoded_sum / sum, 1, 1e-4);
}

TEST(Photon, DirectionsComeBackWithin0_02Radians) {
    ASSERT_TRUE(rc::check([] {
        const double z = *rc::gen::inRange(-1000, 1001) / 1000.0,
                     phi = *rc::gen::inRange(0, 10000) * 6.283185307179586e-4;
        const double r = std::sqrt(1 - z * z);
        const Vec3 direction{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                             static_cast<float>(z)};
        Photon photon;
        encode_direction(direction, photon);
        const Vec3 decoded = decode_direction(photon);
        RC_ASSERT(std::fabs(length(decoded) - 1) < 1e-5f);
        RC_ASSERT(length(decoded - direction) < 0.02f);
    }));
}

TEST(Photon, NormalsComeBackWithin0_034RadiansAndLeaveTheAxisAlone) {
    ASSERT_TRUE(rc::check([] {
        const double z = *rc::gen::inRange(-1000, 1001) / 1000.0,
                     phi = *rc::gen::inRange(0, 10000) * 6.283185307179586e-4;
        const double r = std::sqrt(1 - z * z);
        const Vec3 normal{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                          static_cast<float>(z)};
        Photon photon;
        photon.flags = static_cast<std::uint16_t>(*rc::gen::inRange(0, 3));
        const int axis = photon.flags;
        encode_normal(normal, photon);
        RC_ASSERT((photon.flags & 3) == axis);
        RC_ASSERT(length(decode_normal(photon) - normal) < 0.034f);
    }));
}

TEST(Photon, NormalsAlongTheAxesAreExactAndNoNormalIsNone) {
    for (const Vec3 normal :
         {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
        Photon photon;
        encode_normal(normal, photon);
        EXPECT_EQ(decode_normal(photon), normal);
    }
    EXPECT_EQ(decode_normal(Photon{}), Vec3{});
}

}  // namespace
}  // namespace regather::trace
