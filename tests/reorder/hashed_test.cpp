#include "reorder/hashed.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <deque>

#include "reorder/catalogue.h"
#include "reorder/cell.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// Queries on a line, at the cells of the letters: 'A' in cell 0 and 'B' in cell 1 of two.
Queries line_of(std::string_view letters) {
    Queries queries = one_per_pixel(static_cast<std::uint32_t>(letters.size()), 1);
    for (std::size_t i = 0; i < letters.size(); ++i)
        queries.position[i] = {letters[i] == 'A' ? 0.0f : 1.0f, 0, 0};
    return queries;
}

TEST(Hashed, BucketsOfTheTwoCellsDiffer) {
    EXPECT_EQ(bucket_of(0, 0, 0, 2), 0u);
    EXPECT_EQ(bucket_of(1, 0, 0, 2), 1u);  // 73856093 is odd
}

// Queries      0 1 2 3 4 5 6 7
// at           A B A A B B B A      buckets A and B hold 2
//
// made                  A     B     processed
// 0A 1B 2A              0 2   1     3A does not fit: stall 1; A is fullest and becomes active
//                       2     1     0
// 3A 4B                 2 3   1 4   5B does not fit: stall 2; A stays active until it is empty
//                       3     1 4   2
//                             1 4   3     A is empty: B is fullest
//                             4     1
// 5B                          4 5         6B does not fit: stall 3
//                             5     4
// 6B 7A                 7     5 6         all made; B stays active
//                       7           5 6
//                                   7
TEST(Hashed, EightQueriesThroughTwoBucketsOfTwo) {
    const Queries queries = line_of("ABAABBBA");
    const Ordered run = order(*make_ordering("hashed:buckets=2,capacity=2,cells=2"), queries.workload());
    EXPECT_EQ(run.permutation, (Numbers{0, 2, 3, 1, 4, 5, 6, 7}));
    EXPECT_EQ(run.cost.stalls, 3u);
}

// A query that waits for several others to be processed stalls the making once.
// 0A 1B 2B: 3B waits. B is full: 1, then 3 is made at once. Now all are made; B: 2 3 stays active, then A.
TEST(Hashed, AtTheEndFullestFirst) {
    EXPECT_EQ(
        order(*make_ordering("hashed:buckets=2,capacity=2,cells=2"), line_of("ABBB").workload()).permutation,
        (Numbers{1, 2, 3, 0}));
    // nothing is ever full: fullest first, and the first of equals
    const Ordered roomy =
        order(*make_ordering("hashed:buckets=2,capacity=8,cells=2"), line_of("BABAB").workload());
    EXPECT_EQ(roomy.permutation, (Numbers{0, 2, 4, 1, 3}));
    EXPECT_EQ(roomy.cost.stalls, 0u);
    EXPECT_EQ(
        order(*make_ordering("hashed:buckets=2,capacity=8,cells=2"), line_of("BABA").workload()).permutation,
        (Numbers{1, 3, 0, 2}));
}

// While A (0 2) is active, 3B waits until B is served: one stall, though two queries are processed meanwhile.
TEST(Hashed, AWaitCountsOnce) {
    // 0A 1B 2A 3B fill both; 4B waits: A active (first of equals), processed 0, 2; then B: 1, 4 is made; 3, 4
    const Ordered run =
        order(*make_ordering("hashed:buckets=2,capacity=2,cells=2"), line_of("ABABB").workload());
    EXPECT_EQ(run.permutation, (Numbers{0, 2, 1, 3, 4}));
    EXPECT_EQ(run.cost.stalls, 1u);
}

TEST(Hashed, CapacityOneOfOneBucketIsCaptureOrder) {
    const Ordered run = order(*make_ordering("hashed:buckets=1,capacity=1"), line_of("ABAB").workload());
    EXPECT_EQ(run.permutation, (Numbers{0, 1, 2, 3}));
    EXPECT_EQ(run.cost.stalls, 3u);
}

