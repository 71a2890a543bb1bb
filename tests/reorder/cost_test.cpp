// Costs of an image of 32 x 16 pixels with 3 queries a pixel, worked out by hand from the model in
// docs/orderings.md.
#include <gtest/gtest.h>

#include "reorder/catalogue.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

constexpr std::uint64_t n = 32 * 16 * 3, record = 28, state = 48;

Queries image() {
    Queries queries;
    queries.width = 32;
    queries.height = 16;
    for (std::uint32_t i = 0; i < n; ++i) queries.pixel.push_back(i / 3);
    queries.position.resize(n);
    queries.direction.assign(n, {0, 0, 1});
    queries.leaf_kd.assign(n, 256);  // 9 bits
    queries.leaf_bvh.assign(n, 0);
    queries.end.assign(n, {});
    queries.guess.assign(n, {});
    return queries;
}

Cost cost_of(std::string_view spec, std::uint64_t onchip_bytes = default_onchip_bytes) {
    const Queries queries = image();
    return order(*make_ordering(spec), queries.workload(), onchip_bytes).cost;
}

TEST(Cost, GeneratingInAnotherOrderCostsNothing) {
    for (const std::string_view spec : {"naive", "tiled", "tiled:rows=alternating", "random"}) {
        const Cost cost = cost_of(spec);
        EXPECT_EQ(cost.keys + cost.key_ops + cost.sort_passes + cost.moved_records + cost.buffered_bytes +
                      cost.reorder_bytes + cost.recast_rays + cost.stalls,
                  0u)
            << spec;
    }
}

TEST(Cost, DirectionBinnedTestsEachQueryInEachPassAndKeepsATilesPixels) {
    const Cost cost = cost_of("direction-binned:tile=8,bins=4");
    EXPECT_EQ(cost.keys, n * 16);
    EXPECT_EQ(cost.key_ops, n * 16 * 75);
    EXPECT_EQ(cost.buffered_bytes, 8 * 8 * state);
    EXPECT_EQ(cost.reorder_bytes, 0u);
    EXPECT_EQ(cost.recast_rays, 0u);
    EXPECT_EQ(cost_of("direction-binned:tile=8,bins=4,passes=5").keys, n * 5);
    EXPECT_EQ(cost_of("direction-binned:tile=4096,bins=4").buffered_bytes,
              32 * 16 * state);                                                 // clipped to the image
    EXPECT_EQ(cost_of("direction-binned:bins=4,passes=1").buffered_bytes, 0u);  // nothing comes later
    // written in the first pass, read in the 15 others
    EXPECT_EQ(cost_of("direction-binned:tile=8,bins=4", 8 * 8 * state).reorder_bytes, 0u);
    EXPECT_EQ(cost_of("direction-binned:tile=8,bins=4", 8 * 8 * state - 1).reorder_bytes,
              32 * 16 * state * 16);
}

TEST(Cost, DirectionBinnedRecastsEachPixelInEachLaterPass) {
    const Cost cost = cost_of("direction-binned:tile=8,bins=4,state=recast", 0);
    EXPECT_EQ(cost.recast_rays, 32u * 16 * 15);
    EXPECT_EQ(cost.buffered_bytes, 0u);
    EXPECT_EQ(cost.reorder_bytes, 0u);
}

TEST(Cost, SortedOrderingsBufferATileOrAll) {
    EXPECT_EQ(cost_of("hilbert").buffered_bytes, n * record);
    EXPECT_EQ(cost_of("hilbert:tile=8").buffered_bytes, 8 * 8 * 3 * record);
    EXPECT_EQ(cost_of("hilbert:tile=12").buffered_bytes,
              12 * 12 * 3 * record);  // the fullest, not a clipped one
}

TEST(Cost, DigitPassesFollowTheCodesBitsAlone) {
    EXPECT_EQ(cost_of("hilbert").sort_passes, 8u);         // 63 bits
    EXPECT_EQ(cost_of("hilbert:tile=8").sort_passes, 6u);  // 48 bits; the tile costs nothing
    EXPECT_EQ(cost_of("morton:bits=10").sort_passes, 4u);  // 30
    EXPECT_EQ(cost_of("swizzle").sort_passes, 2u);         // 12
    EXPECT_EQ(cost_of("swizzle:bits=8").sort_passes, 3u);  // 24
    EXPECT_EQ(cost_of("kd-leaf:tile=8").sort_passes, 2u);  // 9
    EXPECT_EQ(cost_of("bvh-leaf").sort_passes, 0u);        // one leaf
    EXPECT_EQ(cost_of("hilbert").moved_records, 8 * n);
}

