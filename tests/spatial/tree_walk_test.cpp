// Walks over trees of any shape, against a search of nothing: decisions that are drawn, told to a recorder by
// the grammar of spatial/walk.h.
#include "spatial/tree_walk.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <random>

#include "spatial/walk.h"

namespace regather::spatial {
namespace {

/// A tree of so many leaves; at each inner node one in `spread` leaves at least lies on a side that is drawn:
/// 2 is balanced, thousands make a comb.
struct Tree {
    std::vector<std::uint32_t> children;
    std::uint32_t inner, next_leaf;

    Tree(std::uint32_t leaves, std::uint32_t spread, std::mt19937& random)
        : inner(leaves - 1), next_leaf(inner) {
        std::uint32_t next_inner = 0;
        children.resize(2 * std::size_t{inner});
        build(leaves, spread, random, next_inner);
    }
    std::uint32_t build(std::uint32_t leaves, std::uint32_t spread, std::mt19937& random,
                        std::uint32_t& next_inner) {
        if (leaves == 1) return next_leaf++;
        const std::uint32_t node = next_inner++, few = std::max(1U, leaves / spread);
        const std::uint32_t lower = random() % 2 == 0 ? few : leaves - few;
        children[2 * std::size_t{node}] = build(lower, spread, random, next_inner);
        children[2 * std::size_t{node} + 1] = build(leaves - lower, spread, random, next_inner);
        return node;
    }
};

/// One walk: of each inner node either child first, the other entered with a chance of `enters` in 8.
void walk(const Tree& tree, std::uint32_t node, unsigned enters, std::mt19937& random, WalkRecorder& recorder,
          std::vector<std::uint32_t>& visited) {
    visited.push_back(node);
    recorder.visit(node);
    if (node >= tree.inner) return;
    const std::uint32_t upper = random() % 2;
    recorder.near(upper == 1);
    walk(tree, tree.children[2 * std::size_t{node} + upper], enters, random, recorder, visited);
    const bool entered = random() % 8 < enters;
    recorder.far(entered);
    if (entered)
        walk(tree, tree.children[2 * std::size_t{node} + (1 - upper)], enters, random, recorder, visited);
}

RC_GTEST_PROP(TreeWalk, DecodesToTheVisits, ()) {
    std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
    const auto leaves = *rc::gen::inRange(1U, 400U);
    const auto spread = *rc::gen::element(2U, 3U, 7U, 1000U);
    const Tree tree(leaves, spread, random);
    TreeWalkDecoder decoder(tree.children, false);
    for (unsigned enters = 0; enters <= 8; ++enters) {
        WalkRecorder recorder;
        std::vector<std::uint32_t> visited;
        walk(tree, 0, enters, random, recorder, visited);
        const std::uint32_t length = recorder.finish();
        std::vector<std::uint8_t> bytes(recorder.bytes().begin(), recorder.bytes().end());

        const auto [fault, elements] = decoder.decode(bytes);
        RC_ASSERT(fault == WalkFault::none);
        RC_ASSERT(std::vector(elements.begin(), elements.end()) == visited);
        RC_ASSERT(decoder.walk_bytes() == length);

        RC_ASSERT(length == 1 ||
                  decoder.decode(std::span(bytes).first(length - 1)).fault == WalkFault::ends_early);
        // Bytes that hold ones enter what is not there.
        bytes.push_back(255);
        RC_ASSERT(decoder.decode(bytes).fault == WalkFault::bytes_left_over);
        RC_ASSERT(decoder.walk_bytes() == length);
    }
}

/// The bits of a walk, so many bytes.
std::vector<std::uint8_t> bytes_of_walk(const std::vector<bool>& bits) {
    std::vector<std::uint8_t> bytes((bits.size() + 7) / 8, 0);
    for (std::size_t i = 0; i < bits.size(); ++i)
        if (bits[i]) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 128 >> i % 8);
    return bytes;
}

/// Combs of 1 to 200 inner nodes, each the upper child of the one before: so many near bits before the first
/// leaf. Their far bits come from the deepest node on: here every leaf is entered, or none but the uppermost.
TEST(TreeWalk, GoesDeeperThanAWordOfBits) {
    for (std::uint32_t inner = 1; inner <= 200; ++inner) {
        std::vector<std::uint32_t> children, down, all;
        for (std::uint32_t i = 0; i < inner; ++i) {
            children.insert(children.end(), {inner + i, i + 1 < inner ? i + 1 : 2 * inner});
            down.push_back(i);
        }
        down.push_back(2 * inner);
        all = down;
        for (std::uint32_t i = inner; i-- > 0;) all.push_back(inner + i);
        down.push_back(inner);
        std::vector<bool> enter_all(2 * std::size_t{inner}, true), enter_one(inner, true);
        enter_one.resize(2 * std::size_t{inner} - 1, false);
        enter_one.push_back(true);

        TreeWalkDecoder decoder(children, false);
        const auto one = decoder.decode(bytes_of_walk(enter_one));
        EXPECT_EQ(one.fault, WalkFault::none) << inner;
        EXPECT_EQ(std::vector(one.elements.begin(), one.elements.end()), down) << inner;
        const auto every = decoder.decode(bytes_of_walk(enter_all));
        EXPECT_EQ(every.fault, WalkFault::none) << inner;
        EXPECT_EQ(std::vector(every.elements.begin(), every.elements.end()), all) << inner;
    }
}

/// Only zeros follow its one byte: 700 nodes down, each the lower child of the one before.
TEST(TreeWalk, DoesNotReadOnWhereAWalkEnds) {
    std::vector<std::uint32_t> children;
    for (std::uint32_t i = 0; i < 700; ++i) children.insert(children.end(), {i + 1, 701 + i});
    TreeWalkDecoder decoder(children, false);
    EXPECT_EQ(decoder.decode(std::vector<std::uint8_t>{0}).fault, WalkFault::ends_early);
}

TEST(TreeWalk, VisitsMoreThanItHasRoomForAtFirst) {
    std::mt19937 random(5);
    const Tree tree(3000, 2, random);
    TreeWalkDecoder decoder(tree.children, false);
    const std::vector<std::uint8_t> all = bytes_of_walk(std::vector<bool>(2 * 2999, true));
    const auto [fault, elements] = decoder.decode(all);
    EXPECT_EQ(fault, WalkFault::none);
    EXPECT_EQ(elements.size(), 5999U);
}

}  // namespace
}  // namespace regather::spatial
