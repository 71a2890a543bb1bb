#include "trace/packed_photon.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace regather::trace {
namespace {

Photon photon_at(Vec3 position) {
    Photon photon{.position = position, .theta = 7, .phi = 250, .flags = 0xa5c2};
    const std::uint8_t power[4] = {3, 200, 77, 131};
    std::memcpy(photon.power, power, sizeof power);
    return photon;
}

bool same(const Photon& a, const Photon& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Photons in a box of three quite different edges, anywhere.
std::vector<Photon> any_photons() {
    std::vector<Photon> photons;
    const auto tenth = [] { return static_cast<float>(*rc::gen::inRange(-1000000, 1000001)) / 1e6f; };
    const Vec3 edge{3 * std::fabs(tenth()), 40, 0.001f + std::fabs(tenth())};
    const Vec3 middle{100 * tenth(), 7 * tenth(), tenth()};
    const int count = *rc::gen::inRange(1, 40);
    for (int i = 0; i < count; ++i)
        photons.push_back(photon_at(middle + edge * Vec3{tenth(), tenth(), tenth()}));
    return photons;
}

TEST(PackedPhoton, APositionIsOffByHalfAStepAtMostAndTheRestIsKept) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> photons = any_photons();
        const Packing packing(photons);
        for (const Photon& photon : photons) {
            Photon back = packing.unpack(packing.pack(photon));
            for (int axis = 0; axis < 3; ++axis) {
                const double at = static_cast<double>(photon.position[axis]),
                             rounding = std::fabs(at) * 0x1p-23;
                RC_ASSERT(std::fabs(static_cast<double>(back.position[axis]) - at) <=
                          packing.step(axis) / 2 + rounding);
            }
            back.position = photon.position;
            RC_ASSERT(same(back, photon));
        }
    }));
}

TEST(PackedPhoton, StepsDivideTheBoxOfTheseVeryPhotons) {
    // 2097151 steps an axis: of 2097151 m one metre each, of 4194302 m two; none along the third.
    const std::vector<Photon> photons{photon_at({-1, 10, 5}), photon_at({2097150, 4194312, 5}),
                                      photon_at({2.25f, 16.5f, 5}), photon_at({2.75f, 17.5f, 5})};
    const Packing packing(photons);
    EXPECT_EQ(packing.step(0), 1);
    EXPECT_EQ(packing.step(1), 2);
    EXPECT_EQ(packing.step(2), 0);
    EXPECT_EQ(packing.pack(photons[0]).position, 0u);
    EXPECT_EQ(packing.pack(photons[1]).position, 2097151u | std::uint64_t{2097151} << 21);
    EXPECT_EQ(packing.pack(photons[2]).position, 3u | 3u << 21);  // 3.25 of one, 3.25 of two
    EXPECT_EQ(packing.pack(photons[3]).position, 4u | std::uint64_t{4} << 21);
    EXPECT_EQ(packing.unpack(packing.pack(photons[2])).position, (Vec3{2, 16, 5}));
    EXPECT_EQ(packing.unpack(packing.pack(photons[3])).position, (Vec3{3, 18, 5}));
}

TEST(PackedPhoton, FacesOfTheBoxStayAndASecondPackingChangesNothing) {
    ASSERT_TRUE(rc::check([] {
        std::vector<Photon> photons = any_photons();
        const std::vector<Photon> before = photons;
        pack_positions(photons);
        for (int axis = 0; axis < 3; ++axis) {
            const auto along = [&](const Photon& a, const Photon& b) {
                return a.position[axis] < b.position[axis];
            };
            const auto [low, high] = std::minmax_element(before.begin(), before.end(), along);
            const auto [low_after, high_after] = std::minmax_element(photons.begin(), photons.end(), along);
            RC_ASSERT(low_after->position[axis] == low->position[axis]);
            RC_ASSERT(high_after->position[axis] == high->position[axis]);
        }
        const std::vector<Photon> once = photons;
        RC_ASSERT(pack_positions(photons) == 0);
        for (std::size_t i = 0; i < photons.size(); ++i) RC_ASSERT(same(photons[i], once[i]));
    }));
}

TEST(PackedPhoton, TellsHowFarOneMovedAtMost) {
    std::vector<Photon> photons{photon_at({0, 0, 5}), photon_at({2097151, 4194302, 5}),
                                photon_at({7.25f, 8, 5}), photon_at({3.25f, 4.5f, 5})};
    EXPECT_DOUBLE_EQ(pack_positions(photons), std::hypot(0.25, 0.5));
    std::vector<Photon> none;
    EXPECT_EQ(pack_positions(none), 0);
}

}  // namespace
}  // namespace regather::trace
