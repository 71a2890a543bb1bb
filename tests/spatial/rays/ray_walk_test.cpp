// Walks of rays: what they decode to is what a listener of the traversal saw, and the triangles of their
// leaves give the hit.
#include "spatial/rays/ray_walk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <limits>
#include <set>

#include "spatial/rays/cast.h"
#include "spatial/rays/ray_recording.h"
#include "tests/spatial/rays/soup.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

using testing::ElementsAre;
using trace::Vec3;
using Bytes = std::vector<std::uint8_t>;
using Elements = std::vector<std::uint32_t>;

/// A hierarchy and its shape.
struct Built {
    RayBvh bvh;
    std::shared_ptr<const RayTree> tree;

    Built(const Soup& soup, RayTree::Stack stack) : bvh(soup.vertices, soup.triangles) {
        tree = std::make_shared<RayTree>("renderer's", shape_of(bvh, 8), stack);
    }
    Built(const Soup& soup, const RayBvh::Shape& shape, RayTree::Stack stack)
        : bvh(soup.vertices, soup.triangles, shape) {
        tree = std::make_shared<RayTree>("own", shape_of(bvh, shape.node_width), stack);
    }
};

/// Hears a traversal and records it.
struct Heard {
    RayWalkRecorder recorder;
    std::uint32_t inner;
    Elements visited;

    explicit Heard(const RayTree& tree) : recorder(tree), inner(tree.inner_nodes()) {}
    void node(std::uint32_t n) {
        visited.push_back(n);
        recorder.node(n);
    }
    void entered(unsigned children) { recorder.entered(children); }
    void block(std::uint32_t b) {
        visited.push_back(inner + b);
        recorder.block(b);
    }
};

/// On a grid of halves, so that boxes, edges, corners and distances coincide; some triangles have no area,
/// some are there twice.
Soup any_soup(std::size_t most) {
    const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(0, 9)) * 0.5f; };
    Soup soup;
    const auto count = *rc::gen::inRange<std::size_t>(0, most);
    for (std::size_t t = 0; t < count; ++t) {
        if (t > 0 && *rc::gen::inRange(0, 8) == 0) {
            soup.triangles.push_back(soup.triangles[t - 1]);
            continue;
        }
        Vec3 corner[3];
        for (Vec3& c : corner) c = {coordinate(), coordinate(), coordinate()};
        soup.add(corner[0], corner[1], corner[2]);
    }
    return soup;
}

Ray any_ray() {
    const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-4, 13)) * 0.5f; };
    Ray ray{.origin = {coordinate(), coordinate(), coordinate()}, .direction = {}};
    ray.direction = Vec3{coordinate(), coordinate(), coordinate()} - ray.origin;
    if (ray.direction == Vec3{}) ray.direction = {0.5f, 0, -1};
    ray.farthest = *rc::gen::element(endless, 1.0f, 0.25f);
    return ray;
}

/// The nearest hit among the triangles of these leaves alone.
Meeting retested(const Soup& soup, const Built& built, std::span<const std::uint32_t> elements,
                 const Ray& ray) {
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t e : elements) {
        if (e < built.tree->inner_nodes()) continue;
        const RayBvh::Block& block = built.bvh.blocks()[e - built.tree->inner_nodes()];
        numbers.insert(numbers.end(), block.triangles, block.triangles + block.count);
    }
    std::sort(numbers.begin(), numbers.end());
    std::vector<TriangleIndices> triangles;
    for (const std::uint32_t t : numbers) triangles.push_back(soup.triangles[t]);
    Meeting met = closest(RayBvh(soup.vertices, triangles), ray);
    if (met.found()) met.triangle = numbers[met.triangle];
    return met;
}

