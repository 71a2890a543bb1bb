// Pictures with a cache of irradiance records: what they save, what they cost, and that they show the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "capture/capture.h"
#include "spatial/listed_columns.h"
#include "tests/capture/counts.h"
#include "tests/capture/small_scenes.h"
#include "tests/scratch.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

CaptureConfig cached(const char* spec) {
    CaptureConfig config;
    config.pixels = {.width = 36,
                     .height = 26,
                     .gather_rays = 48,
                     .shadow_rays = 4,
                     .max_specular = 16,
                     .irradiance_cache = spec,
                     .seed = 3};
    config.photon = {.photons = 10000, .seed = 3};
    config.gather.k = 30;
    config.caustic.photons = 1000;
    return config;
}

Vec3d mean_of(const Image& image) {
    Vec3d sum;
    for (const Vec3 pixel : image.pixels) sum += pixel;
    return sum * (1 / static_cast<double>(image.pixels.size()));
}
/// RMS of the differences, relative to the mean.
double difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Vec3d d = Vec3d(a.pixels[i]) - Vec3d(b.pixels[i]);
        sum += dot(d, d) / 3;
    }
    const Vec3d mean = mean_of(a);
    return std::sqrt(sum / static_cast<double>(a.pixels.size())) / ((mean.x + mean.y + mean.z) / 3);
}

// A gather with 48 rays has noise of its own in each pixel, so the reference takes 300.
TEST(IrradianceCache, ShowsWhatGatheringEveryPixelShowsByFewerRays) {
    const scenes::Scene scene = closed_box(0.5);
    CaptureConfig plain = cached("");
    plain.pixels.gather_rays = 300;
    const Captured truth = capture(scene, plain);
    for (const char* spec :
         {"bounded:least=1,rays=150", "split-sphere:rays=150", "hessian:least=1,rays=150"}) {
        const Captured found = capture(scene, cached(spec));
        EXPECT_LT(difference(truth.image, found.image), 0.04) << spec;
        const Vec3d expected = mean_of(truth.image), mean = mean_of(found.image);
        EXPECT_NEAR(mean.x, expected.x, 0.01 * expected.x) << spec;
        EXPECT_NEAR(mean.z, expected.z, 0.01 * expected.z) << spec;
        ASSERT_TRUE(found.irradiance);
        EXPECT_LT(found.irradiance->records, 36u * 26 / 3) << spec;
        EXPECT_GT(found.irradiance->use.served, 36u * 26 * 9 / 10) << spec;
        EXPECT_FALSE(truth.irradiance);
    }
}

TEST(IrradianceCache, CountsAddUpAndWeightsAreThoseOfThePixel) {
    const Scratch scratch;
    const CaptureConfig config = cached("bounded:overture=16");
    trace::TraceWriter writer(scratch / "trace", false);
    Captured found = capture(closed_box(0.5), config, {&writer});
    writer.finish(found.info);
    trace::TraceReader trace(scratch / "trace");
    // All pixels see diffuse walls or the light, which is black; every ray in the box ends at one of them.
    const std::uint64_t served = count(found.info.counts, "irradiance_points_served"),
                        not_served = count(found.info.counts, "irradiance_points_not_served"),
                        records = count(found.info.counts, "irradiance_records"), cells = 4 * 12;
    EXPECT_LE(served + not_served, 36u * 26);
    EXPECT_GT(served + not_served, 36u * 26 * 9 / 10);
    EXPECT_EQ(count(found.info.counts, "irradiance_rays_saved"), served * 48);
    EXPECT_EQ(count(found.info.counts, "irradiance_rays"), records * cells);
    EXPECT_EQ(count(found.info.counts, "gather_rays"), records * cells + not_served * 48);
    EXPECT_EQ(trace.column<Vec3>("ray_gather_origin").size(), count(found.info.counts, "gather_rays"));
    EXPECT_LE(count(found.info.counts, "irradiance_queries"), records * cells);
    EXPECT_GT(count(found.info.counts, "irradiance_octree_bytes"), 132 * records);
    EXPECT_EQ(*trace.info().parameters.find("irradiance_cache")->text(),
              "bounded:tolerance=20,distance=harmonic,gradients=1,neighbours=1,overture=16,rays=0,least=3,"
              "most=20,latency=64,"
              "entries=16");
    // The first record's queries: albedo / rays each.
    const auto weights = trace.column<Vec3>("query_weight");
    for (std::size_t i = 0; i < 40; ++i) EXPECT_NEAR(weights[i].y, 0.5 / 48, 1e-7);
    EXPECT_EQ(trace.column<std::uint32_t>("query_stratum")[0] >> 16, 65536u / 8) << "the first of four rows";
}

TEST(IrradianceCache, TheImageAndTheTraceAreTheSameOnAnyNumberOfThreads) {
    for (const char* name : {"box", "caustics"}) {
        const scenes::Scene scene = scenes::load_scene(name);
        const auto run = [&] {
            const Scratch scratch;
            CaptureConfig config = cached("hessian:neighbours=1");
            config.pixels.width = config.pixels.height = 12;
            config.pixels.samples = 2;
            trace::TraceWriter writer(scratch / "trace", false);
            Captured found = capture(scene, config, {&writer});
            writer.finish(found.info);
            return std::pair(found.image.pixels, trace::TraceReader(scratch / "trace").checksum());
        };
        const auto expected = run();
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(run(), expected) << name;
    }
}

