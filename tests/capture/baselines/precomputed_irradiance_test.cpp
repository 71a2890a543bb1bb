// Irradiance at photons against sums over all photons, and what gathers read of it.
#include "capture/baselines/precomputed_irradiance.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "capture/capture.h"
#include "capture/sampler.h"
#include "replay/verification.h"
#include "spatial/photons/nearest_facing.h"
#include "tests/capture/baselines/furnace.h"
#include "tests/capture/small_scenes.h"
#include "tests/scratch.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

/// On two sheets a hand apart that face away from each other, with powers that grow along x.
std::vector<trace::Photon> two_sheets(std::uint32_t count) {
    std::vector<trace::Photon> photons(count);
    Sampler sampler(11, Stream::photon, 0);
    for (trace::Photon& photon : photons) {
        const float x = sampler.uniform(), y = 0.7f * sampler.uniform();
        const bool upper = sampler.uniform() < 0.6f;
        const Vec3 normal{0, 0, upper ? 1.0f : -1.0f};
        photon.position = {x, y, upper ? 0.01f : 0.0f};
        trace::encode_power({1 + x, 2, 0.5f}, photon.power);
        trace::encode_direction(trace::normalize(Vec3{0.4f, 0.2f, upper ? -0.8f : 0.8f}), photon);
        trace::encode_normal(normal, photon);
    }
    return spatial::left_balanced(photons);
}

/// The sum of equation 2 over the k - 1 nearest photons of the point's own side, in the disc to the k-th.
Vec3d irradiance_by_hand(std::span<const trace::Photon> photons, const trace::Photon& at, std::uint32_t k) {
    std::vector<std::pair<float, std::uint32_t>> near;
    for (std::uint32_t i = 0; i < photons.size(); ++i) {
        const Vec3 d = photons[i].position - at.position;
        near.emplace_back(dot(d, d), i);
    }
    std::sort(near.begin(), near.end());
    Vec3d sum;
    for (std::uint32_t i = 0; i + 1 < k; ++i)
        if (dot(trace::decode_normal(photons[near[i].second]), trace::decode_normal(at)) > 0.5f)
            sum += Vec3d(trace::decode_power(photons[near[i].second].power));
    return sum * (1 / (std::numbers::pi * static_cast<double>(near[k - 1].first)));
}

TEST(PrecomputedIrradiance, IsTheSumOverThePhotonsAboutEachThirdPhoton) {
    const std::vector<trace::Photon> heap = two_sheets(400);
    const std::uint32_t k = 17;
    const PrecomputedIrradiance found = precompute_irradiance(heap, 3, {.k = k});
    ASSERT_EQ(found.records.size(), 134u);
    EXPECT_EQ(found.searches.found_photons, 134u * k);
    EXPECT_EQ(found.nonfinite, 0u);
    std::size_t sites = 0;
    for (const trace::Photon& record : found.records) {
        const auto same = std::find_if(heap.begin(), heap.end(), [&](const trace::Photon& photon) {
            return photon.position == record.position;
        });
        ASSERT_NE(same, heap.end());
        ASSERT_EQ((same - heap.begin()) % 3, 0);
        sites += static_cast<std::size_t>(same - heap.begin());
        EXPECT_EQ(record.flags >> 2, same->flags >> 2);  // the normal
        const Vec3d expected = irradiance_by_hand(heap, *same, k);
        const Vec3 irradiance = trace::decode_power(record.power);
        EXPECT_NEAR(irradiance.x, expected.x, expected.y / 120);  // a byte a channel
        EXPECT_NEAR(irradiance.y, expected.y, expected.y / 120);
        EXPECT_NEAR(irradiance.z, expected.z, expected.y / 120);
    }
    EXPECT_EQ(sites, 3u * 134 * 133 / 2);  // each of them
}

