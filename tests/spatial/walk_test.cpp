#include "spatial/walk.h"
#include "spatial/heap_walk.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <functional>

#include "spatial/photons/left_balanced.h"
#include "spatial/photons/nearest.h"
#include "spatial/photons/recording.h"
#include "tests/spatial/photons.h"

namespace regather::spatial {
namespace {

/// Visited nodes, counted from 0; none for a faulty walk.
std::vector<std::uint32_t> nodes(HeapWalkDecoder& decoder, std::span<const std::uint8_t> walk) {
    const auto [fault, slots] = decoder.decode(walk);
    std::vector<std::uint32_t> list;
    if (fault == WalkFault::none)
        for (const std::uint32_t slot : slots) list.push_back(slot - 1);
    return list;
}
std::vector<std::uint32_t> nodes(std::uint32_t photons, std::span<const std::uint8_t> walk) {
    HeapWalkDecoder decoder(photons);
    return nodes(decoder, walk);
}

struct RecordedSearch {
    std::vector<std::uint32_t> visited;
    WalkRecorder recorder;
    void visit(std::uint32_t node) {
        visited.push_back(node);
        recorder.visit(node);
    }
    void near(bool upper) { recorder.near(upper); }
    void far(bool entered) { recorder.far(entered); }
};

TEST(Walk, TheBitsOfASmallSearchAreThoseDrawnByHand) {
    // Tree 3 | 1 5 | 0 2 4 6; the two nearest of 0.4. Near: 3 -> lower (0), 1 -> lower (0), leaf 0. Far: 1's
    // other child 2 is 0.6 from the plane, bound 0.6: entered (1); then the root's at 2.6: not (0). Bits 0 0
    // 1 0, from the top of the byte.
    const std::vector<Photon> heap = left_balanced(photons_on_a_line({0, 1, 2, 3, 4, 5, 6}));
    NearestSet found(2);
    RecordedSearch search;
    nearest(PhotonKd(heap), {0.4f, 0, 0}, found, search);
    EXPECT_EQ(search.recorder.finish(), 1u);
    EXPECT_EQ(search.recorder.bytes()[0], 0b0010'0000);
    EXPECT_EQ(nodes(7, search.recorder.bytes()), (std::vector<std::uint32_t>{0, 1, 3, 4}));
}

TEST(Walk, DecodingGivesTheSearchsVisitsNodeForNode) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> heap = left_balanced(*any_photons(200));
        HeapWalkDecoder decoder(static_cast<std::uint32_t>(heap.size()));
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-4, 12)) * 0.5f; };
        NearestSet found(static_cast<std::uint32_t>(*rc::gen::inRange(0, 30)));
        RecordedSearch search;
        nearest(PhotonKd(heap), {coordinate(), coordinate(), coordinate()}, found, search);
        search.recorder.finish();
        RC_ASSERT(nodes(decoder, search.recorder.bytes()) == search.visited);
    }));
}

TEST(Walk, EveryTreeSizeDecodes) {
    // All shapes of the last level, with walks from one branch to the whole tree.
    for (std::uint32_t count = 1; count <= 130; ++count) {
        const std::vector<Photon> heap = left_balanced(uniform_photons(count, count));
        HeapWalkDecoder decoder(count);
        for (const std::uint32_t k : {1u, 5u, count}) {
            NearestSet found(k);
            RecordedSearch search;
            nearest(PhotonKd(heap), {0.5f, 0.25f, 0.75f}, found, search);
            search.recorder.finish();
            ASSERT_EQ(nodes(decoder, search.recorder.bytes()), search.visited) << count << ' ' << k;
        }
    }
}

/// A walk that no search has made: it is drawn, with `chance` on each level that the far child is entered.
struct DrawnWalk {
    std::uint32_t photons;
    std::function<float(int)> chance;
    Numbers numbers{1};
    std::vector<std::uint32_t> slots{};
    WalkRecorder recorder{};

    void draw(std::uint64_t slot, int level) {
        slots.push_back(static_cast<std::uint32_t>(slot));
        recorder.visit(0);
        if (2 * slot > photons) return;
        const bool upper = numbers.uniform() < 0.5f;
        const std::uint64_t near = 2 * slot + (upper ? 1 : 0), far = near ^ 1;
        recorder.near(upper);
        if (near <= photons) draw(near, level + 1);
        const bool entered = far <= photons && numbers.uniform() < chance(level);
        recorder.far(entered);
        if (entered) draw(far, level + 1);
    }
};

/// From 2^28 photons on a descent and the run of far bits behind it do not fit into one word.
TEST(Walk, TreesOfHundredsOfMillionsOfPhotonsDecode) {
    const std::vector<std::function<float(int)>> chances{[](int) { return 0.0f; }, [](int) { return 0.05f; },
                                                         [](int) { return 0.2f; },
                                                         [](int level) { return level < 2 ? 0.8f : 0.01f; },
                                                         [](int level) { return level < 20 ? 0.0f : 0.5f; }};
    for (const std::uint32_t photons : {(1u << 27) + 12345, (1u << 28) - 1, 1u << 28, (1u << 28) + 7,
                                        (3u << 28) + 5, (1u << 31) + 99, ~0u - 2, ~0u}) {
        HeapWalkDecoder decoder(photons);
        DrawnWalk walk{photons, {}};
        for (const auto& chance : chances)
            for (int repeat = 0; repeat < 40; ++repeat) {
                walk.chance = chance;
                walk.slots.clear();
                walk.recorder.clear();
                walk.draw(1, 0);
                walk.recorder.finish();
                const auto [fault, slots] = decoder.decode(walk.recorder.bytes());
                ASSERT_EQ(fault, WalkFault::none) << photons;
                ASSERT_TRUE(std::equal(slots.begin(), slots.end(), walk.slots.begin(), walk.slots.end()))
                    << photons;
            }
    }
}