/// The paper's sentences one by one, each bucket searched anew.
Numbers plain_machine(const Numbers& bucket, std::uint32_t buckets, std::size_t capacity,
                      std::uint64_t& stalls) {
    std::vector<std::deque<std::uint32_t>> held(buckets);
    Numbers processed;
    std::uint32_t made = 0, active = buckets;
    bool waiting = false;
    while (processed.size() < bucket.size()) {
        while (made < bucket.size() && held[bucket[made]].size() < capacity) {
            held[bucket[made]].push_back(made);
            ++made;
            waiting = false;
        }
        if (made < bucket.size() && !waiting) ++stalls, waiting = true;
        if (active == buckets || held[active].empty()) {
            active = 0;
            for (std::uint32_t other = 1; other < buckets; ++other)
                if (held[other].size() > held[active].size()) active = other;
        }
        processed.push_back(held[active].front());
        held[active].pop_front();
    }
    return processed;
}

TEST(Hashed, EqualsThePlainMachine) {
    ASSERT_TRUE(rc::check([] {
        const Queries queries = any_queries();
        const auto buckets = *rc::gen::inRange<std::uint32_t>(1, 200),
                   capacity = *rc::gen::inRange<std::uint32_t>(1, 9);
        const HashedConfig config{.buckets = buckets, .capacity = capacity, .cells = 8};
        const CellGrid grid(queries.workload().bounds, 8);
        Numbers bucket;
        for (const Vec3 position : queries.position) {
            const Cell cell = is_finite(position) ? grid.cell_of(position) : Cell{8, 8, 8};
            bucket.push_back(bucket_of(cell[0], cell[1], cell[2], buckets));
        }
        std::uint64_t stalls = 0;
        const Numbers expected = plain_machine(bucket, buckets, capacity, stalls);
        const Ordered run = order(Hashed(config), queries.workload());
        RC_ASSERT(run.permutation == expected);
        RC_ASSERT(run.cost.stalls == stalls);
    }));
}

// More than 64^2 buckets: the set of full ones has three levels.
TEST(Hashed, EqualsThePlainMachineWithManyBuckets) {
    constexpr std::uint32_t count = 20'000, buckets = 5'000, cells = 64;
    Queries queries = one_per_pixel(count, 1);
    for (std::uint32_t i = 0; i < count; ++i)
        queries.position[i] = {scrambled_unit(3 * i), scrambled_unit(3 * i + 1), scrambled_unit(3 * i + 2)};
    const CellGrid grid(queries.workload().bounds, cells);
    Numbers bucket;
    for (const Vec3 position : queries.position) {
        const Cell cell = grid.cell_of(position);
        bucket.push_back(bucket_of(cell[0], cell[1], cell[2], buckets));
    }
    std::uint64_t stalls = 0;
    const Numbers expected = plain_machine(bucket, buckets, 2, stalls);
    const Ordered run =
        order(Hashed({.buckets = buckets, .capacity = 2, .cells = cells}), queries.workload());
    EXPECT_EQ(run.permutation, expected);
    EXPECT_EQ(run.cost.stalls, stalls);
}

// Directions put B first in each pass's order: the machine is fed 1 3 | 0 2 (-z before +z), not 0 1 2 3.
TEST(DirectionBinnedHashed, TheMachineIsFedInBinnedOrder) {
    Queries queries = line_of("ABAB");
    queries.direction = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}, {0, 0, -1}};
    // fed B1 B3 A0 A2, capacity 1: B3 waits; 1 | B3 made, A0 waits not: made, A2 waits; B active: 3; A: 0, 2
    const Ordered run =
        order(*make_ordering("direction-binned+hashed:tile=4,bins=2,buckets=2,capacity=1,cells=2"),
              queries.workload());
    EXPECT_EQ(run.permutation, (Numbers{1, 3, 0, 2}));
    EXPECT_EQ(run.cost.stalls, 2u);
    EXPECT_EQ(order(*make_ordering("hashed:buckets=2,capacity=1,cells=2"), queries.workload()).permutation,
              (Numbers{0, 2, 1, 3}));
}

}  // namespace
}  // namespace regather::reorder