TEST(NearestFacing, IsTheNearestPhotonOfThatSideWhateverLiesBefore) {
    const std::vector<trace::Photon> heap = two_sheets(300);
    const spatial::PhotonKd tree(heap);
    Sampler sampler(5, Stream::photon, 1);
    for (const float radius : {std::numeric_limits<float>::infinity(), 0.03f}) {
        spatial::NearestFacing facing(heap, radius);
        std::uint32_t beyond = 0, none = 0;
        for (int i = 0; i < 200; ++i) {
            const float x = sampler.uniform(), y = 0.7f * sampler.uniform();
            const Vec3 point{x, y, 0.01f * static_cast<float>(i % 2)};
            const Vec3 normal = trace::normalize(Vec3{0.5f, 0.3f, i % 3 == 0 ? -1.0f : 1.0f});
            facing.look_for(normal);
            spatial::nearest(tree, point, facing);
            std::pair<float, std::uint32_t> best{radius * radius, ~0u}, any = best;
            for (std::uint32_t node = 0; node < heap.size(); ++node) {
                const Vec3 d = point - heap[node].position;
                const std::pair one{dot(d, d), node};
                any = std::min(any, one);
                if (dot(trace::decode_normal(heap[node]), normal) > 0.5f) best = std::min(best, one);
            }
            ASSERT_EQ(facing.found().has_value(), best.second != ~0u) << i;
            none += facing.found() ? 0 : 1;
            if (!facing.found()) continue;
            EXPECT_EQ(facing.found()->node, best.second) << i;
            beyond += best != any ? 1 : 0;
        }
        EXPECT_GT(beyond, 10u);
        EXPECT_EQ(none > 0, std::isfinite(radius));
    }
}

TEST(LookUp, ReflectsTheIrradianceOfItsOwnSide) {
    Scene scene;
    scene.materials = {{.name = "red", .diffuse = {0.6f, 0.1f, 0.2f}, .specular = {0.9f, 0.9f, 0.9f}},
                       {.name = "lacquer",
                        .kind = scenes::MaterialKind::glossy,
                        .diffuse = {0.1f, 0.2f, 0.3f},
                        .specular = {0.3f, 0.1f, 0.2f},
                        .exponent = 20}};
    scene.triangle_material = {1, 0};
    std::vector<trace::Photon> records(3);
    const std::array<Vec3, 3> position{Vec3{0, 0, 0}, {0.1f, 0, 0}, {0.3f, 0, 0}};
    for (std::size_t i = 0; i < 3; ++i) {
        records[i].position = position[i];
        trace::encode_power(Vec3{8, 4, 2} * static_cast<float>(i + 1), records[i].power);
        trace::encode_normal({0, i == 1 ? -1.0f : 1.0f, 0}, records[i]);
    }
    records = spatial::left_balanced(records);
    Queries queries;
    for (const std::uint32_t triangle : {0u, 1u}) {
        queries.position.push_back({0.19f, 0, 0});
        queries.normal.push_back({0, 1, 0});
        queries.direction.push_back({0, -1, 0});
        queries.triangle.push_back(triangle);
    }
    Gathered gathered;
    const std::vector<std::uint32_t> order{1, 0};
    look_up(scene, records, queries, order, {.k = 100}, gathered);  // 0.1 is nearest, but faces away: 0.3
    const Vec3 irradiance = trace::decode_power(std::find_if(records.begin(), records.end(), [](auto& one) {
                                                    return one.position.x == 0.3f;
                                                })->power);
    for (int c = 0; c < 3; ++c) {
        const auto both = std::array<float, 3>{0.4f, 0.3f, 0.5f}[static_cast<std::size_t>(c)];
        EXPECT_NEAR(gathered.radiance[0][c], both * irradiance[c] / std::numbers::pi, 1e-5);
        EXPECT_NEAR(gathered.radiance[1][c], scene.materials[0].diffuse[c] * irradiance[c] / std::numbers::pi,
                    1e-5);
    }
    EXPECT_EQ(gathered.found_photons, 2u);
    look_up(scene, records, queries, order, {.k = 100, .radius = 0.1f}, gathered);
    EXPECT_EQ(gathered.radiance[0], Vec3{});
    EXPECT_EQ(gathered.found_photons, 0u);
    look_up(scene, records, queries, order, {.k = 100, .radius = 0.1f, .surface_check = false}, gathered);
    EXPECT_GT(gathered.radiance[0].x, 0);
}

