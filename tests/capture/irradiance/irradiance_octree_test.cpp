// The octree of records: what a search finds is what looking at every record finds, and its walks decode.
#include "capture/irradiance/irradiance_octree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <limits>
#include <set>

#include "capture/sampler.h"
#include "spatial/list_walk.h"
#include "tests/capture/irradiance/rectangle_light.h"
#include "tests/spatial/recorded_visits.h"

namespace regather::capture {
namespace {

using testing::ElementsAre;
using trace::Region;

IrradianceRecord circle_at(Vec3 position, float radius) {
    IrradianceRecord record;
    record.position = position;
    record.normal = upwards;
    record.axis = {1, 0, 0};
    record.longer = record.shorter = radius;
    record.irradiance = {1, 1, 1};
    return record;
}

/// Half of them on a grid, so that points are at equal distances and on the planes of cells; some beyond the
/// box.
struct AnyRecords {
    Sampler sampler;
    explicit AnyRecords(std::uint64_t seed) : sampler(seed, Stream::gather, 5) {}
    float coordinate() {
        if (sampler.below(2) == 0) return (static_cast<float>(sampler.below(20)) - 2) * 0.5f;
        return sampler.uniform() * 10 - 1;
    }
    Vec3 position() { return {coordinate(), coordinate(), coordinate()}; }
    Vec3 normal() {
        const Vec3 normals[] = {upwards, upwards, upwards, {0, -0.28f, 0.96f}, {0.96f, 0.28f, 0}};
        return normals[sampler.below(5)];
    }
    IrradianceRecord record() {
        const float radii[] = {0, 0.1f, 0.5f, 2, 5, 2.5f, 12, 1e30f};
        IrradianceRecord found = circle_at(position(), radii[sampler.below(8)]);
        found.normal = normal();
        found.axis = {0, 1, 0};
        if (sampler.below(3) == 0) found.shorter = found.longer / 2;
        found.irradiance = {sampler.uniform(), 2, 3};
        found.translation[0] = {sampler.uniform(), -1, 0};
        return found;
    }
};
const trace::Bounds3 records_box{{0, 0, 0}, {8, 6, 8}};

TEST(IrradianceOctree, FindsWhatLookingAtEveryRecordFindsAndItsWalksDecode) {
    ASSERT_TRUE(rc::check([] {
        AnyRecords any(*rc::gen::arbitrary<std::uint64_t>());
        const double most = *rc::gen::element(0.2, 0.5, 1.0);
        IrradianceOctree octree(records_box, most, *rc::gen::arbitrary<bool>());
        const auto count = *rc::gen::inRange<std::uint32_t>(0, 120);
        for (std::uint32_t i = 0; i < count; ++i) RC_ASSERT(octree.insert(any.record()) == i);
        RC_ASSERT(octree.size() == count);
        const auto structure = octree.share_structure();
        const auto decoder = structure->decoder();
        for (int i = 0; i < 60; ++i) {
            IrradiancePoint point{any.position(), any.normal()};
            if (count > 0 && i % 3 == 0) {  // at the end of a record's reach
                const IrradianceRecord& near = octree.record(any.sampler.below(count));
                const auto reach = static_cast<float>(std::fmin(reach_of(near, most), 20));
                point = {near.position, near.normal};
                point.position[static_cast<int>(any.sampler.below(3))] +=
                    (any.sampler.below(2) == 0 ? 0.99f : -0.99f) * reach;
            }
            const double tolerance = i % 2 == 0 ? most : most / 2;
            std::set<std::uint32_t> found, expected;
            IrradianceMean mean(point);
            for (std::uint32_t r = 0; r < count; ++r)
                if (serves(octree.record(r), point, tolerance)) {
                    expected.insert(r);
                    mean.add(octree.record(r));
                }
            spatial::RecordedVisits visits;
            OctreeElements<spatial::RecordedVisits> elements{visits, octree.nodes()};
            octree.search(
                point, tolerance, [&](std::uint32_t r) { RC_ASSERT(found.insert(r).second); }, elements);
            RC_ASSERT(found == expected);
            const std::optional<Vec3> irradiance = octree.irradiance(point, tolerance);
            RC_ASSERT(irradiance.has_value() == !expected.empty());
            if (irradiance)
                RC_ASSERT(trace::length(*irradiance - mean.irradiance()) <=
                          1e-5f * trace::length(*irradiance));

            visits.recorder.finish();
            const auto [fault, decoded] = decoder->decode(visits.recorder.bytes());
            RC_ASSERT(fault == spatial::WalkFault::none);
            RC_ASSERT(std::vector<std::uint32_t>(decoded.begin(), decoded.end()) == visits.visited);
            // Each once, and below one that was visited before.
            std::set<std::uint32_t> seen;
            for (const std::uint32_t element : visits.visited) {
                RC_ASSERT(element == 0 || seen.contains(structure->elements().parent[element]));
                RC_ASSERT(seen.insert(element).second);
            }
        }
    }));
}

// A box of 8, a = 1/2. R = 2 reaches 1: the cell of 2, two steps down. R = 2.1 needs the one of 4.
TEST(IrradianceOctree, ARecordStandsInTheSmallestCellOfTwiceItsReach) {
    IrradianceOctree octree({{0, 0, 0}, {8, 8, 8}}, 0.5, false);
    const auto level_of = [&](const IrradianceRecord& record) {
        const std::uint32_t number = octree.insert(record);
        return octree.share_structure()->level(octree.nodes() + number) - 1;
    };
    EXPECT_EQ(level_of(circle_at({1, 1, 1}, 1.99f)), 2u);
    EXPECT_EQ(level_of(circle_at({1, 1, 1}, 2.01f)), 1u);
    EXPECT_EQ(level_of(circle_at({7, 1, 1}, 4.5f)), 0u);
    EXPECT_EQ(level_of(circle_at({7, 1, 1}, 0.9f)), 3u);
    EXPECT_EQ(level_of(circle_at({7, 1, 1}, 0)), IrradianceOctree::most_levels);
    EXPECT_EQ(level_of(circle_at({9, 1, 1}, 0.1f)), 0u) << "outside of the box";
    IrradianceRecord ellipse = circle_at({7, 7, 7}, 2.01f);
    ellipse.shorter = 1;
    EXPECT_EQ(level_of(ellipse), 1u);
}

// A box of 8, a = 1/2, three records: the root; below it the octants of x < 4 and x > 4; a cell in the first.
TEST(IrradianceOctree, ASearchTouchesTheCellsWithinHalfTheirWidth) {
    IrradianceOctree octree({{0, 0, 0}, {8, 8, 8}}, 0.5, false);
    octree.insert(circle_at({1, 1, 1}, 1.5f));  // cell [0, 2]^3: nodes 1, 2
    octree.insert(circle_at({6, 1, 1}, 3));     // cell [4, 8] x [0, 4]^2: node 3
    octree.insert(circle_at({4, 4, 4}, 7));     // the root
    const auto touches = [&](Vec3 at) {
        spatial::RecordedVisits visits;
        OctreeElements<spatial::RecordedVisits> elements{visits, octree.nodes()};
        octree.search(
            {at, upwards}, 0.5, [](std::uint32_t) {}, elements);
        return visits.visited;
    };
    EXPECT_EQ(octree.nodes(), 4u);
    EXPECT_EQ(octree.bytes(), 4 * 40u + 3 * 132u);
    EXPECT_THAT(touches({1, 1, 1}), ElementsAre(0, 6, 1, 2, 4));
    EXPECT_THAT(touches({2.5f, 1, 1}),
                ElementsAre(0, 6, 1, 2, 4, 3, 5));  // 0.5 from the one, 1.5 from the other
    EXPECT_THAT(touches({6.5f, 1, 1}), ElementsAre(0, 6, 3, 5));
    EXPECT_THAT(touches({1, 7, 7}), ElementsAre(0, 6));
    const auto structure = octree.share_structure();
    EXPECT_THAT(structure->ranges(), ElementsAre(spatial::ElementRange{Region::nodes, 0, 4},
                                                 spatial::ElementRange{Region::irradiance, 4, 3}));
    EXPECT_THAT(structure->elements().parent, ElementsAre(0, 0, 1, 0, 2, 3, 0));
    EXPECT_THAT(structure->own_bytes(), ElementsAre(40, 40, 40, 40, 132, 132, 132));
}

TEST(IrradianceOctree, ClampedRsAreAtMostANeighboursAndTheDistance) {
    ASSERT_TRUE(rc::check([] {
        AnyRecords any(*rc::gen::arbitrary<std::uint64_t>());
        IrradianceOctree octree(records_box, *rc::gen::element(0.2, 0.5, 1.0), true);
        std::vector<IrradianceRecord> plain;
        const auto shrink = [](IrradianceRecord& record, const IrradianceRecord& by) {
            const double most =
                static_cast<double>(by.longer) + trace::length(Vec3d(record.position) - Vec3d(by.position));
            if (most < static_cast<double>(record.longer)) record.longer = static_cast<float>(most);
            record.shorter = std::min(record.shorter, record.longer);
        };
        for (int i = 0; i < 60; ++i) {
            IrradianceRecord record = any.record();
            octree.insert(record);
            for (const IrradianceRecord& other : plain) shrink(record, other);
            for (IrradianceRecord& other : plain) shrink(other, record);
            plain.push_back(record);
        }
        for (std::uint32_t i = 0; i < 60; ++i) {
            RC_ASSERT(octree.record(i).longer == plain[i].longer);
            RC_ASSERT(octree.record(i).shorter == plain[i].shorter);
        }
    }));
}

// By hand: 5 at x = 0; 1 at x = 2 makes it 3; 9 at x = 3 becomes 2 beside the second.
TEST(IrradianceOctree, NeighboursClampBothWays) {
    IrradianceOctree octree({{0, 0, 0}, {4, 4, 4}}, 0.2, true);
    octree.insert(circle_at({0, 1, 1}, 5));
    octree.insert(circle_at({2, 1, 1}, 1));
    octree.insert(circle_at({3, 1, 1}, 9));
    EXPECT_EQ(octree.record(0).longer, 3);
    EXPECT_EQ(octree.record(1).longer, 1);
    EXPECT_EQ(octree.record(2).longer, 2);
    EXPECT_EQ(octree.record(2).shorter, 2);
}

TEST(IrradianceOctree, ABoxWithoutExtentHoldsRecordsToo) {
    IrradianceOctree octree({{1, 1, 1}, {1, 1, 1}}, 0.5, true);
    octree.insert(circle_at({1, 1, 1}, 1));
    octree.insert(circle_at({1, 1, 1}, 0));
    EXPECT_EQ(octree.nodes(), 1u);
    EXPECT_TRUE(octree.irradiance({{1, 1, 1}, upwards}, 0.5));
    EXPECT_FALSE(octree.irradiance({{5, 1, 1}, upwards}, 0.5));
    EXPECT_FALSE(IrradianceOctree({}, 0.5, false).irradiance({{1, 1, 1}, upwards}, 0.5));
}

}  // namespace
}  // namespace regather::capture
