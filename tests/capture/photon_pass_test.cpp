#include "capture/photon_pass.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "tests/capture/small_scenes.h"

namespace regather::capture {
namespace {

PhotonPass trace(const scenes::Scene& scene, std::uint32_t photons, std::uint64_t seed = 1) {
    return trace_photons(scene, RayCaster(scene), LightSampler(scene), {.photons = photons, .seed = seed});
}

Power sum_of(const std::vector<trace::Photon>& photons) {
    Power sum{};
    for (const trace::Photon& photon : photons) {
        const Vec3 power = trace::decode_power(photon.power);
        for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += static_cast<double>(power[c]);
    }
    return sum;
}

constexpr double rgbe = 1.0 / 256;  // of the largest channel: equal photons are all rounded the same way

TEST(PhotonPass, EveryFlightEndsSomewhere) {
    for (const char* name : {"box", "room", "furnace"}) {
        const scenes::Scene scene = scenes::load_scene(name);
        const PhotonTally tally = trace(scene, 20000).tally;
        for (std::size_t c = 0; c < 3; ++c) {
            const double in = tally.emitted[c] + tally.reflected[c];
            const double out =
                tally.stored[c] + tally.escaped[c] + tally.absorbed_by_specular[c] + tally.cut_off[c];
            EXPECT_NEAR(out / in, 1, 1e-6) << name;
        }
    }
}

/// Paths of ten photons on average: most maps end in the middle of one, whose last photons are not stored.
TEST(PhotonPass, PhotonsBeyondTheAskedNumberAreCutOff) {
    const scenes::Scene scene = closed_box(0.9);
    double cut_off = 0;
    for (std::uint32_t count = 1; count <= 30; ++count) {
        const PhotonPass pass = trace(scene, count);
        const PhotonTally& tally = pass.tally;
        // A photon's power is kept to 1 / 256, up or down.
        EXPECT_NEAR(sum_of(pass.photons)[0] / tally.stored[0], 1, 1.0 / 128) << count;
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR((tally.stored[c] + tally.cut_off[c]) / (tally.emitted[c] + tally.reflected[c]), 1,
                        1e-6)
                << count;
        cut_off += tally.cut_off[0] / tally.stored[0];
    }
    EXPECT_GT(cut_off, 1);
}

TEST(PhotonPass, FewPhotonsReachTheDarkRoomOfTheKeyhole) {
    // Each has passed the gap, a hundredth of the bright room's surface, on one of a handful of flights.
    const PhotonPass pass = trace(scenes::load_scene("keyhole"), 50000);
    std::size_t dark = 0;
    for (std::size_t i = 0; i < pass.photons.size(); ++i) {
        if (pass.photons[i].position.x >= 4.75f) continue;
        ++dark;
        ASSERT_EQ(pass.origin[i], PhotonOrigin::surface);
    }
    EXPECT_GT(dark, 500u);
    EXPECT_LT(dark, 5000u);
}

TEST(PhotonPass, TheEmittedPowerIsTheLights) {
    const PhotonTally tally = trace(closed_box(0.5), 20000).tally;
    EXPECT_NEAR(tally.emitted[0], 3, 1e-4);
    EXPECT_NEAR(tally.emitted[1], 2, 1e-4);
    EXPECT_NEAR(tally.emitted[2], 1, 1e-4);
}

TEST(PhotonPass, InABlackClosedBoxThePhotonsHoldTheLightsPower) {
    const PhotonPass pass = trace(closed_box(0), 20000);
    EXPECT_EQ(pass.photons.size(), 20000u);
    EXPECT_EQ(pass.tally.paths, 20000u);
    const Power stored = sum_of(pass.photons);
    EXPECT_NEAR(stored[0], 3, 3 * rgbe);
    EXPECT_NEAR(stored[1], 2, 3 * rgbe);  // relative to the largest channel
    EXPECT_NEAR(stored[2], 1, 3 * rgbe);
    EXPECT_EQ(pass.tally.escaped[0], 0);
}

TEST(PhotonPass, ThroughAnOpenFloorTheRestEscapes) {
    const PhotonPass pass = trace(closed_box(0, true), 20000);
    EXPECT_GT(pass.tally.escaped[0], 0.3);
    EXPECT_NEAR(sum_of(pass.photons)[0], 3 - pass.tally.escaped[0], 3 * rgbe);
}

TEST(PhotonPass, InAClosedBoxOfAlbedoAEachWattIsStoredOneOverOneMinusATimes) {
    for (const double albedo : {0.5, 0.9}) {
        // The light's back absorbs: it covers 0.2 x 0.2 of the 6 square metres, twice seen; leave 2 % for it.
        const PhotonPass pass = trace(closed_box(albedo), 100000);
        const double expected = 3 / (1 - albedo);
        const double paths = static_cast<double>(pass.tally.paths);
        const double error = expected * std::sqrt(albedo / paths);  // geometric number of hits
        EXPECT_NEAR(pass.tally.stored[0], expected, 4 * error + 0.02 * expected * albedo / (1 - albedo) / 3);
    }
}

TEST(PhotonPass, ExactlyTheAskedNumberIsStored) {
    for (const std::uint32_t count : {1u, 7u, 4096u, 70001u})
        EXPECT_EQ(trace(closed_box(0.8), count).photons.size(), count);
    EXPECT_TRUE(trace(closed_box(0.8), 0).photons.empty());
}

TEST(PhotonPass, WithoutLightsThereAreNoPhotons) {
    scenes::Scene dark = closed_box(0.5);
    dark.lights.clear();
    dark.triangle_light.assign(dark.triangle_light.size(), -1);
    EXPECT_TRUE(trace(dark, 100).photons.empty());
}

TEST(PhotonPass, LightThatMeetsNothingEnds) {
    scenes::Scene lonely = light_over_floor();
    lonely.lights[0].edge_u = {1, 0, 0};  // faces up, away from the floor
    lonely.lights[0].edge_v = {0, 1, 0};
    const PhotonPass pass = trace(lonely, 10);
    EXPECT_TRUE(pass.photons.empty());
    EXPECT_NEAR(pass.tally.escaped[0] / pass.tally.emitted[0], 1, 1e-9);
}

TEST(PhotonPass, TheSameBytesOnAnyNumberOfThreads) {
    const scenes::Scene scene = scenes::load_scene("box");
    const PhotonPass two = trace(scene, 100000);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const PhotonPass one = trace(scene, 100000);
    ASSERT_EQ(one.photons.size(), two.photons.size());
    EXPECT_EQ(
        0, std::memcmp(one.photons.data(), two.photons.data(), one.photons.size() * sizeof(trace::Photon)));
    EXPECT_EQ(one.tally.stored, two.tally.stored);
}

}  // namespace
}  // namespace regather::capture
