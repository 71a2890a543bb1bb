// Rays in treelet queues: drawn by hand, and against their walks in a plain order.
#include "replay/treelet_queues.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "replay/layouts/catalogue.h"
#include "replay/treelets.h"
#include "spatial/rays/ray_recording.h"
#include "tests/replay/traced.h"
#include "tests/spatial/rays/soup.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using cachesim::Access;
using spatial::RayTree;
using testing::ElementsAre;
using trace::Region;

/// An access as text: "R 64 64 nodes", and "queue" where it is for one.
using Texts = std::vector<std::string>;
std::string text(const cachesim::ByteAccess& access, Region region, bool queue) {
    return (access.kind == Access::read ? "R " : "W ") + std::to_string(access.address) + ' ' +
           std::to_string(access.bytes) + ' ' +
           std::string(trace::region_names[static_cast<std::size_t>(region)]) + (queue ? " queue" : "");
}

struct Heard {
    Texts walks, queues, all;
    std::uint64_t queue_bytes = 0;
    TreeletSink sink() {
        return [this](const cachesim::ByteAccess& access, Region region, TreeletUse use) {
            const bool queue = use == TreeletUse::queue;
            (queue ? queues : walks).push_back(text(access, region, false));
            all.push_back(text(access, region, queue));
            if (queue) queue_bytes += access.bytes;
        };
    }
};