TEST(Cost, OperationsOfAKey) {
    EXPECT_EQ(cost_of("swizzle").key_ops, n * (15 + 7));
    EXPECT_EQ(cost_of("morton").key_ops, n * (15 + 49));
    EXPECT_EQ(cost_of("hilbert").key_ops, n * (15 + 49 + 9 * 7));
    EXPECT_EQ(cost_of("hilbert:bits=8").key_ops, n * (15 + 49 + 9 * 4));  // two single levels, two triples
    EXPECT_EQ(cost_of("kd-leaf").key_ops, 0u);
    EXPECT_EQ(cost_of("kd-leaf").keys, n);
}

// A bit of a coordinate: two shifts, an and, an or.
TEST(Cost, OperationsOfARaysKey) {
    EXPECT_EQ(cost_of("origin-end:bits=3").key_ops, n * (15 + 15 + 4 * 18));
    EXPECT_EQ(cost_of("origin-direction:bits=3").key_ops, n * (15 + 23 + 4 * 15));
    EXPECT_EQ(cost_of("origin-end:bits=3").sort_passes, 3u);        // 18 bits
    EXPECT_EQ(cost_of("origin-direction:bits=3").sort_passes, 2u);  // 15
    EXPECT_EQ(cost_of("origin-end").buffered_bytes, n * record);
    EXPECT_EQ(cost_of("origin-end").recast_rays, 0u);
    EXPECT_EQ(cost_of("origin-guess").recast_rays, n);
    EXPECT_EQ(cost_of("origin-end:tile=8").buffered_bytes, 8 * 8 * 3 * record);
}

TEST(Cost, ABufferBeyondTheChipIsDistributedThroughMemory) {
    constexpr std::uint64_t all = n * record;  // 43008
    EXPECT_EQ(cost_of("hilbert", all).reorder_bytes, 0u);
    EXPECT_EQ(cost_of("hilbert", all - 1).reorder_bytes, 2 * all);
    EXPECT_EQ(cost_of("hilbert", all / 256).reorder_bytes, 2 * all);  // 256 parts of 168 B fit just so
    EXPECT_EQ(cost_of("hilbert", all / 256 - 1).reorder_bytes, 2 * 2 * all);  // twice through memory
    EXPECT_EQ(cost_of("hilbert", 0).reorder_bytes, 2 * 2 * all);  // a chip holds one record at least
    EXPECT_EQ(cost_of("hilbert:tile=8", 8 * 8 * 3 * record).reorder_bytes, 0u);
    EXPECT_EQ(cost_of("hilbert:tile=8", 8 * 8 * 3 * record - 1).reorder_bytes, 2 * all);
}

TEST(Cost, HashedProvidesItsBucketsAndWritesEachQueryOnce) {
    const Cost cost = cost_of("hashed:buckets=8,capacity=16", 8 * 16 * record);
    EXPECT_EQ(cost.keys, n);
    EXPECT_EQ(cost.key_ops, n * (15 + 6));
    EXPECT_EQ(cost.moved_records, n);
    EXPECT_EQ(cost.sort_passes, 0u);
    EXPECT_EQ(cost.buffered_bytes, 8 * 16 * record);
    EXPECT_EQ(cost.reorder_bytes, 0u);
    EXPECT_EQ(cost.stalls, n - 16);  // all hash to one bucket: each query after the first 16 waits
    EXPECT_EQ(cost_of("hashed:buckets=8,capacity=16", 8 * 16 * record - 1).reorder_bytes, 2 * n * record);
}

TEST(Cost, BehindDirectionBinsCostsAreSummed) {
    constexpr std::string_view spec = "direction-binned+hashed:tile=8,bins=4,buckets=8,capacity=16";
    constexpr std::uint64_t buckets = 8 * 16 * record, tile = 8 * 8 * state;
    const Cost cost = cost_of(spec, buckets + tile);
    EXPECT_EQ(cost.keys, n * 16 + n);
    EXPECT_EQ(cost.key_ops, n * 16 * 75 + n * 21);
    EXPECT_EQ(cost.moved_records, n);
    EXPECT_EQ(cost.buffered_bytes, buckets + tile);
    EXPECT_EQ(cost.reorder_bytes, 0u);
    // the buckets are placed first, so the pixel state goes out
    EXPECT_EQ(cost_of(spec, buckets + tile - 1).reorder_bytes, 32 * 16 * state * 16);
    EXPECT_EQ(cost_of("direction-binned+hashed:state=recast,bins=2").recast_rays, 32u * 16 * 3);
}

}  // namespace
}  // namespace regather::reorder
