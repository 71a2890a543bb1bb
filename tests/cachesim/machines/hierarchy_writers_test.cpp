// Who pays for a line, where two regions and a third use it: whose it is travels with it, down and up.
#include <gtest/gtest.h>

#include "tests/cachesim/machines/drawn_hierarchy.h"

namespace regather::cachesim {
namespace {

constexpr auto other = trace::Region::other;

TEST(HierarchyWriters, AWriteBackHasTheLastWord) {
    Drawn d({one_set("L1", 1), one_set("L2", 2)});
    EXPECT_EQ(d.write('A', photons), "A|A");
    EXPECT_EQ(d.read('B', other), "B|AB");  // A, dirty by photons, is written back into L2
    EXPECT_EQ(d.write('A', buffer), "A|AB");
    EXPECT_EQ(d.read('B', other), "B|AB");  // and once more, by buffer
    EXPECT_EQ(d.read('C', other), "C|AC");  // A was used last, by its write-back
    EXPECT_EQ(d.read('D', other), "D|CD");  // L2 drops A
    EXPECT_EQ(d.at(0, photons).writebacks, 1u);
    EXPECT_EQ(d.at(0, buffer).writebacks, 1u);
    EXPECT_EQ(d.at(1, photons).writebacks, 0u);
    EXPECT_EQ(d.at(1, buffer).writebacks, 1u);
    EXPECT_EQ(d.hierarchy.dram()->stats(buffer).bursts_written, 1u);
    EXPECT_EQ(d.hierarchy.dram()->stats(photons).bursts_written, 0u);
}

TEST(HierarchyWriters, WhoWritesALineBackOwnsItWhereItGoes) {
    Drawn d({one_set("L1", 1), one_set("L2", 3), one_set("L3", 2, Inclusion::inclusive)});
    EXPECT_EQ(d.read('A', photons), "A|A|A");
    EXPECT_EQ(d.write('A', buffer), "A|A|A");  // a hit in L1: L2 and L3 know of photons only
    EXPECT_EQ(d.read('B', other), "B|AB|AB");  // L2 gets A from buffer
    EXPECT_EQ(d.read('C', other), "C|BC|BC");  // L3 drops A and takes it from L2
    EXPECT_EQ(d.at(1, buffer).back_invalidations, 1u);
    EXPECT_EQ(d.at(1, photons).back_invalidations, 0u);
    EXPECT_EQ(d.at(1, buffer).writebacks, 1u);
    EXPECT_EQ(d.at(2, buffer).writebacks, 1u);
}

TEST(HierarchyWriters, ALineThatComesUpThroughTwoExclusiveLevelsIsStillItsWriters) {
    Drawn d(
        {one_set("L1", 1), one_set("L2", 1, Inclusion::exclusive), one_set("L3", 2, Inclusion::exclusive)});
    EXPECT_EQ(d.write('A', buffer), "A||");
    EXPECT_EQ(d.read('B', other), "B|A|");
    EXPECT_EQ(d.read('C', other), "C|B|A");
    EXPECT_EQ(d.read('A', photons), "A|C|B");  // past L2, which does not have it
    EXPECT_EQ(d.read('D', other), "D|A|BC");
    EXPECT_EQ(d.at(0, buffer).writebacks, 2u);
    EXPECT_EQ(d.at(0, photons).writebacks, 0u);
    d.hierarchy.flush();
    EXPECT_EQ(d.hierarchy.dram()->stats(buffer).bursts_written, 1u);
    EXPECT_EQ(d.hierarchy.dram()->stats(photons).bursts_written, 0u);
}

/// Sectors of 32 B: A.0 and A.1 are those of line A; a prime marks a dirty one.
TEST(HierarchyWriters, AWriteBackTakesTheDirtySectorsOfTheExclusiveCopyBelowAlong) {
    std::vector<LevelConfig> levels{one_set("L1", 2), one_set("L2", 1),
                                    one_set("L3", 4, Inclusion::exclusive)};
    for (LevelConfig& level : levels) level.sector_bytes = 32;
    Hierarchy hierarchy(levels, DramConfig{.row_bytes = 64, .burst_bytes = 32, .channel_bytes = 32});
    const std::uint64_t a = 0, b = 64, c = 128, d = 192, e = 256;
    write(hierarchy, a + 32, 8, buffer);  // L1 A.1'             L2 A.1         L3
    read(hierarchy, b, 8, other);         // L1 A.1' B.0         L2 B.0         L3 A.1
    read(hierarchy, c, 8, other);  // L1 B.0 C.0          L2 A.1'        L3 B.0 C.0      A comes back up
    EXPECT_TRUE(hierarchy.holds(1, Line{0}, 1));
    EXPECT_FALSE(hierarchy.holds(2, Line{0}));
    write(hierarchy, a, 8, photons);  // L1 C.0 A.0'         L2 A.0 A.1'    L3 B.0 C.0
    EXPECT_TRUE(hierarchy.holds(1, Line{0}, 0));
    read(hierarchy, d, 8, other);  // L1 A.0' D.0         L2 D.0         L3 B.0 C.0 A.0 A.1'
    EXPECT_TRUE(hierarchy.holds(2, Line{0}, 1));
    read(hierarchy, e, 8, other);  // L1 D.0 E.0          L2 A.0' A.1'   L3 B.0 C.0 D.0 E.0
    EXPECT_TRUE(hierarchy.holds(1, Line{0}, 0));
    EXPECT_TRUE(hierarchy.holds(1, Line{0}, 1));
    EXPECT_FALSE(hierarchy.holds(2, Line{0}));
    hierarchy.flush();
    // Both sectors, by the writer of the last.
    EXPECT_EQ(hierarchy.dram()->stats(photons).bursts_written, 2u);
    EXPECT_EQ(hierarchy.dram()->stats(buffer).bursts_written, 0u);
    EXPECT_EQ(hierarchy.stats(1, photons).bytes_out, 64u);
}

}  // namespace
}  // namespace regather::cachesim
