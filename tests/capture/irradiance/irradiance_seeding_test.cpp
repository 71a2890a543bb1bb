// Rounds of seeding: the same records on any number of threads, and what each round wants.
#include "capture/irradiance/irradiance_seeding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "capture/light/surface.h"
#include "capture/ray_caster.h"
#include "capture/view_plane.h"
#include "tests/capture/irradiance/rectangle_light.h"
#include "tests/capture/small_scenes.h"

namespace regather::capture {
namespace {

/// What a camera of so many pixels sees of the closed box, and what comes from there.
struct Seen {
    static constexpr std::uint32_t width = 44, height = 30;
    const scenes::Scene scene = closed_box(0.5);
    const RayCaster caster{scene};
    const HemisphereGrid grid{4, 12};
    std::vector<SeedPoint> points;

    Seen() {
        const ViewPlane plane(scene.camera, width, height);
        const auto hit_at = [&](std::uint32_t column, std::uint32_t row) {
            return caster.closest(scene.camera.position, plane.direction(static_cast<float>(column) + 0.5f,
                                                                         static_cast<float>(row) + 0.5f));
        };
        for (std::uint32_t row = 0; row < height; ++row)
            for (std::uint32_t column = 0; column < width; ++column)
                if (const auto hit = hit_at(column, row))
                    points.push_back({{hit->position, hit->geometric_normal}, column, row, 0.02});
    }
    /// A smooth light over the walls.
    void gather(std::uint32_t point, std::span<Incoming> incoming) const {
        const IrradiancePoint& at = points[point].point;
        const Frame frame(at.normal);
        const auto all = hemisphere(
            grid, frame,
            [&](Incoming& sample) {
                const auto hit = caster.closest(caster.offset(at.position, at.normal), sample.direction);
                if (!hit) return;
                sample.distance = hit->distance;
                sample.radiance = {1 + hit->position.x, 2 - hit->position.y, hit->position.z};
            },
            point);
        std::copy(all.begin(), all.end(), incoming.begin());
    }
    IrradianceSeeding seeding(const IrradianceCacheSpec& spec) const {
        return {points, spec, grid, trace::Bounds3{{0, 0, 0}, {1, 1, 1}}, 1.8};
    }
    void run(IrradianceSeeding& seeding) const {
        seed(seeding, grid,
             [&](std::uint32_t point, std::span<Incoming> incoming) { gather(point, incoming); });
    }
};

TEST(IrradianceSeeding, RecordsAreTheSameOnAnyNumberOfThreads) {
    const Seen seen;
    for (const char* text : {"split-sphere", "bounded:overture=8", "hessian:neighbours=1,overture=16"}) {
        const IrradianceCacheSpec spec = parse_irradiance_cache(text);
        IrradianceSeeding alone = seen.seeding(spec), together = seen.seeding(spec);
        {
            const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
            seen.run(alone);
        }
        {
            const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
            seen.run(together);
        }
        ASSERT_EQ(alone.octree().size(), together.octree().size()) << text;
        EXPECT_GT(alone.octree().size(), 10u) << text;
        for (std::uint32_t r = 0; r < alone.octree().size(); ++r) {
            using Bytes = std::array<std::uint8_t, sizeof(IrradianceRecord)>;
            ASSERT_EQ(std::bit_cast<Bytes>(alone.octree().record(r)),
                      std::bit_cast<Bytes>(together.octree().record(r)))
                << text << " " << r;
        }
        EXPECT_TRUE(alone.octree().share_structure()->same_as(*together.octree().share_structure()));
    }
}

// 44 x 30 pixels: 6 x 4 of every eighth, all of them wanted; then 11 x 8 of every fourth less those 24, of
// which those are wanted that no record of the first round serves at half the tolerance; and so on.
TEST(IrradianceSeeding, ARoundWantsWhatTheRoundsBeforeDoNotServe) {
    const Seen seen;
    ASSERT_EQ(seen.points.size(), std::size_t{Seen::width * Seen::height});
    const IrradianceCacheSpec spec = parse_irradiance_cache("bounded:overture=8,tolerance=30");
    IrradianceSeeding seeding = seen.seeding(spec);
    std::vector<std::uint32_t> wanted;
    std::vector<IrradianceRecord> before;
    const std::uint32_t steps[] = {8, 4, 2, 1}, asked[] = {24, 88 - 24, 330 - 88, 1320};
    for (std::size_t round = 0; round < 4; ++round) {
        ASSERT_TRUE(seeding.next(wanted));
        const double tolerance = round < 3 ? 0.15 : 0.3;
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < seen.points.size(); ++i) {
            const SeedPoint& at = seen.points[i];
            const auto is_on = [&](std::uint32_t step) {
                return at.column % step == 0 && at.row % step == 0;
            };
            if (!is_on(steps[round]) || (round > 0 && round < 3 && is_on(steps[round - 1]))) continue;
            if (std::none_of(before.begin(), before.end(),
                             [&](const IrradianceRecord& r) { return serves(r, at.point, tolerance); }))
                expected.push_back(i);
        }
        EXPECT_EQ(wanted, expected) << round;
        EXPECT_EQ(seeding.rounds()[round].asked, asked[round]);
        EXPECT_EQ(seeding.rounds()[round].gathered, wanted.size());
        EXPECT_TRUE(round > 0 || wanted.size() == 24);
        // In two parts, as a renderer that holds so many samples at once does.
        std::vector<Incoming> incoming(wanted.size() * seen.grid.cells());
        for (std::size_t i = 0; i < wanted.size(); ++i)
            seen.gather(wanted[i], std::span(incoming).subspan(i * seen.grid.cells(), seen.grid.cells()));
        const std::size_t half = wanted.size() / 2 * seen.grid.cells();
        const std::uint32_t records = seeding.octree().size();
        seeding.add(std::span(incoming).first(half));
        EXPECT_TRUE(wanted.empty() || seeding.octree().size() == records) << "until the round is over";
        seeding.add(std::span(incoming).subspan(half));
        ASSERT_EQ(seeding.octree().size(), records + wanted.size());
        for (std::size_t i = 0; i < wanted.size(); ++i)
            EXPECT_EQ(seeding.octree().record(records + static_cast<std::uint32_t>(i)).position,
                      seen.points[wanted[i]].point.position);
        before.clear();
        for (std::uint32_t r = 0; r < seeding.octree().size(); ++r)
            before.push_back(seeding.octree().record(r));
    }
    EXPECT_FALSE(seeding.next(wanted));
    EXPECT_TRUE(wanted.empty());
}

// Without clamping each point is served in the end. Large walls need few records, and they say what is there.
TEST(IrradianceSeeding, LargeWallsNeedFewRecords) {
    const Seen seen;
    const IrradianceCacheSpec spec =
        parse_irradiance_cache("bounded:tolerance=40,neighbours=0,least=1,most=40,overture=16");
    IrradianceSeeding seeding = seen.seeding(spec);
    seen.run(seeding);
    EXPECT_LT(seeding.octree().size(), seen.points.size() / 4);
    double error = 0, sum = 0;
    std::vector<Incoming> incoming(seen.grid.cells());
    for (std::uint32_t i = 0; i < seen.points.size(); i += 7) {
        const auto found = seeding.octree().irradiance(seen.points[i].point, spec.tolerance());
        ASSERT_TRUE(found) << i;
        seen.gather(i, incoming);
        const double truth =
            estimate_irradiance(seen.grid, Frame(seen.points[i].point.normal), incoming).brightness();
        error += std::fabs(static_cast<double>(found->x + found->y + found->z) - truth);
        sum += truth;
    }
    EXPECT_LT(error / sum, 0.03);
}

// The same lookups and insertions in an octree that a brute force of the records so far would build.
TEST(IrradianceSeeding, WhatHappenedIsToldAgainAsItHappened) {
    const Seen seen;
    const IrradianceCacheSpec spec = parse_irradiance_cache("bounded:neighbours=1,overture=4");
    IrradianceSeeding seeding = seen.seeding(spec);
    seen.run(seeding);
    struct Touched {
        std::vector<std::uint32_t> nodes, records;
        void node(std::uint32_t number) { nodes.push_back(number); }
        void record(std::uint32_t number) { records.push_back(number); }
    };
    std::uint32_t lookups = 0, records = 0;
    seeding.tell_again(
        [&](std::uint32_t, auto&& repeat) {
            Touched touched;
            repeat(touched);
            ++lookups;
            ASSERT_EQ(touched.nodes.at(0), 0u);
            for (const std::uint32_t r : touched.records) EXPECT_LT(r, records) << "not yet there";
        },
        [&](std::uint32_t point, auto&& repeat) {
            Touched touched;
            repeat(touched);
            ASSERT_EQ(touched.records.back(), records) << "the new one, behind those that clamping reads";
            EXPECT_EQ(seeding.octree().record(records).position, seen.points[point].point.position);
            EXPECT_EQ(std::count(touched.nodes.begin(), touched.nodes.end(), 0u), 2) << "to clamp, to insert";
            ++records;
        });
    std::uint64_t asked = 0;
    for (const SeedingRound& round : seeding.rounds()) asked += round.asked;
    EXPECT_EQ(lookups, asked);
    EXPECT_EQ(records, seeding.octree().size());
    EXPECT_EQ(seeding.point_of_record().size(), records);
}

TEST(IrradianceSeeding, NoPointsNoRecords) {
    const IrradianceCacheSpec spec = parse_irradiance_cache("bounded:overture=1");
    const HemisphereGrid grid(2, 6);
    IrradianceSeeding seeding({}, spec, grid, {}, 1);
    seed(seeding, grid, [](std::uint32_t, std::span<Incoming>) { FAIL(); });
    EXPECT_EQ(seeding.octree().size(), 0u);
    EXPECT_EQ(seeding.rounds().size(), 1u);
}

}  // namespace
}  // namespace regather::capture