TEST(RayWalk, DecodesToTheVisitsAndItsTrianglesGiveTheHit) {
    ASSERT_TRUE(rc::check([] {
        const Soup soup = any_soup(120);
        const bool any_hit = *rc::gen::arbitrary<bool>();
        const RayTree::Stack stack{.on_chip = {}, .any_hit = any_hit};
        const auto width = *rc::gen::element(0u, 2u, 4u, 8u);
        const Built built =
            width == 0 ? Built(soup, stack)
                       : Built(soup,
                               RayBvh::Shape{.node_width = width,
                                             .leaf_triangles = *rc::gen::inRange<std::uint32_t>(1, 9),
                                             .quantised = *rc::gen::arbitrary<bool>()},
                               stack);
        const Ray ray = any_ray();
        Heard heard(*built.tree);
        const Meeting all = closest(RayBvh(soup.vertices, soup.triangles), ray);
        if (any_hit)
            RC_ASSERT(occluded(built.bvh, ray, heard) == all.found());
        else
            RC_ASSERT(closest(built.bvh, ray, heard).triangle == all.triangle);
        const std::uint32_t bytes = heard.recorder.finish();
        RC_ASSERT(bytes == heard.recorder.bytes().size());
        const auto decoder = built.tree->decoder();
        const auto [fault, elements] = decoder->decode(heard.recorder.bytes());
        RC_ASSERT(fault == WalkFault::none);
        RC_ASSERT(Elements(elements.begin(), elements.end()) == heard.visited);
        RC_ASSERT(decoder->walk_bytes() == bytes);
        RC_ASSERT(heard.recorder.visited() == heard.visited.size());

        const Meeting again = retested(soup, built, elements, ray);
        RC_ASSERT(again.found() == all.found());
        if (!any_hit && all.found()) {
            RC_ASSERT(again.triangle == all.triangle);
            RC_ASSERT(again.distance == all.distance);
        }
        // Any hit ends the search: the leaves before the last one hold none.
        if (any_hit && all.found())
            RC_ASSERT(!retested(soup, built, elements.first(elements.size() - 1), ray).found());
    }));
}

TEST(RayWalk, OneRecorderTakesManyWalks) {
    const Soup soup = random_soup(3000, 0.1f, 21);
    for (const std::uint32_t width : {2u, 4u, 8u}) {
        const Built built(soup, {.node_width = width, .leaf_triangles = 3}, {});
        RayWalkRecorder recorder(*built.tree);
        const auto decoder = built.tree->decoder();
        std::mt19937 random(22);
        std::size_t start = 0;
        for (int i = 0; i < 500; ++i) {
            const Vec3 from = uniform3(random), to = uniform3(random);
            const Ray ray{from, to - from};
            Heard heard(*built.tree);
            closest(built.bvh, ray, heard);
            closest(built.bvh, ray, recorder);
            const std::uint32_t bytes = recorder.finish();
            const auto [fault, elements] = decoder->decode(recorder.bytes().subspan(start, bytes));
            ASSERT_EQ(fault, WalkFault::none);
            ASSERT_EQ(Elements(elements.begin(), elements.end()), heard.visited);
            start += bytes;
        }
        EXPECT_EQ(start, recorder.bytes().size());
    }
}

// Nodes 0 {1, 2}, 1 {3, 4}, 2 {5, 6}; leaves 3 to 6.
RayTree::Shape seven() {
    return {.width = 2, .children = {1, 2, 3, 4, 5, 6}, .leaf_begin = {0, 2, 3, 4, 7}};
}

Elements decoded(const RayTree& tree, const Bytes& walk) {
    const auto decoder = tree.decoder();
    const auto [fault, elements] = decoder->decode(walk);
    EXPECT_EQ(fault, WalkFault::none);
    return {elements.begin(), elements.end()};
}