// Photons of 1 W in all at random on 1 m^2: every point has irradiance 1. The mean of n of them has a
// standard error of 1 / sqrt(n): 4 of those, and the byte's 1 / 256. Without the photon itself it would be 1
// / 10 less.
TEST(PrecomputedIrradiance, OfAnEvenFurnaceIsTheFurnaces) {
    constexpr std::uint32_t count = 8000, k = 10;
    const Furnace furnace = even_furnace(4, count, 3000);
    const Queries& queries = furnace.queries;
    std::vector<std::uint32_t> order(queries.size());
    std::iota(order.begin(), order.end(), 0u);
    for (const std::uint32_t every : {1u, 4u}) {
        Gathered gathered;
        look_up(furnace.white, precompute_irradiance(furnace.heap, every, {.k = k}).records, queries, order,
                {.k = k}, gathered);
        double mean = 0;
        for (const Vec3 radiance : gathered.radiance) mean += static_cast<double>(radiance.x);
        mean *= std::numbers::pi / static_cast<double>(queries.size());
        EXPECT_NEAR(mean, furnace.power, 4 / std::sqrt(static_cast<double>(count)) + 1 / 256.0) << every;
    }
}

CaptureConfig small_capture(std::uint32_t every) {
    CaptureConfig config;
    config.pixels = {.width = 24, .height = 18, .gather_rays = 16, .shadow_rays = 2, .seed = 5};
    config.photon = {.photons = 2400, .seed = 5};
    config.gather.k = 40;
    config.precompute_every = every;
    return config;
}

TEST(PrecomputedIrradiance, ShowsWhatGatheringShows) {
    const scenes::Scene scene = closed_box(0.6);
    const Captured gathered = capture(scene, small_capture(0));
    for (const std::uint32_t every : {1u, 4u}) {
        const Captured read = capture(scene, small_capture(every));
        double difference = 0, sum = 0;
        for (std::size_t i = 0; i < read.image.pixels.size(); ++i) {
            difference += static_cast<double>(read.image.pixels[i].x) - gathered.image.pixels[i].x;
            sum += static_cast<double>(gathered.image.pixels[i].x);
        }
        EXPECT_NEAR(difference / sum, 0, 0.015) << every;
        EXPECT_NE(read.image.pixels, gathered.image.pixels);
    }
}

TEST(PrecomputedIrradiance, TracesAreTheSearchesOnAnyNumberOfThreads) {
    const Scratch scratch;
    const scenes::Scene scene = closed_box(0.6);
    std::vector<std::string> checksums;
    for (const std::size_t threads : {1, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        trace::TraceWriter writer(scratch / "trace", true), precompute(scratch / "precompute", true);
        TraceWriters writers{&writer, {}};
        writers.beside[Beside::precompute] = &precompute;
        Captured found = capture(scene, small_capture(4), writers);
        precompute.finish(*found.beside[Beside::precompute]);
        writer.finish(found.info);
        trace::TraceReader lookups(scratch / "trace"), searches(scratch / "precompute");
        EXPECT_EQ(lookups.info().k, 1u);
        EXPECT_EQ(lookups.info().photons, 600u);
        EXPECT_EQ(lookups.info().found_photons, lookups.info().queries);
        EXPECT_EQ(searches.info().queries, 600u);
        EXPECT_EQ(searches.info().found_photons, 600u * 40);
        EXPECT_TRUE(replay::verify(lookups).searched);
        EXPECT_TRUE(replay::verify(searches).searched);
        EXPECT_THROW(replay::refuse_normals(lookups), trace::DataError);
        EXPECT_NO_THROW(replay::refuse_normals(searches));
        checksums.push_back(lookups.checksum() + searches.checksum());
    }
    EXPECT_EQ(checksums[0], checksums[1]);
}

TEST(PrecomputedIrradiance, IsRefusedBesidePackedPhotons) {
    CaptureConfig config = small_capture(1);
    config.record = PhotonRecord::packed;
    EXPECT_THROW(capture(closed_box(0.6), config), trace::UsageError);
}

}  // namespace
}  // namespace regather::capture
