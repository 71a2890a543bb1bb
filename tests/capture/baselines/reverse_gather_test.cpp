// Photons that search hit points, against sums over all pairs and against the gathers of hit points.
#include "capture/baselines/reverse_gather.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/capture.h"
#include "capture/sampler.h"
#include "replay/verification.h"
#include "replay/walk_store.h"
#include "tests/capture/baselines/furnace.h"
#include "tests/capture/counts.h"
#include "tests/capture/small_scenes.h"
#include "tests/scratch.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

Scene two_materials() {
    Scene scene;
    scene.materials = {{.name = "red", .diffuse = {0.6f, 0.1f, 0.2f}},
                       {.name = "lacquer",
                        .kind = scenes::MaterialKind::glossy,
                        .diffuse = {0.1f, 0.2f, 0.3f},
                        .specular = {0.3f, 0.1f, 0.2f},
                        .exponent = 20}};
    scene.triangle_material = {0, 1};
    return scene;
}

std::vector<trace::Photon> slanted_photons(std::uint32_t count) {
    std::vector<trace::Photon> photons(count);
    Sampler sampler(21, Stream::photon, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const float x = sampler.uniform(), y = 0.6f * sampler.uniform(), up = i % 4 == 0 ? -1.0f : 1.0f;
        photons[i].position = {x * x, y, 0.02f * x};
        trace::encode_power({1 + x, 2, 0.5f}, photons[i].power);
        trace::encode_direction(trace::normalize(Vec3{0.4f, 0.2f, -0.8f * up}), photons[i]);
        trace::encode_normal(trace::normalize(Vec3{0.1f, 0, up}), photons[i]);
    }
    return photons;
}

Queries slanted_points(std::uint32_t count) {
    Queries queries;
    Sampler sampler(22, Stream::photon, 0);
    for (std::uint32_t q = 0; q < count; ++q) {
        const float x = sampler.uniform(), y = 0.6f * sampler.uniform();
        queries.position.push_back({x, y, 0.01f});
        queries.normal.push_back(trace::normalize(Vec3{0.2f, 0.1f, q % 5 == 0 ? -1.0f : 1.0f}));
        queries.direction.push_back(trace::normalize(Vec3{-0.3f, 0.2f, q % 5 == 0 ? 0.7f : -0.7f}));
        queries.triangle.push_back(q % 2);
        queries.pixel.push_back(q / 3);
    }
    return queries;
}

TEST(ReverseGather, IsTheSumOverAllPairsOfAPhotonAndAPointThatItReaches) {
    const Scene scene = two_materials();
    const std::vector<trace::Photon> photons = slanted_photons(300);
    const Queries queries = slanted_points(170);
    ReachingPhotons reaching{photons, {}, {}};
    for (std::size_t i = 0; i < photons.size(); ++i)
        reaching.radius2.push_back(i % 7 == 0 ? 0 : 0.0004f * static_cast<float>(i));
    for (const bool surface_check : {true, false}) {
        ReverseGather reverse(reaching, {.surface_check = surface_check}, 60);
        Gathered gathered;
        reverse.run(scene, queries, nullptr, gathered);
        std::uint64_t pairs = 0;
        for (std::size_t q = 0; q < queries.size(); ++q) {
            Vec3d sum;
            const Material& material = scene.materials[queries.triangle[q]];
            for (std::size_t i = 0; i < photons.size(); ++i) {
                const Vec3 d = photons[i].position - queries.position[q];
                const Vec3 travels = trace::decode_direction(photons[i]);
                if (reaching.radius2[i] == 0 || dot(d, d) > reaching.radius2[i]) continue;
                if (dot(travels, queries.normal[q]) >= 0) continue;
                if (surface_check && dot(trace::decode_normal(photons[i]), queries.normal[q]) <= 0.5f)
                    continue;
                ++pairs;
                const Vec3 f = brdf(material, queries.normal[q], -travels, -queries.direction[q]);
                sum += Vec3d(f * trace::decode_power(photons[i].power)) *
                       (1 / (std::numbers::pi * static_cast<double>(reaching.radius2[i])));
            }
            EXPECT_NEAR(gathered.radiance[q].x, sum.x, 1e-6 * (1 + sum.x)) << q;
            EXPECT_NEAR(gathered.radiance[q].y, sum.y, 1e-6 * (1 + sum.y)) << q;
            EXPECT_NEAR(gathered.radiance[q].z, sum.z, 1e-6 * (1 + sum.z)) << q;
        }
        EXPECT_EQ(reverse.additions(), pairs);
        EXPECT_GT(pairs, 1000u);
    }
}

TEST(ReachingPhotons, ReachTheirKthNearestPhotonAndTheRadiusAtMost) {
    const std::vector<trace::Photon> heap = spatial::left_balanced(slanted_photons(120));
    const float most = 0.06f;
    const ReachingPhotons reaching = reaching_photons(heap, {.k = 9, .radius = most});
    std::uint32_t limited = 0;
    for (std::size_t i = 0; i < heap.size(); ++i) {
        std::vector<float> distance2;
        for (const trace::Photon& other : heap) {
            const Vec3 d = heap[i].position - other.position;
            distance2.push_back(dot(d, d));
        }
        std::sort(distance2.begin(), distance2.end());
        EXPECT_EQ(reaching.radius2[i], std::min(distance2[8], most * most)) << i;
        limited += distance2[8] > most * most ? 1 : 0;
    }
    EXPECT_GT(limited, 5u);
    EXPECT_LT(limited, 115u);
}