// Nodes 0 {1, 2}, 1 {3, 4}, 2 {5, 6}; leaves 3 to 6. An element fills a line of 64 bytes.
std::shared_ptr<const RayTree> seven(const RayTree::Stack& stack = {}) {
    return std::make_shared<RayTree>(
        "seven", RayTree::Shape{.width = 2, .children = {1, 2, 3, 4, 5, 6}, .leaf_begin = {0, 1, 2, 3, 4}},
        stack);
}
Layout lines(const RayTree& tree) {
    return {"lines", tree, 0, 64, 64};
}
// 0 1 4 3 2 5; 0; 0 1 4: tests/spatial/rays/ray_walk_test.cpp draws these bits, and their stacks.
const std::vector<std::uint32_t> three_lengths{2, 1, 1};
const std::vector<std::uint8_t> three_walks{0b1001'0110, 0b1101'0000, 0, 0b1001'0100};

TEST(TreeletQueues, TreesAreCutFromTheRootOn) {
    const auto tree = seven();
    const auto cut = [&](std::uint32_t bytes) {
        const Treelets treelets(*tree, lines(*tree), bytes);
        std::vector<std::uint32_t> of;
        for (std::uint32_t e = 0; e < 7; ++e) of.push_back(treelets.of(e));
        EXPECT_EQ(treelets.count(), *std::max_element(of.begin(), of.end()) + 1);
        return of;
    };
    EXPECT_THAT(cut(448), ElementsAre(0, 0, 0, 0, 0, 0, 0));
    EXPECT_THAT(cut(192), ElementsAre(0, 0, 0, 1, 2, 3, 4));
    EXPECT_THAT(cut(191), ElementsAre(0, 0, 1, 3, 4, 1, 2));
    EXPECT_THAT(cut(1), ElementsAre(0, 1, 4, 2, 3, 5, 6));
    const auto with_stack = seven({.on_chip = 0, .any_hit = false});
    EXPECT_EQ(Treelets(*with_stack, lines(*with_stack), 448).count(), 1u);
}

// Pieces {0 1}, {2 5}, {6}, {3}, {4}, two rays under way. The first goes on to 4 with two entries on its
// stack; the second ends in the root; the third takes its place and goes on to 4, too. Both run there, the
// third to its end; the first goes on to 3 with one entry, then to 2 without any.
TEST(TreeletQueues, ThreeRaysAreTheOnesDrawnByHand) {
    const auto tree = seven();
    const Layout layout = lines(*tree);
    const WalkStore walks(tree, three_lengths, three_walks);
    const std::vector<std::uint32_t> order{0, 1, 2};
    Heard heard;
    std::vector<std::uint64_t> made;
    const TreeletRun run =
        run_treelets(walks, layout, order, {.treelet_bytes = 128, .rays = 2}, 127, heard.sink(),
                     [&](std::uint64_t r) { made.push_back(r + 10 * heard.walks.size()); });
    EXPECT_THAT(heard.all,
                ElementsAre("R 0 64 nodes", "R 64 64 nodes", "W 4096 48 reorder_buffer queue",
                            "W 8192 16 stack queue",
                            "R 0 64 nodes",  // the second ray
                            "R 0 64 nodes", "R 64 64 nodes", "W 4144 48 reorder_buffer queue",
                            "W 8208 16 stack queue", "R 4096 48 reorder_buffer queue",
                            "R 8192 16 stack queue", "R 256 64 triangles", "W 4096 48 reorder_buffer queue",
                            "W 8192 8 stack queue",  // one entry
                            "R 4144 48 reorder_buffer queue", "R 8208 16 stack queue", "R 256 64 triangles",
                            "R 4096 48 reorder_buffer queue", "R 8192 8 stack queue", "R 192 64 triangles",
                            "W 4096 48 reorder_buffer queue", "R 4096 48 reorder_buffer queue",
                            "R 128 64 nodes", "R 320 64 triangles"));
    EXPECT_THAT(made, ElementsAre(0, 21, 32));
    EXPECT_EQ(run.treelets, 5u);
    EXPECT_EQ(run.visited_elements, 10u);
    EXPECT_EQ(run.pushes, 4u);
    EXPECT_EQ(run.queue_runs, 3u);
    EXPECT_EQ(run.most_under_way, 2u);
    EXPECT_EQ(run.saved_entries, 5u);
    EXPECT_EQ(run.state_bytes, 2u * (48 + 2 * 8));
    EXPECT_TRUE(run.in_memory);
    EXPECT_EQ(run.queue_bytes(), 2u * (4 * 48 + 5 * 8));
    EXPECT_EQ(heard.queue_bytes, run.queue_bytes());
    EXPECT_EQ(treelet_memory(*tree, layout, 2).end, 8192u + 2 * 2 * 8);

    // On a chip that holds both rays.
    Heard on_chip;
    const TreeletRun held =
        run_treelets(walks, layout, order, {.treelet_bytes = 128, .rays = 2}, 128, on_chip.sink());
    EXPECT_FALSE(held.in_memory);
    EXPECT_EQ(held.pushes, 4u);
    EXPECT_EQ(held.queue_bytes(), 0u);
    EXPECT_EQ(on_chip.all, heard.walks);
}

// With one entry on chip the second one lies in memory while the ray runs, and is not saved.
TEST(TreeletQueues, EntriesOfAStackInMemoryAreTheRaysOwn) {
    const auto tree = seven({.on_chip = 1, .any_hit = false});
    const Layout layout = lines(*tree);  // of eight elements
    const WalkStore walks(tree, three_lengths, three_walks);
    const std::vector<std::uint32_t> order{0, 1, 2};
    Heard heard;
    const TreeletRun run =
        run_treelets(walks, layout, order, {.treelet_bytes = 128, .rays = 2}, 0, heard.sink());
    EXPECT_EQ(run.saved_entries, 3u);
    EXPECT_EQ(run.visited_elements, 10u + 4);
    EXPECT_EQ(run.state_bytes, 2u * (48 + 8));
    Texts entries;
    std::copy_if(heard.all.begin(), heard.all.end(), std::back_inserter(entries),
                 [](const std::string& access) { return access.find(" stack") != access.npos; });
    EXPECT_THAT(entries, ElementsAre("W 8200 8 stack", "W 8192 8 stack queue", "W 8216 8 stack",
                                     "W 8208 8 stack queue", "R 8192 8 stack queue", "R 8200 8 stack",
                                     "W 8192 8 stack queue", "R 8208 8 stack queue", "R 8216 8 stack",
                                     "R 8192 8 stack queue"));
}

TEST(TreeletQueues, TheLongestQueueIsTaken) {
    // Six rays to the root, then to one leaf each: 3, 6, 5, 6, 5, 6. Pieces {0 1 2}, {3} .. {6}.
    const auto tree = seven();
    const Layout layout = lines(*tree);
    const auto to = [](unsigned leaf) {  // 01 and a slot, twice
        return static_cast<std::uint8_t>(0b0100'1000 | (leaf >= 5 ? 0b0010'0000 : 0) |
                                         (leaf % 2 == 0 ? 0b0000'0100 : 0));
    };
    const std::vector<std::uint8_t> bytes{to(3), to(6), to(5), to(6), to(5), to(6)};
    const std::vector<std::uint32_t> lengths(6, 1), order{0, 1, 2, 3, 4, 5};
    const WalkStore walks(tree, lengths, bytes);
    const auto leaves = [&](std::uint32_t rays) {
        Heard heard;
        const TreeletRun run =
            run_treelets(walks, layout, order, {.treelet_bytes = 192, .rays = rays}, 1 << 20, heard.sink());
        EXPECT_EQ(run.most_under_way, std::min(rays, 6u));
        EXPECT_EQ(run.pushes, 6u);
        Texts visited;
        for (const std::string& access : heard.walks)
            if (access.ends_with("triangles")) visited.push_back(access.substr(2, 3));
        return visited;
    };
    EXPECT_THAT(leaves(6), ElementsAre("384", "384", "384", "320", "320", "192"));
    EXPECT_THAT(leaves(9), ElementsAre("384", "384", "384", "320", "320", "192"));
    // Four: 3, 6, 5, 6 wait and 6 has two; then 3, 5 5 and 6; of equals the first.
    EXPECT_THAT(leaves(4), ElementsAre("384", "384", "320", "320", "192", "384"));
    EXPECT_THAT(leaves(1), ElementsAre("192", "384", "320", "384", "320", "384"));
}

/// Many rays through a hierarchy over random triangles.
struct Cast {
    std::shared_ptr<const RayTree> tree;
    spatial::RayRecording recording;

    explicit Cast(const RayTree::Stack& stack, std::uint32_t width, unsigned seed) {
        const spatial::Soup soup = spatial::random_soup(400, 0.2f, seed);
        const spatial::RayBvh bvh(soup.vertices, soup.triangles, {.node_width = width, .leaf_triangles = 2});
        tree = std::make_shared<RayTree>("own", spatial::shape_of(bvh, width), stack);
        std::mt19937 random(seed + 1);
        std::vector<spatial::Ray> rays;
        for (int r = 0; r < 60; ++r) {
            const trace::Vec3 from = spatial::uniform3(random);
            rays.push_back({from, spatial::uniform3(random) - from});
        }
        recording = spatial::record_walks(bvh, *tree, rays);
    }
    WalkStore walks() const { return {tree, recording.walk_bytes, recording.walks}; }
};

Texts plain(const WalkStore& walks, const Layout& layout, std::span<const std::uint32_t> order) {
    Texts accesses;
    const auto decoder = walks.structure().decoder();
    for (const std::uint32_t query : order)
        layout.for_each(
            decoder->decode(walks.walk(query)).elements,
            [&](std::uint32_t element, std::uint64_t address, std::uint32_t bytes) {
                accesses.push_back(text({address, bytes, Access::read}, layout.region(element), false));
            });
    return accesses;
}

TEST(TreeletQueues, WhatRaysVisitStaysAsItIs) {
    ASSERT_TRUE(rc::check([] {
        const bool any_hit = *rc::gen::arbitrary<bool>();
        const std::vector<std::uint32_t> widths{2, 4, 8};
        const Cast cast({.on_chip = {}, .any_hit = any_hit}, *rc::gen::elementOf(widths),
                        *rc::gen::inRange(1u, 9u));
        const WalkStore walks = cast.walks();
        const Layout layout = make_layout(
            *rc::gen::element<std::string>("depth-first-48", "van-emde-boas-36:top=2"), *cast.tree);
        std::vector<std::uint32_t> order = shuffled_queries(60, *rc::gen::inRange(1u, 99u));
        order.resize(*rc::gen::inRange<std::size_t>(0, 61));
        const TreeletConfig config{.treelet_bytes = *rc::gen::inRange(1u, 9000u),
                                   .rays = *rc::gen::inRange(1u, 70u)};
        const std::uint64_t onchip = *rc::gen::element(0u, 1u << 30);
        Heard heard;
        const TreeletRun run = run_treelets(walks, layout, order, config, onchip, heard.sink());
        Texts expected = plain(walks, layout, order);
        // Whatever the treelets, one ray at a time runs as it did; and so do all in one treelet.
        Heard one, whole;
        run_treelets(walks, layout, order, {.treelet_bytes = config.treelet_bytes, .rays = 1}, onchip,
                     one.sink());
        RC_ASSERT(one.walks == expected);
        const TreeletRun in_one = run_treelets(
            walks, layout, order, {.treelet_bytes = 1 << 30, .rays = config.rays}, onchip, whole.sink());
        RC_ASSERT(whole.all == expected);
        RC_ASSERT(in_one.treelets == 1u);
        RC_ASSERT(in_one.pushes == 0u);
        // Many: the same accesses in another sequence.
        std::sort(expected.begin(), expected.end());
        std::sort(heard.walks.begin(), heard.walks.end());
        RC_ASSERT(heard.walks == expected);
        RC_ASSERT(run.most_under_way <= config.rays);
        RC_ASSERT(run.in_memory == (onchip == 0));
        RC_ASSERT(heard.queue_bytes == run.queue_bytes());
        const auto records = [&](const char* kind) {
            return std::count_if(heard.queues.begin(), heard.queues.end(), [&](const std::string& access) {
                return access.starts_with(kind) && access.ends_with(" 48 reorder_buffer");
            });
        };
        const auto pushes = static_cast<std::ptrdiff_t>(onchip == 0 ? run.pushes : 0);
        RC_ASSERT(records("W") == pushes);
        RC_ASSERT(records("R") == pushes);
    }));
}

TEST(TreeletQueues, AStackInMemoryIsTouchedAsOften) {
    for (const std::uint32_t on_chip : {0u, 1u, 3u})
        for (const bool any_hit : {false, true}) {
            const Cast cast({.on_chip = on_chip, .any_hit = any_hit}, 2, 5);
            const WalkStore walks = cast.walks();
            const Layout layout = make_layout("depth-first-48", *cast.tree);
            const std::vector<std::uint32_t> order = shuffled_queries(60, 7);
            Heard heard;
            const TreeletRun run =
                run_treelets(walks, layout, order, {.treelet_bytes = 500, .rays = 9}, 1 << 20, heard.sink());
            const auto entries = [](const Texts& all) {
                return std::count_if(all.begin(), all.end(),
                                     [](const std::string& access) { return access.ends_with(" 8 stack"); });
            };
            const Texts expected = plain(walks, layout, order);
            EXPECT_GT(entries(expected), 0);
            EXPECT_EQ(entries(heard.walks), entries(expected));
            EXPECT_EQ(heard.walks.size(), expected.size());
            EXPECT_EQ(run.visited_elements, expected.size());
        }
}

TEST(TreeletQueues, RefusesWhatIsNoHierarchyForRays) {
    const Searched searched(30, 3, 2);
    const WalkStore walks = searched.walks();
    try {
        hierarchy_of(walks);
        FAIL();
    } catch (const trace::UsageError& error) {
        EXPECT_STREQ(
            error.what(),
            "treelets: found walks through left-balanced-kd, expected those of rays through a hierarchy "
            "(regather walk --rays)");
    }
}

}  // namespace
}  // namespace regather::replay