TEST(IrradianceCache, TheOctreesTraceHoldsEachSearch) {
    const Scratch scratch;
    const CaptureConfig config = cached("bounded");
    trace::TraceWriter writer(scratch / "trace", false), of_octree(scratch / "octree", false);
    TraceWriters writers{&writer, {}};
    writers.beside[Beside::irradiance] = &of_octree;
    Captured found = capture(closed_box(0.5), config, writers);
    of_octree.finish(*found.beside[Beside::irradiance]);
    writer.finish(found.info);
    EXPECT_EQ(found.image.pixels, capture(closed_box(0.5), config).image.pixels);
    trace::TraceReader trace(scratch / "octree");
    const spatial::Listed structure("visits", spatial::open_elements(trace));
    const auto bytes = structure.own_bytes();
    EXPECT_EQ(std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0}), found.irradiance->octree_bytes);
    const spatial::ElementRange records = structure.range_of(trace::Region::irradiance);
    EXPECT_EQ(records.count, found.irradiance->records);
    const IrradianceUse& use = found.irradiance->use;
    EXPECT_EQ(trace.info().queries, use.served + use.not_served);
    const auto walk_bytes = trace.column<std::uint32_t>("query_walk_bytes");
    const auto pixel = trace.column<std::uint32_t>("query_pixel");
    EXPECT_TRUE(std::is_sorted(pixel.begin(), pixel.end()));
    auto walks = trace.column<std::uint8_t>("walk");
    const auto decoder = structure.decoder();
    std::uint64_t visited = 0;
    for (const std::uint32_t length : walk_bytes) {
        const auto [fault, elements] = decoder->decode(walks.first(length));
        ASSERT_EQ(fault, spatial::WalkFault::none);
        ASSERT_EQ(elements.front(), 0u);
        visited += elements.size();
        walks = walks.subspan(length);
    }
    EXPECT_TRUE(walks.empty());
    EXPECT_EQ(visited, trace.info().visited_nodes);
}

TEST(IrradianceCache, SpecularPathsAndGlossySurfacesStayWithTheirMeans) {
    const scenes::Scene scene = scenes::load_scene("caustics");
    const Captured found = capture(scene, cached("bounded:rays=150")), plain = capture(scene, cached(""));
    const Vec3d expected = mean_of(plain.image), mean = mean_of(found.image);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], expected[c], 0.03 * expected[c]);
    EXPECT_GT(found.irradiance->use.served, 0u);
    EXPECT_EQ(found.nonfinite.total(), 0u);
}

TEST(IrradianceCache, IsRefusedWhereItCannotBeObeyed) {
    CaptureConfig packed = cached("bounded");
    packed.record = PhotonRecord::packed;
    EXPECT_THROW(capture(closed_box(0.5), packed), trace::UsageError);
    EXPECT_THROW(capture(closed_box(0.5), cached("bonded")), trace::UsageError);
    EXPECT_THROW(capture(closed_box(0.5), cached("bounded:rays=65537")), trace::UsageError);
}

TEST(IrradianceCache, RoundsAndInsertionsHaveTracesOfTheirOwn) {
    const Scratch scratch;
    const CaptureConfig config = cached("bounded:overture=4,latency=5,entries=2");
    trace::TraceWriter of_rounds(scratch / "rounds", false), of_inserts(scratch / "inserts", false);
    TraceWriters writers;
    writers.beside[Beside::irradiance_rounds] = &of_rounds;
    writers.beside[Beside::irradiance_inserts] = &of_inserts;
    Captured found = capture(closed_box(0.5), config, writers);
    of_rounds.finish(*found.beside[Beside::irradiance_rounds]);
    of_inserts.finish(*found.beside[Beside::irradiance_inserts]);
    EXPECT_EQ(found.image.pixels, capture(closed_box(0.5), config).image.pixels);
    trace::TraceReader rounds(scratch / "rounds"), inserts(scratch / "inserts");
    const IrradianceUse& use = found.irradiance->use;
    EXPECT_EQ(inserts.info().queries, found.irradiance->records);
    // The last round asks all points, the overture those of every fourth, then of every second pixel.
    EXPECT_GT(rounds.info().queries, use.served + use.not_served);
    EXPECT_LT(rounds.info().queries, 2 * (use.served + use.not_served));
    const spatial::Listed structure("visits", spatial::open_elements(inserts));
    EXPECT_EQ(structure.range_of(trace::Region::irradiance).count, found.irradiance->records);
    for (const std::uint32_t pixel : inserts.column<std::uint32_t>("query_pixel")) EXPECT_LT(pixel, 36u * 26);
    const WaitingPixels& waiting = found.irradiance->waiting;
    EXPECT_EQ(waiting.points, use.served + use.not_served);
    EXPECT_LE(waiting.records, waiting.records_unheld);
    EXPECT_LE(waiting.most_waiting, 2u);
    EXPECT_LE(waiting.longest, 5u);
    EXPECT_GT(found.irradiance->scatter, found.irradiance->scatter_of_all) << "fewer gathers lie apart";
}

}  // namespace
}  // namespace regather::capture
