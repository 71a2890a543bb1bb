// What orderings do with buffers that the chip cannot hold agrees with the bytes that they count.
#include "reorder/buffer_use.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reorder/catalogue.h"
#include "tests/reorder/buffer_bytes.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

using testing::ElementsAre;

BufferUse use_of(std::string_view spec, const Queries& queries, std::uint64_t onchip_bytes) {
    const auto ordering = make_ordering(spec);
    const Workload work = queries.workload();
    return ordering->buffer_use(work, onchip_bytes, order(*ordering, work, onchip_bytes).permutation);
}

std::vector<std::string> with_buffers() {
    std::vector<std::string> with_buffers{
        "hilbert:tile=5",
        "morton:tile=3",
        "swizzle:tile=64",
        "kd-leaf:tile=1",
        "direction-binned:tile=7,bins=3",
        "direction-binned:tile=7,bins=3,passes=2",
        "direction-binned:tile=7,bins=3,passes=1",
        "direction-binned:tile=7,bins=3,state=recast",
        "hashed:buckets=3,capacity=2",
        "direction-binned+hashed:tile=7,bins=3,buckets=3,capacity=2",
        "direction-binned+hashed:tile=7,bins=3,buckets=3,capacity=2,state=recast",
        "strata:tile=7,strata=3",
        "strata:tile=7,strata=3,frame=world",
        "strata:tile=7,strata=3,state=recast",
        "strata:tile=7,strata=1",
        "strata+hashed:tile=7,strata=3,buckets=3,capacity=2,frame=world"};
    for (const Entry& entry : catalogue()) with_buffers.emplace_back(entry.name);
    return with_buffers;
}

TEST(BufferUse, BytesWrittenAndReadAreTheCountedOnesForEveryOrdering) {
    ASSERT_TRUE(rc::check([] {
        const Queries queries = any_queries();
        const Workload work = queries.workload();
        for (const std::string& spec : with_buffers()) {
            for (const std::uint64_t onchip : {0u, 30u, 200u, 3000u, 1u << 20}) {
                const auto ordering = make_ordering(spec);
                const Ordered ordered = order(*ordering, work, onchip);
                const BufferUse use = ordering->buffer_use(work, onchip, ordered.permutation);
                RC_ASSERT(use.known);
                RC_ASSERT(written_bytes(use) + read_bytes(use) == ordered.cost.reorder_bytes);
                RC_ASSERT_FALSE(use.batches && use.buckets);
                if (ordered.cost.buffered_bytes <= onchip) RC_ASSERT(use.empty());
            }
        }
    }));
}

TEST(BufferUse, EverySpilledOrderingOfTheCatalogueHasBytes) {
    // else the test above would hold for orderings that say nothing
    Queries queries = one_per_pixel(32, 32);
    queries.direction.assign(1024, {0, 0, 1});
    queries.leaf_kd.assign(1024, 1);
    queries.leaf_bvh.assign(1024, 1);
    queries.stratum.assign(1024, 1);
    queries.end.assign(1024, {});
    queries.guess.assign(1024, {});
    for (const Entry& entry : catalogue()) {
        const bool generative = entry.name == "naive" || entry.name == "random" || entry.name == "tiled";
        EXPECT_EQ(written_bytes(use_of(entry.name, queries, 100)) == 0, generative) << entry.name;
    }
}

TEST(BufferUse, ABatchEndsWhereItsTileEnds) {
    const Queries queries = one_per_pixel(5, 2);  // tiles of 4, 4 and 2 pixels
    EXPECT_THAT(use_of("hilbert:tile=2", queries, 4 * 28 - 1).batches->ends, ElementsAre(4, 8, 10));
    EXPECT_THAT(use_of("hilbert", queries, 10 * 28 - 1).batches->ends, ElementsAre(10));
    EXPECT_TRUE(use_of("hilbert:tile=2", queries, 4 * 28).empty());
}

TEST(BufferUse, ABatchOfMoreThan256ChipsGoesThroughMemoryTwice) {
    const Queries queries = one_per_pixel(257, 1);
    EXPECT_EQ(use_of("hilbert", queries, 29).batches->rounds, 1u);
    EXPECT_EQ(use_of("hilbert", queries, 28).batches->rounds, 2u);
}

TEST(BufferUse, PassesOverATileAreRunsOfItsQueries) {
    // Three pixels, tiles of 2 and 1. Up is in the second of two passes, down in the first.
    Queries queries = one_per_pixel(3, 1);
    queries.direction = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}};
    const BufferUse use = use_of("direction-binned:tile=2,bins=2,passes=2", queries, 2 * 48 - 1);
    ASSERT_TRUE(use.state);
    ASSERT_EQ(use.state->runs.size(), 3u);
    constexpr std::array<std::array<std::uint64_t, 2>, 3> drawn{{{0, 1}, {1, 2}, {3, 3}}};  // pass, end
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(use.state->runs[i].pass, drawn[i][0]);
        EXPECT_EQ(use.state->runs[i].end, drawn[i][1]);
    }
    EXPECT_EQ(written_bytes(use), 3 * 48u);
    EXPECT_EQ(read_bytes(use), 3 * 48u);
}

TEST(BufferUse, BucketsOnTheChipStillSayWhenStateIsRead) {
    Queries queries = one_per_pixel(16, 16);
    queries.direction.assign(256, {0, 0, 1});
    const BufferUse use =
        use_of("direction-binned+hashed:tile=16,bins=2,buckets=2,capacity=2", queries, 4 * 28);
    ASSERT_TRUE(use.state && use.buckets);
    EXPECT_EQ(use.buckets->record_bytes, 0u);
    EXPECT_EQ(written_bytes(use), 256 * 48u);
}

TEST(BufferUse, AnOrderingThatDoesNotSayIsNotKnown) {
    struct Mine final : Ordering {
        Cost assign_keys(const Workload&, std::uint64_t, std::span<std::uint64_t>) const override {
            return {};
        }
    };
    EXPECT_FALSE(Mine().buffer_use({}, 0, {}).known);
}

}  // namespace
}  // namespace regather::reorder