// As the furnace of precomputed_irradiance_test.cpp: 1 W on 1 m^2, seen at points far from the edge.
TEST(ReverseGather, OfAnEvenFurnaceIsTheFurnacesAtAnyK) {
    constexpr std::uint32_t count = 4000;
    const Furnace furnace = even_furnace(6, count, 2000);
    for (const std::uint32_t k : {4u, 40u})
        for (const Filter filter : {Filter::none, Filter::cone}) {
            const GatherConfig config{.k = k, .filter = filter};
            ReverseGather reverse(reaching_photons(furnace.heap, config), config, 1);
            Gathered gathered;
            reverse.run(furnace.white, furnace.queries, nullptr, gathered);
            double mean = 0;
            for (const Vec3 radiance : gathered.radiance) mean += static_cast<double>(radiance.x);
            mean *= std::numbers::pi / static_cast<double>(furnace.queries.size());
            // Of points and of photons, each about 1 / sqrt(count) over the k that a point sees.
            EXPECT_NEAR(mean, furnace.power, 4 * std::sqrt(1.0 / 2000 / k * 2 + 1.0 / count)) << k;
        }
}

CaptureConfig reversed(std::uint32_t pixels) {
    CaptureConfig config;
    config.pixels = {.width = 24, .height = 18, .gather_rays = 16, .shadow_rays = 2, .seed = 5};
    config.photon = {.photons = 1000, .seed = 5};
    config.gather.k = 40;
    config.reverse_pixels = pixels;
    return config;
}

TEST(ReverseGather, ShowsWhatGatheringShowsInAnyNumberOfPasses) {
    const scenes::Scene scene = closed_box(0.6);
    const Captured gathered = capture(scene, reversed(0)), once = capture(scene, reversed(432)),
                   thrice = capture(scene, reversed(150));
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < once.image.pixels.size(); ++i) {
        difference += static_cast<double>(once.image.pixels[i].x) - gathered.image.pixels[i].x;
        sum += static_cast<double>(gathered.image.pixels[i].x);
    }
    EXPECT_NEAR(difference / sum, 0, 0.02);
    EXPECT_EQ(once.image.pixels, thrice.image.pixels);
    EXPECT_EQ(count(once.info.counts, "reverse_passes"), 1u);
    EXPECT_EQ(count(thrice.info.counts, "reverse_passes"), 3u);
    EXPECT_EQ(count(once.info.counts, "reverse_points"), gathered.info.queries);
    EXPECT_EQ(count(once.info.counts, "reverse_additions"), count(thrice.info.counts, "reverse_additions"));
}

TEST(ReverseGather, TracesAreTheSearchesOnAnyNumberOfThreads) {
    const Scratch scratch;
    const scenes::Scene scene = closed_box(0.6);
    std::vector<std::string> checksums;
    for (const std::size_t threads : {1, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        trace::TraceWriter writer(scratch / "trace", true), precompute(scratch / "precompute", true),
            reverse(scratch / "reverse", true);
        TraceWriters writers{&writer, {}};
        writers.beside[Beside::precompute] = &precompute;
        writers.beside[Beside::reverse] = &reverse;
        Captured found = capture(scene, reversed(200), writers);
        precompute.finish(*found.beside[Beside::precompute]);
        reverse.finish(*found.beside[Beside::reverse]);
        writer.finish(found.info);
        trace::TraceReader hits(scratch / "trace"), radii(scratch / "precompute"),
            photons(scratch / "reverse");
        EXPECT_EQ(photons.info().queries, 3u * 1000);
        EXPECT_EQ(radii.info().found_photons, 1000u * 40);
        replay::verify(hits);
        EXPECT_TRUE(replay::verify(radii).searched);
        replay::verify(photons);
        // A visit of a pixel's sum for each photon that lights a point, of points behind all sums.
        const replay::WalkStore walks(photons);
        const auto decoder = walks.structure().decoder();
        std::uint64_t additions = 0;
        for (std::uint64_t q = 0; q < walks.queries(); ++q)
            for (const std::uint32_t element : decoder->decode(walks.walk(q)).elements)
                additions += element < 24u * 18 ? 1 : 0;
        EXPECT_EQ(additions, count(found.info.counts, "reverse_additions"));
        checksums.push_back(hits.checksum() + radii.checksum() + photons.checksum());
    }
    EXPECT_EQ(checksums[0], checksums[1]);
}

TEST(ReverseGather, IsRefusedBesideWhatGathersOtherwise) {
    CaptureConfig config = reversed(100);
    config.precompute_every = 2;
    EXPECT_THROW(capture(closed_box(0.6), config), trace::UsageError);
    config = reversed(100);
    config.pixels.irradiance_cache = "bounded";
    EXPECT_THROW(capture(closed_box(0.6), config), trace::UsageError);
    config = reversed(100);
    config.record = PhotonRecord::packed;
    EXPECT_THROW(capture(closed_box(0.6), config), trace::UsageError);
}

}  // namespace
}  // namespace regather::capture