// Two children of 0 entered, slot 0; of 1 two, slot 1; then slot 0; then 0's slot 1; of 2 one, slot 0:
// 10 0, 10 1, 1 0, 1 1, 01 0.
const Bytes drawn{0b1001'0110, 0b1101'0000};
// 10 0, 10 1, and what waits at 1 and at 0 is dropped: 0 0.
const Bytes dropped{0b1001'0100};

TEST(RayWalk, IsTheOneDrawnByHand) {
    const RayTree tree("seven", seven(), {});
    EXPECT_THAT(decoded(tree, drawn), ElementsAre(0, 1, 4, 3, 2, 5));
    EXPECT_THAT(decoded(tree, dropped), ElementsAre(0, 1, 4));
    EXPECT_THAT(decoded(tree, {0}), ElementsAre(0));  // a root none of whose children are entered
    EXPECT_THAT(decoded(tree, {}), ElementsAre());

    RayWalkRecorder recorder(tree);
    recorder.node(0);
    recorder.entered(2);
    recorder.node(1);
    recorder.entered(2);
    recorder.block(1);
    recorder.block(0);
    recorder.node(2);
    recorder.entered(1);
    recorder.block(2);
    EXPECT_EQ(recorder.finish(), 2u);
    recorder.node(0);
    recorder.entered(2);
    recorder.node(1);
    recorder.entered(2);
    recorder.block(1);
    EXPECT_EQ(recorder.finish(), 1u);
    EXPECT_THAT(recorder.bytes(), ElementsAre(drawn[0], drawn[1], dropped[0]));
    EXPECT_EQ(recorder.visited(), 9u);
}

TEST(RayWalk, AStackInMemoryIsWrittenAndRead) {
    // Without a place on chip 2 lies in place 7 while 1 is done, and 1's other child in place 8 above it.
    const RayTree none("none", seven(), {.on_chip = 0, .any_hit = false});
    EXPECT_EQ(none.range_of(trace::Region::stack), (ElementRange{trace::Region::stack, 7, 2}));
    EXPECT_THAT(decoded(none, drawn), ElementsAre(0, 7, 1, 8, 4, 8, 3, 7, 2, 5));
    EXPECT_THAT(decoded(none, dropped), ElementsAre(0, 7, 1, 8, 4, 8, 7));
    // Whoever needs any hit does not look at what waits.
    const RayTree any("any", seven(), {.on_chip = 0, .any_hit = true});
    EXPECT_THAT(decoded(any, dropped), ElementsAre(0, 7, 1, 8, 4));
    const RayTree one("one", seven(), {.on_chip = 1, .any_hit = false});
    EXPECT_EQ(one.range_of(trace::Region::stack), (ElementRange{trace::Region::stack, 7, 1}));
    EXPECT_THAT(decoded(one, drawn), ElementsAre(0, 1, 7, 4, 7, 3, 2, 5));
    const RayTree two("two", seven(), {.on_chip = 2, .any_hit = false});
    EXPECT_EQ(two.range_of(trace::Region::stack).count, 0u);
    EXPECT_EQ(two.end(), 7u);
    EXPECT_THAT(one.roots(), ElementsAre(0, 7));
    EXPECT_EQ(one.level(7), 3u);
    EXPECT_EQ(one.records(7), 1u);
    EXPECT_EQ(one.records(6), 3u);
}

// What lies in memory of a stack with n places on chip is what a plain stack has at n and above.
TEST(RayWalk, TheStackIsAPlainOne) {
    const Soup soup = random_soup(2000, 0.2f, 31);
    struct Plain {
        const RayTree* tree;
        std::uint32_t on_chip, first, inner;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{};  // level and number of what waits
        Elements touched{};
        std::uint32_t height = 0, level = 0, entered_at_last = 0;

        void touch(std::uint32_t place) {
            if (place >= on_chip) touched.push_back(first + place - on_chip);
        }
        void visit(std::uint32_t e) {
            level = tree->level(e);
            if (entered_at_last > 0) {  // the first child: the others are put aside
                for (std::uint32_t i = 1; i < entered_at_last; ++i) touch(height++);
                if (entered_at_last > 1) stack.emplace_back(level, entered_at_last - 1);
            } else if (level > 0) {  // from the stack: what is deeper is dropped first
                while (stack.back().first > level) {
                    for (; stack.back().second > 0; --stack.back().second) touch(--height);
                    stack.pop_back();
                }
                touch(--height);
                if (--stack.back().second == 0) stack.pop_back();
            }
            entered_at_last = 0;
            touched.push_back(e);
        }
        void node(std::uint32_t n) { visit(n); }
        void entered(unsigned m) { entered_at_last = m; }
        void block(std::uint32_t b) { visit(inner + b); }
        void end() {
            while (height > 0) touch(--height);
        }
    };
    for (const std::uint32_t width : {2u, 8u})
        for (const std::uint32_t on_chip : {0u, 3u, 7u}) {
            const Built built(soup, {.node_width = width, .leaf_triangles = 2}, {.on_chip = on_chip});
            const std::uint32_t first = built.tree->range_of(trace::Region::stack).first;
            ASSERT_GT(first, 0u);
            const auto decoder = built.tree->decoder();
            std::mt19937 random(32);
            for (int i = 0; i < 200; ++i) {
                const Vec3 from = uniform3(random), to = uniform3(random);
                const Ray ray{from, to - from};
                Heard heard(*built.tree);
                Plain plain{built.tree.get(), on_chip, first, built.tree->inner_nodes()};
                closest(built.bvh, ray, heard);
                closest(built.bvh, ray, plain);
                plain.end();
                heard.recorder.finish();
                const auto [fault, elements] = decoder->decode(heard.recorder.bytes());
                ASSERT_EQ(fault, WalkFault::none);
                ASSERT_EQ(Elements(elements.begin(), elements.end()), plain.touched);
            }
        }
}

TEST(RayWalk, DamagedWalksAreToldApart) {
    const RayTree tree("seven", seven(), {});
    const auto decoder = tree.decoder();
    const auto fault_of = [&](const Bytes& walk) { return decoder->decode(walk).fault; };
    EXPECT_EQ(fault_of({drawn[0]}), WalkFault::ends_early);
    EXPECT_EQ(fault_of({drawn[0], drawn[1], 0}), WalkFault::bytes_left_over);
    EXPECT_EQ(fault_of({0b1100'0000}), WalkFault::enters_missing_child);     // three of two
    EXPECT_EQ(fault_of({0b1001'0111, 0}), WalkFault::enters_missing_child);  // 1's slot 1 again
    const RayTree nothing("nothing", {}, {});
    EXPECT_EQ(nothing.decoder()->decode(drawn).fault, WalkFault::bytes_left_over);
    EXPECT_EQ(nothing.decoder()->decode(Bytes{}).fault, WalkFault::none);
    // Four slots, three children: slot 3, and four entered.
    const RayTree three("three", {.width = 4, .children = {1, 2, 3, 0}, .leaf_begin = {0, 1, 2, 3}}, {});
    EXPECT_EQ(three.decoder()->decode(Bytes{0b0011'1000}).fault, WalkFault::enters_missing_child);
    EXPECT_EQ(three.decoder()->decode(Bytes{0b1000'0000}).fault, WalkFault::enters_missing_child);
    EXPECT_EQ(three.decoder()->decode(Bytes{0b0011'0000}).fault, WalkFault::none);

    const Soup soup = random_soup(500, 0.2f, 41);
    for (const bool any_hit : {false, true}) {
        const Built built(soup, {.node_width = 8, .leaf_triangles = 2}, {.on_chip = 1, .any_hit = any_hit});
        const auto of_soup = built.tree->decoder();
        ASSERT_TRUE(rc::check([&] {
            const auto bytes = *rc::gen::arbitrary<Bytes>();
            for (const std::uint32_t e : of_soup->decode(bytes).elements) RC_ASSERT(e < built.tree->end());
        }));
    }
}

TEST(RayWalk, ManyRaysAreRecordedWithTheirEnds) {
    Soup soup;  // a wall at z = 2 and a smaller one at z = 5
    soup.add({-1, -1, 2}, {3, -1, 2}, {-1, 3, 2});
    soup.add({4, 4, 5}, {6, 4, 5}, {4, 6, 5});
    const std::vector<Ray> rays{{{0, 0, 0}, {0, 0, 1}},
                                {{4.5f, 4.5f, 1}, {0, 0, 2}},
                                {{0, 0, 3}, {0, 0, 1}},   // between the walls, past both: leaves the box at 5
                                {{0, 0, 9}, {0, 0, 1}},   // away from the box
                                {{1, 1, 1}, {0, 0, 0}}};  // not cast
    const Built built(soup, {.node_width = 2, .leaf_triangles = 1}, {});
    const RayRecording recording = record_walks(built.bvh, *built.tree, rays);
    EXPECT_THAT(recording.end,
                ElementsAre(Vec3{0, 0, 2}, Vec3{4.5f, 4.5f, 5}, Vec3{0, 0, 5}, Vec3{0, 0, 9}, Vec3{1, 1, 1}));
    EXPECT_EQ(recording.hits, 2u);
    const std::uint32_t near = built.bvh.blocks()[0].triangles[0] == 0 ? 0 : 1;
    EXPECT_THAT(recording.leaf, ElementsAre(near, 1 - near, 2, 2, 2));
    EXPECT_EQ(recording.walk_bytes[4], 0u);
    EXPECT_EQ(recording.walk_bytes[3], 1u);

    std::vector<Ray> shadows = rays;
    for (Ray& ray : shadows) ray.farthest = 2.5f;
    const Built any(soup, {.node_width = 2, .leaf_triangles = 1}, {.on_chip = {}, .any_hit = true});
    const RayRecording shadowed = record_walks(any.bvh, *any.tree, shadows);
    EXPECT_THAT(shadowed.end, ElementsAre(Vec3{0, 0, 2.5f}, Vec3{4.5f, 4.5f, 6}, Vec3{0, 0, 5.5f},
                                          Vec3{0, 0, 11.5f}, Vec3{1, 1, 1}));
    EXPECT_EQ(shadowed.hits, 2u);
    EXPECT_THAT(shadowed.leaf, ElementsAre(near, 1 - near, 2, 2, 2));
}

TEST(RayWalk, AShapeThatIsTooDeepIsRefused) {
    RayTree::Shape chain{.width = 2};
    constexpr std::uint32_t inner = RayTree::most_levels + 1;
    for (std::uint32_t i = 0; i < inner; ++i) {
        chain.children.push_back(i + 1 < inner ? i + 1 : inner + i);
        chain.children.push_back(i + 1 < inner ? inner + i : inner + i + 1);
    }
    for (std::uint32_t l = 1; l <= inner + 1; ++l) chain.leaf_begin.push_back(l);
    EXPECT_THROW(RayTree("chain", chain, {}), trace::DataError);
}

}  // namespace
}  // namespace regather::spatial
