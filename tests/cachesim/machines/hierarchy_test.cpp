// Hierarchies small enough to draw: levels of one set, and what each holds after each access.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cachesim/machines/drawn_hierarchy.h"
#include "trace/error.h"

namespace regather::cachesim {
namespace {

using testing::HasSubstr;

// ---- inclusion ----

TEST(Hierarchy, NeitherLetsTheNearLevelKeepWhatTheFarOneLost) {
    Drawn d({one_set("L1", 2), one_set("L2", 2)});
    EXPECT_EQ(d.read('A'), "A|A");
    EXPECT_EQ(d.read('B'), "AB|AB");
    EXPECT_EQ(d.read('A'), "AB|AB");  // a hit that L2 does not see
    EXPECT_EQ(d.read('C'), "AC|BC");  // L1 drops B, L2 drops A
    EXPECT_EQ(d.read('B'), "BC|BC");  // L1 drops A; found in L2
    EXPECT_EQ(d.at(0).accesses, 5u);
    EXPECT_EQ(d.at(0).hits, 1u);
    EXPECT_EQ(d.at(0).misses, 4u);
    EXPECT_EQ(d.at(1).accesses, 4u);
    EXPECT_EQ(d.at(1).hits, 1u);
    EXPECT_EQ(d.at(1).misses, 3u);
    EXPECT_EQ(d.at(0).bytes_in, 4u * 64);
    EXPECT_EQ(d.at(1).bytes_in, 3u * 64);
    EXPECT_EQ(d.hierarchy.dram()->total().bursts_read, 3u);
}

TEST(Hierarchy, InclusiveTakesBackWhatItEvicts) {
    Drawn d({one_set("L1", 2), one_set("L2", 2, Inclusion::inclusive)});
    EXPECT_EQ(d.read('A'), "A|A");
    EXPECT_EQ(d.read('B'), "AB|AB");
    EXPECT_EQ(d.read('A'), "AB|AB");
    EXPECT_EQ(d.read('C'), "BC|BC");  // L2 drops A and takes it from L1; B need not go
    EXPECT_EQ(d.at(0).back_invalidations, 1u);
    EXPECT_EQ(d.read('A'), "AC|AC");  // L2 drops B and takes it from L1
    EXPECT_EQ(d.at(0).back_invalidations, 2u);
    EXPECT_EQ(d.at(0).misses, 4u);
    EXPECT_EQ(d.at(1).misses, 4u);
}

TEST(Hierarchy, InclusiveWritesBackTheDirtyCopyThatItTakes) {
    Drawn d({one_set("L1", 2), one_set("L2", 2, Inclusion::inclusive)});
    d.read('A', photons);
    d.write('A', buffer);
    d.read('B');
    EXPECT_EQ(d.read('C'), "BC|BC");  // A goes: L1's copy is dirty, L2's is not
    EXPECT_EQ(d.at(0, buffer).writebacks, 1u);
    EXPECT_EQ(d.at(0, buffer).bytes_out, 64u);
    EXPECT_EQ(d.at(1, buffer).writebacks, 1u);
    EXPECT_EQ(d.at(1, buffer).bytes_out, 64u);
    EXPECT_EQ(d.at(1, photons).writebacks, 0u);
    EXPECT_EQ(d.hierarchy.dram()->stats(buffer).bursts_written, 1u);
}

TEST(Hierarchy, InclusiveThirdLevelReachesOverTheSecond) {
    Drawn d({one_set("L1", 3), one_set("L2", 1), one_set("L3", 2, Inclusion::inclusive)});
    EXPECT_EQ(d.read('A'), "A|A|A");
    EXPECT_EQ(d.read('B'), "AB|B|AB");
    EXPECT_EQ(d.read('C'), "BC|C|BC");  // L3 drops A; L2 has lost it already, L1 has not
}

TEST(Hierarchy, ExclusiveHoldsTheVictimsOfTheLevelAbove) {
    Drawn d({one_set("L1", 2), one_set("L2", 2, Inclusion::exclusive)});
    EXPECT_EQ(d.read('A'), "A|");
    EXPECT_EQ(d.read('B'), "AB|");
    EXPECT_EQ(d.read('C'), "BC|A");
    EXPECT_EQ(d.read('D'), "CD|AB");
    EXPECT_EQ(d.read('A'), "AD|BC");  // A moves up, C goes down into its place
    EXPECT_EQ(d.read('E'), "AE|CD");  // D goes down, B out
    EXPECT_EQ(d.at(1).accesses, 6u);
    EXPECT_EQ(d.at(1).hits, 1u);
    EXPECT_EQ(d.at(0).clean_victims, 4u);
    EXPECT_EQ(d.at(0).bytes_out, 4u * 64);
    EXPECT_EQ(d.at(0).writebacks, 0u);
    EXPECT_EQ(d.at(1).bytes_out, 0u);  // B was clean
    EXPECT_EQ(d.at(1).bytes_in, 5u * 64);
}

TEST(Hierarchy, ADirtyLineStaysDirtyOnItsWayDownAndUp) {
    Drawn d({one_set("L1", 1), one_set("L2", 1, Inclusion::exclusive)});
    EXPECT_EQ(d.write('A', buffer), "A|");
    EXPECT_EQ(d.read('B'), "B|A");
    EXPECT_EQ(d.read('A'), "A|B");  // read, but still dirty
    EXPECT_EQ(d.read('C'), "C|A");
    EXPECT_EQ(d.hierarchy.dram()->total().bursts_written, 0u);
    EXPECT_EQ(d.read('D'), "D|C");  // now A goes to memory, on the account of its writer
    EXPECT_EQ(d.at(0, buffer).writebacks, 2u);
    EXPECT_EQ(d.at(1, buffer).writebacks, 1u);
    EXPECT_EQ(d.hierarchy.dram()->stats(buffer).bursts_written, 1u);
}

TEST(Hierarchy, AWriteBackThatFillsTheSecondLevelEmptiesTheExclusiveThird) {
    Drawn d({one_set("L1", 2), one_set("L2", 1), one_set("L3", 2, Inclusion::exclusive)});
    EXPECT_EQ(d.write('A'), "A|A|");
    EXPECT_EQ(d.read('B'), "AB|B|A");
    EXPECT_EQ(d.read('C'),
              "BC|A|BC");  // C: L2 drops B to L3; then dirty A goes from L1 into L2, out of L3; C down
}

TEST(Hierarchy, TwoExclusiveLevelsPassALineDownStepByStep) {
    Drawn d(
        {one_set("L1", 1), one_set("L2", 1, Inclusion::exclusive), one_set("L3", 1, Inclusion::exclusive)});
    EXPECT_EQ(d.read('A'), "A||");
    EXPECT_EQ(d.read('B'), "B|A|");
    EXPECT_EQ(d.read('C'), "C|B|A");
    EXPECT_EQ(d.read('A'), "A|C|B");
    EXPECT_EQ(d.read('D'), "D|A|C");
}

// ---- writes ----

TEST(Hierarchy, AWriteBackIntoAMissingLineFetchesNothing) {
    Drawn d({one_set("L1", 2), one_set("L2", 1)});
    d.write('A');
    EXPECT_EQ(d.read('B'), "AB|B");
    EXPECT_EQ(d.read('C'), "BC|A");  // L2: C, then A, which is whole
    EXPECT_EQ(d.at(1).accesses, 3u);
    EXPECT_EQ(d.at(1).bytes_in, 3u * 64);
    EXPECT_EQ(d.hierarchy.dram()->total().bursts_read, 3u);
    d.hierarchy.flush();
    EXPECT_EQ(d.contents(), "|");
    EXPECT_EQ(d.at(1).writebacks, 1u);
    EXPECT_EQ(d.hierarchy.dram()->total().bursts_written, 1u);
}

TEST(Hierarchy, WriteThroughSendsTheBytesWrittenAndDirtiesNothing) {
    std::vector<LevelConfig> levels{one_set("L1", 1), one_set("L2", 2)};
    levels[0].cache.write = WritePolicy::through;
    Drawn d(levels);
    EXPECT_EQ(d.write('A'), "A|A");  // fetched through both levels, then written in both
    EXPECT_EQ(d.at(0).misses, 1u);
    EXPECT_EQ(d.at(1).accesses, 1u);
    EXPECT_EQ(d.at(0).passed_writes, 1u);
    EXPECT_EQ(d.at(0).bytes_out, 8u);
    d.write('A');
    EXPECT_EQ(d.at(0).hits, 1u);
    EXPECT_EQ(d.at(1).accesses, 1u);  // a write that hit above is no demand here
    EXPECT_EQ(d.at(0).bytes_out, 16u);
    d.read('B');
    EXPECT_EQ(d.at(0).writebacks, 0u);
    d.hierarchy.flush();
    EXPECT_EQ(d.at(1).writebacks, 1u);
}

TEST(Hierarchy, NoAllocateLeavesAMissedWriteToTheLevelBelow) {
    std::vector<LevelConfig> levels{one_set("L1", 1), one_set("L2", 2)};
    levels[0].cache.write_miss = WriteMiss::no_allocate;
    Drawn d(levels);
    EXPECT_EQ(d.write('A'), "|A");
    EXPECT_EQ(d.at(0).misses, 1u);
    EXPECT_EQ(d.at(0).bytes_in, 0u);
    EXPECT_EQ(d.at(0).bytes_out, 8u);
    EXPECT_EQ(d.at(1).accesses, 1u);
    EXPECT_EQ(d.at(1).misses, 1u);
    EXPECT_EQ(d.read('A'), "A|A");
    EXPECT_EQ(d.at(1).hits, 1u);
    d.write('A');  // a hit is written here and goes nowhere
    EXPECT_EQ(d.at(0).bytes_out, 8u);
    d.hierarchy.flush();
    EXPECT_EQ(d.at(0).writebacks, 1u);
    EXPECT_EQ(d.at(1).writebacks, 1u);
}

TEST(Hierarchy, WritesPastTheLastLevelReachMemoryAsTheBytesWritten) {
    std::vector<LevelConfig> levels{one_set("L1", 1)};
    levels[0].cache.write_miss = WriteMiss::no_allocate;
    Hierarchy h(levels, DramConfig{.row_bytes = 64, .burst_bytes = 16, .channel_bytes = 16});
    write(h, 20, 20);  // bytes 20 to 39: bursts 1 and 2
    EXPECT_EQ(h.dram()->total().bursts_written, 2u);
    EXPECT_EQ(h.dram()->total().bursts_read, 0u);
    EXPECT_EQ(h.stats(0, photons).bytes_out, 20u);
}

TEST(Hierarchy, ChargesAWriteBackToTheLastWriterAndAFetchToTheReader) {
    Drawn d({one_set("L1", 1)});
    d.write('A', photons);
    d.write('A', buffer);
    d.read('B', photons);
    EXPECT_EQ(d.at(0, buffer).writebacks, 1u);
    EXPECT_EQ(d.at(0, photons).writebacks, 0u);
    EXPECT_EQ(d.at(0, buffer).bytes_in, 0u);
    EXPECT_EQ(d.at(0, photons).bytes_in, 128u);
    EXPECT_EQ(d.hierarchy.total(0).accesses, 3u);
}

TEST(Hierarchy, AnAccessThatStraddlesLinesIsOneAccessToEach) {
    Hierarchy h(std::vector{one_set("L1", 4)});
    read(h, 60, 8);    // lines 0, 1
    read(h, 64, 64);   // line 1
    read(h, 100, 0);   // none
    read(h, 63, 129);  // lines 0, 1, 2
    EXPECT_EQ(h.total(0).accesses, 6u);
    EXPECT_EQ(h.total(0).misses, 3u);
}

// ---- victim buffer ----

TEST(Hierarchy, AVictimBufferSwapsTwoLinesThatFightForOneWay) {
    std::vector<LevelConfig> levels{one_set("L1", 1), one_set("L2", 8)};
    levels[0].victim_lines = 1;
    Drawn d(levels);
    d.read('A');
    EXPECT_EQ(d.read('B'), "AB|AB");   // B in the cache, A in the buffer
    EXPECT_EQ(d.read('A'), "AB|AB");   // swapped
    EXPECT_EQ(d.read('B'), "AB|AB");   // and back
    EXPECT_EQ(d.read('C'), "BC|ABC");  // B into the buffer, A out of it
    EXPECT_EQ(d.at(0).hits, 2u);
    EXPECT_EQ(d.at(0).victim_hits, 2u);
    EXPECT_EQ(d.at(0).misses, 3u);
    EXPECT_EQ(d.at(1).accesses, 3u);
}

TEST(Hierarchy, ADirtyLineIsWrittenBackWhenItLeavesTheVictimBuffer) {
    std::vector<LevelConfig> levels{one_set("L1", 1)};
    levels[0].victim_lines = 1;
    Drawn d(levels);
    d.write('A');
    d.read('B');
    EXPECT_EQ(d.at(0).writebacks, 0u);
    EXPECT_EQ(d.read('C'), "BC");
    EXPECT_EQ(d.at(0).writebacks, 1u);
    d.write('B');  // from the buffer
    d.hierarchy.flush();
    EXPECT_EQ(d.at(0).writebacks, 2u);
}

TEST(Hierarchy, AnInclusiveLevelTakesLinesFromVictimBuffersToo) {
    std::vector<LevelConfig> levels{one_set("L1", 1), one_set("L2", 2, Inclusion::inclusive)};
    levels[0].victim_lines = 2;
    Drawn d(levels);
    d.read('A');
    EXPECT_EQ(d.read('B'), "AB|AB");
    EXPECT_EQ(d.read('C'), "BC|BC");
}

// ---- sectors: lines of 128 B, sectors of 32 B ----

std::vector<LevelConfig> sectored(std::initializer_list<std::uint32_t> ways) {
    std::vector<LevelConfig> levels;
    for (const std::uint32_t w : ways) {
        levels.push_back({.name = std::to_string(levels.size()), .sector_bytes = 32});
        levels.back().cache.geometry = {128ull * w, 128, w};
    }
    return levels;
}

TEST(Hierarchy, ASectorMissFetchesTheSectorsThatAreMissing) {
    Hierarchy h(sectored({1, 4}), DramConfig{.row_bytes = 128, .burst_bytes = 32, .channel_bytes = 32});
    read(h, 0, 4);     // sector 0: no line      +32
    read(h, 8, 4);     // sector 0: hit
    read(h, 40, 4);    // sector 1: sector miss  +32
    read(h, 60, 8);    // sectors 1, 2: 2 lacks  +32
    read(h, 0, 128);   // all: 3 lacks           +32
    read(h, 100, 28);  // sector 3: hit
    EXPECT_TRUE(h.holds(0, Line{0}, 3));
    const LevelStats near = h.stats(0, photons), far = h.stats(1, photons);
    EXPECT_EQ(near.accesses, 6u);
    EXPECT_EQ(near.hits, 2u);
    EXPECT_EQ(near.misses, 4u);
    EXPECT_EQ(near.sector_misses, 3u);
    EXPECT_EQ(near.bytes_in, 128u);
    EXPECT_EQ(far.accesses, 4u);
    EXPECT_EQ(far.bytes_in, 128u);
    read(h, 128 + 64, 32);  // pushes line 0 out
    EXPECT_FALSE(h.holds(0, Line{0}));
    EXPECT_FALSE(h.holds(0, Line{1}, 1));
    EXPECT_TRUE(h.holds(0, Line{1}, 2));
    read(h, 0, 128);  // one access; all four sectors from the second level
    EXPECT_EQ(h.stats(0, photons).bytes_in, 128u + 32 + 128);
    EXPECT_EQ(h.stats(1, photons).bytes_in, 128u + 32);
    EXPECT_EQ(h.dram()->total().bursts_read, 5u);
}

TEST(Hierarchy, OnlyDirtySectorsAreWrittenBack) {
    Hierarchy h(sectored({1}), DramConfig{.row_bytes = 128, .burst_bytes = 32, .channel_bytes = 32});
    read(h, 0, 128);
    write(h, 30, 4);   // sectors 0 and 1
    write(h, 127, 1);  // sector 3
    read(h, 128, 1);
    EXPECT_EQ(h.stats(0, photons).writebacks, 1u);
    EXPECT_EQ(h.stats(0, photons).bytes_out, 96u);
    EXPECT_EQ(h.dram()->total().bursts_written, 3u);
}

TEST(Hierarchy, AnExclusiveLevelKeepsAndReturnsTheSectorsThatItWasGiven) {
    std::vector<LevelConfig> levels = sectored({1, 2});
    levels[1].inclusion = Inclusion::exclusive;
    Hierarchy h(levels);
    write(h, 0, 4);   // line 0, sector 0, dirty
    read(h, 128, 4);  // line 0 goes down
    EXPECT_EQ(h.stats(0, photons).bytes_out, 32u);
    EXPECT_TRUE(h.holds(1, Line{0}, 0));
    read(h, 32, 4);  // sector 1 is in neither: it comes from memory, and sector 0 moves up with it
    EXPECT_EQ(h.stats(1, photons).sector_misses, 1u);
    EXPECT_EQ(h.stats(1, photons).bytes_in, 3u * 32);
    EXPECT_EQ(h.stats(0, photons).bytes_in, 32u + 32 + 64);
    EXPECT_TRUE(h.holds(0, Line{0}, 0));
    EXPECT_TRUE(h.holds(0, Line{0}, 1));
    EXPECT_FALSE(h.holds(1, Line{0}));
    h.flush();
    EXPECT_EQ(h.stats(0, photons).bytes_out,
              32u + 32 + 32);  // line 0 dirty, line 1 clean, line 0's dirty sector
}

// ---- prefetch ----

Drawn prefetching(Prefetch prefetch, std::uint32_t ways = 8) {
    std::vector<LevelConfig> levels{one_set("L1", ways), one_set("L2", 16)};
    levels[0].prefetch = prefetch;
    return Drawn(levels);
}

TEST(Hierarchy, PrefetchOnMissHalvesTheMissesOfAScan) {
    Drawn d = prefetching(Prefetch::on_miss);
    EXPECT_EQ(d.read('A'), "AB|AB");
    EXPECT_EQ(d.read('B'), "AB|AB");
    EXPECT_EQ(d.read('C'), "ABCD|ABCD");
    EXPECT_EQ(d.read('D'), "ABCD|ABCD");
    EXPECT_EQ(d.at(0).misses, 2u);
    EXPECT_EQ(d.at(0).prefetches, 2u);
    EXPECT_EQ(d.at(0).useful_prefetches, 2u);
    EXPECT_EQ(d.at(0).bytes_in, 4u * 64);
    EXPECT_EQ(d.at(1).accesses, 2u);  // prefetches are no demand
    EXPECT_EQ(d.at(1).bytes_in, 4u * 64);
}

TEST(Hierarchy, TaggedPrefetchMissesAScanOnce) {
    Drawn d = prefetching(Prefetch::tagged);
    EXPECT_EQ(d.read('A'), "AB|AB");
    EXPECT_EQ(d.read('A'), "AB|AB");    // not a first use of a prefetched line
    EXPECT_EQ(d.read('B'), "ABC|ABC");  // the first
    EXPECT_EQ(d.read('B'), "ABC|ABC");
    EXPECT_EQ(d.read('C'), "ABCD|ABCD");
    EXPECT_EQ(d.at(0).misses, 1u);
    EXPECT_EQ(d.at(0).prefetches, 3u);
    EXPECT_EQ(d.at(0).useful_prefetches, 2u);
}

TEST(Hierarchy, PrefetchAlwaysFetchesTheNextLineOfAHitUnlessItIsHere) {
    Drawn d = prefetching(Prefetch::always, 2);
    EXPECT_EQ(d.read('A'), "AB|AB");
    EXPECT_EQ(d.read('A'), "AB|AB");
    EXPECT_EQ(d.at(0).prefetches, 1u);
    EXPECT_EQ(d.read('D'), "DE|ABDE");
    EXPECT_EQ(d.read('C'), "CD|ABCDE");  // C pushes out D, the older of the two, and fetches it again
    EXPECT_EQ(d.at(0).prefetches, 3u);
    EXPECT_EQ(d.at(0).useful_prefetches, 0u);
    EXPECT_EQ(d.at(0).misses, 3u);
}

TEST(Hierarchy, APrefetchIsChargedToTheRegionWhoseAccessAskedForIt) {
    Drawn d = prefetching(Prefetch::on_miss);
    d.read('A', buffer);
    d.read('B', photons);
    EXPECT_EQ(d.at(0, buffer).prefetches, 1u);
    EXPECT_EQ(d.at(0, buffer).useful_prefetches, 1u);
    EXPECT_EQ(d.at(0, buffer).bytes_in, 128u);
    EXPECT_EQ(d.at(0, photons).useful_prefetches, 0u);
    EXPECT_EQ(d.at(0, photons).hits, 1u);
}

TEST(Hierarchy, TheLastLineHasNoNext) {
    std::vector<LevelConfig> levels{one_set("L1", 2)};
    levels[0].prefetch = Prefetch::on_miss;
    Hierarchy h(levels, DramConfig{});
    read(h, ~std::uint64_t{0} - 3, 4);
    EXPECT_EQ(h.total(0).prefetches, 0u);
    EXPECT_FALSE(h.holds(0, Line{0}));
}

TEST(Hierarchy, APrefetchBelowAnInclusiveLevelNeverBreaksInclusion) {
    std::vector<LevelConfig> levels{one_set("L1", 2), one_set("L2", 1, Inclusion::inclusive)};
    levels[1].prefetch = Prefetch::on_miss;
    Drawn d(levels);
    EXPECT_EQ(d.read('A'), "|B");  // B pushes A out of L2, which takes it from L1
}

// ---- what is refused ----

TEST(Hierarchy, RefusesLevelsThatDoNotFitTogether) {
    const auto refusal = [](auto change) -> std::string {
        std::vector<LevelConfig> levels{one_set("L1", 2), one_set("L2", 4)};
        change(levels);
        try {
            const Hierarchy h(levels);
        } catch (const trace::UsageError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_EQ(refusal([](auto&) {}), "none");
    EXPECT_EQ(refusal([](auto& l) { l.clear(); }), "levels: found 0, expected 1 to 4");
    EXPECT_EQ(refusal([](auto& l) { l.resize(5); }), "levels: found 5, expected 1 to 4");
    EXPECT_EQ(refusal([](auto& l) {
                  l[1].cache.geometry = {512, 128, 4};
              }),
              "levels[1].line_bytes: found 128, expected 64 as in levels[0]: all levels have the same line");
    EXPECT_EQ(
        refusal([](auto& l) { l[1].sector_bytes = 32; }),
        "levels[1].sector_bytes: found 32, expected 64 as in levels[0]: all levels have the same sector");
    EXPECT_EQ(refusal([](auto& l) { l[0].sector_bytes = 48; }),
              "levels[0].sector_bytes: found 48, expected a power of two from 2 to the line of 64 bytes");
    EXPECT_EQ(refusal([](auto& l) { l[0].inclusion = Inclusion::inclusive; }),
              "levels[0].inclusion: found inclusive, expected neither: no level is above it");
    EXPECT_EQ(refusal([](auto& l) { l[1].name = "L1"; }),
              "levels[1].name: found L1, expected another name than that of levels[0]");
    EXPECT_EQ(refusal([](auto& l) { l[0].victim_lines = 5000; }),
              "levels[0].victim_lines: found 5000, expected 0 to 4096");
    EXPECT_THAT(refusal([](auto& l) { l[1].cache.policy = Policy::opt; }),
                HasSubstr("levels[1].policy: found opt"));
    EXPECT_THAT(refusal([](auto& l) { l[1].cache.geometry.size_bytes = 100; }),
                HasSubstr("levels[1].size_bytes: found 100"));
    EXPECT_THAT(refusal([](auto& l) {
                    l[1].cache.geometry = {std::uint64_t{1} << 32, 64, 4};
                }),
                HasSubstr("levels[1].size_bytes: found 4294967296, expected at most 16777216 lines"));
    EXPECT_THAT(refusal([](auto& l) {
                    l[1].inclusion = Inclusion::exclusive;
                    l[0].cache.write = WritePolicy::through;
                }),
                HasSubstr("levels[0].write: found through, expected back: levels[1] is exclusive"));
    EXPECT_THAT(refusal([](auto& l) {
                    l[1].inclusion = Inclusion::exclusive;
                    l[1].prefetch = Prefetch::tagged;
                }),
                HasSubstr("levels[1].prefetch: found tagged, expected none"));
}

}  // namespace
}  // namespace regather::cachesim
