// Structures of any form: levels and children from parents, as drawn by hand.
#include "spatial/listed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace regather::spatial {
namespace {

using testing::ElementsAre;
using trace::Region;

TEST(Listed, LevelsFollowFromParents) {
    // 3 is a root with 0 and 4 below it, 1 below 4; 2 is a root alone.
    EXPECT_THAT(levels_below(std::vector<std::uint32_t>{3, 4, 2, 3, 3}), ElementsAre(1, 2, 0, 0, 1));
    // 0 and 1 lead to each other, 2 to them; 3 is a root.
    EXPECT_THAT(levels_below(std::vector<std::uint32_t>{1, 0, 1, 3}),
                ElementsAre(no_level, no_level, no_level, 0));
    EXPECT_TRUE(levels_below({}).empty());
    // A chain from the far end: its levels are the numbers.
    std::vector<std::uint32_t> chain(100'000);
    for (std::uint32_t e = 1; e < chain.size(); ++e) chain[e] = e - 1;
    EXPECT_EQ(levels_below(chain)[99'999], 99'999u);
}

TEST(Listed, ChildrenAndRootsFollowFromParents) {
    const Listed forest("forest", {.ranges = {{Region::nodes, 0, 5}}, .parent = {3, 4, 2, 3, 3}});
    EXPECT_THAT(forest.roots(), ElementsAre(2, 3));
    std::vector<std::uint32_t> children{77};
    forest.append_children(3, children);
    forest.append_children(2, children);
    forest.append_children(4, children);
    EXPECT_THAT(children, ElementsAre(77, 0, 4, 1));
    EXPECT_EQ(forest.level(1), 2u);
    EXPECT_TRUE(forest.tells_children());
}

TEST(Listed, WithoutParentsEveryElementIsARootAtLevelZero) {
    const Listed heap("heap", {.ranges = {{Region::other, 0, 3}}, .bytes = {5, 6, 7}});
    EXPECT_THAT(heap.roots(), ElementsAre(0, 1, 2));
    EXPECT_FALSE(heap.tells_children());
    EXPECT_EQ(heap.level(2), 0u);
    EXPECT_THAT(heap.own_bytes(), ElementsAre(5, 6, 7));
    EXPECT_EQ(Listed("told", {.ranges = {{Region::other, 0, 3}}, .level = {4, 1, 9}}).level(2), 9u);
    EXPECT_TRUE(Listed("nothing", {}).tells_children());
}

TEST(Listed, RecordsAreCountedOverThePhotonElements) {
    const Listed grid("grid", {.ranges = {{Region::directory, 0, 2}, {Region::photons, 2, 3}},
                               .parent = {0, 1, 0, 1, 1},
                               .record_begin = {0, 4, 5, 9}});
    EXPECT_EQ(grid.records(1), 1u);
    EXPECT_EQ(grid.records(2), 4u);
    EXPECT_EQ(grid.records(4), 4u);
    EXPECT_EQ(grid.first_record(4), 5u);
}

TEST(Listed, TheSameMeansEveryColumn) {
    const Listed::Elements all{.ranges = {{Region::nodes, 0, 2}},
                               .parent = {0, 0},
                               .level = {},
                               .bytes = {8, 8},
                               .address = {0, 64},
                               .record_begin = {}};
    const Listed one("one", all);
    EXPECT_TRUE(one.same_as(Listed("one", all)));
    EXPECT_FALSE(one.same_as(Listed("two", all)));
    Listed::Elements other = all;
    other.address[1] = 65;
    EXPECT_FALSE(one.same_as(Listed("one", other)));
}

}  // namespace
}  // namespace regather::spatial