TEST(Walk, ManySearchesShareOneBuffer) {
    const std::vector<Photon> heap = left_balanced(clustered_photons(5000));
    HeapWalkDecoder decoder(5000);
    NearestSet found(50);
    RecordedSearch search;
    Numbers numbers(3);
    std::size_t start = 0;
    for (int q = 0; q < 500; ++q) {
        search.visited.clear();
        nearest(PhotonKd(heap), {numbers.uniform(), numbers.uniform(), numbers.uniform()}, found, search);
        const std::size_t bytes = search.recorder.finish();
        ASSERT_EQ(nodes(decoder, search.recorder.bytes().subspan(start, bytes)), search.visited);
        start += bytes;
    }
    EXPECT_EQ(start, search.recorder.bytes().size());
}

TEST(Walk, WithoutAStackParentsAreVisitedOnTheWayBack) {
    // The walk drawn above: 1 2 4, back to 2, 5, back to 2 and 1.
    const std::vector<std::uint8_t> walk{0b0010'0000};
    const StackFree tree(7);
    const auto decoder = tree.decoder();
    const auto visits = decoder->decode(walk);
    EXPECT_EQ(visits.fault, WalkFault::none);
    EXPECT_EQ(std::vector<std::uint32_t>(visits.elements.begin(), visits.elements.end()),
              (std::vector<std::uint32_t>{1, 2, 4, 2, 5, 2, 1}));
    EXPECT_EQ(StackFree(1).decoder()->decode(std::vector<std::uint8_t>{0}).elements.size(), 1u);
    EXPECT_EQ(StackFree(0).decoder()->decode({}).elements.size(), 0u);
}

TEST(Walk, ATreeOfOnePhotonTellsAVisitFromNone) {
    WalkRecorder recorder;
    recorder.visit(0);
    EXPECT_EQ(recorder.finish(), 1u);
    EXPECT_EQ(recorder.finish(), 0u);
    EXPECT_EQ(nodes(1, recorder.bytes()), (std::vector<std::uint32_t>{0}));
    EXPECT_TRUE(nodes(1, {}).empty());
}

TEST(Walk, DamagedWalksAreToldApart) {
    const std::vector<Photon> heap = left_balanced(uniform_photons(1000));
    HeapWalkDecoder decoder(1000);
    NearestSet found(20);
    WalkRecorder recorder;
    nearest(PhotonKd(heap), {0.5f, 0.5f, 0.5f}, found, recorder);
    recorder.finish();
    std::vector<std::uint8_t> walk(recorder.bytes().begin(), recorder.bytes().end());
    EXPECT_EQ(decoder.decode(walk).fault, WalkFault::none);
    EXPECT_EQ(decoder.decode(std::span(walk).first(walk.size() - 1)).fault, WalkFault::ends_early);
    walk.push_back(0);
    EXPECT_EQ(decoder.decode(walk).fault, WalkFault::bytes_left_over);
    EXPECT_EQ(HeapWalkDecoder(0).decode(walk).fault, WalkFault::bytes_left_over);
    // Two photons, lower child first (0), then its sibling, which does not exist, entered (1).
    EXPECT_EQ(HeapWalkDecoder(2).decode(std::vector<std::uint8_t>{0b0100'0000}).fault,
              WalkFault::enters_missing_child);
}

TEST(Walk, ArbitraryBytesNeverLeaveTheTree) {
    ASSERT_TRUE(rc::check([] {
        const auto photons = static_cast<std::uint32_t>(*rc::gen::inRange(1, 2000));
        const auto bytes = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
        HeapWalkDecoder decoder(photons);
        for (const std::uint32_t slot : decoder.decode(bytes).elements)
            RC_ASSERT(slot >= 1 && slot <= photons);
    }));
}

TEST(Walk, RecordingIsTheSameOnAnyNumberOfThreads) {
    const std::vector<Photon> heap = left_balanced(uniform_photons(3000));
    std::vector<Vec3> points;
    Numbers numbers(5);
    for (int i = 0; i < 20000; ++i)
        points.push_back({numbers.uniform(), numbers.uniform(), numbers.uniform()});
    points[77].x = std::numeric_limits<float>::quiet_NaN();
    const Recording two = record_walks(PhotonKd(heap), points, 10, 1);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const Recording one = record_walks(PhotonKd(heap), points, 10, 1);
    EXPECT_EQ(one.walks, two.walks);
    EXPECT_EQ(one.walk_bytes, two.walk_bytes);
    EXPECT_EQ(one.visited_nodes, two.visited_nodes);
    EXPECT_EQ(one.walk_bytes[77], 0u);
}

}  // namespace
}  // namespace regather::spatial
