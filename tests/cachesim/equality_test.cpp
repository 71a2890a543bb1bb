// LruCache against the list of the definition, over geometries, line numbers, kinds, regions, batches, and
// every instruction set that the kernel is compiled for and this machine has.
#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <rapidcheck.h>

#include "tests/cachesim/brute_force.h"

namespace regather::cachesim {
namespace {

/// Where lines lie: low; about the first tag that 32 bits cannot hold in any number of sets up to 64; high;
/// the last.
constexpr std::uint64_t bases[] = {0,          0,           0, 0, 0x1fffffffull << 4, 0x1fffffffull << 6,
                                   1ull << 45, ~0ull - 1023};

TEST(LruCache, EqualsAListForEachSet) {
    ASSERT_TRUE(rc::check("the counts of each region, after each batch and after a flush", [] {
        const std::uint64_t sets = 1u << *rc::gen::inRange(0, 8);
        const auto ways =
            *rc::gen::weightedElement<std::uint32_t>({{3, *rc::gen::inRange<std::uint32_t>(1, 9)},
                                                      {2, *rc::gen::inRange<std::uint32_t>(9, 41)},
                                                      {1, fully_associative}});
        const std::uint32_t line_bytes = 1u << *rc::gen::inRange(0, 9);
        const CacheConfig config{sets * line_bytes * (ways == fully_associative ? 5 : ways), line_bytes,
                                 ways};
        const bool wide = *rc::gen::arbitrary<bool>(), writes = *rc::gen::arbitrary<bool>();
        const auto spread = *rc::gen::inRange<std::uint64_t>(1, 1024);
        // Each number is an access: which line, where, written or not, by whom, and whether a batch ends
        // here.
        const auto choices = *rc::gen::resize(3000, rc::gen::arbitrary<std::vector<std::uint32_t>>());

        LruCache cache(config);
        BruteForceLru list(config);
        std::vector<Line> lines;
        std::vector<Access> kinds;
        for (std::size_t i = 0; i < choices.size(); ++i) {
            const std::uint32_t choice = choices[i];
            lines.push_back(Line{bases[wide ? choice >> 10 & 7 : 0] + (choice & 1023) % spread});
            kinds.push_back(writes && (choice >> 13 & 3) == 0 ? Access::write : Access::read);
            if ((choice >> 15 & 15) != 0 && i + 1 < choices.size()) continue;
            const auto region = static_cast<trace::Region>((choice >> 19 & 255) % trace::region_count);
            const bool uniform = (choice >> 27 & 1) != 0;
            if (uniform) std::fill(kinds.begin(), kinds.end(), kinds.front());
            for (std::size_t j = 0; j < lines.size(); ++j) list.access(lines[j], region, kinds[j]);
            if (uniform)
                cache.access(lines, region, kinds.front());
            else
                cache.access(lines, kinds, region);
            RC_ASSERT(stats_of(cache) == list.stats);
            lines.clear();
            kinds.clear();
        }
        cache.flush();
        list.flush();
        RC_ASSERT(stats_of(cache) == list.stats);
    }));
}

/// 20,000 accesses by a skewed choice among a few thousand lines: hits at every depth, and misses.
std::vector<Line> skewed_lines(std::uint64_t base) {
    Scatter scatter(7);
    std::vector<Line> lines(20'000);
    for (Line& line : lines) line = Line{base + scatter.below(1 + scatter.below(4096))};
    return lines;
}

class InstructionSets : public testing::Test {
protected:
    void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

TEST_F(InstructionSets, AllCountTheSame) {
    const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
    ASSERT_GE(targets.size(), 2u);
    for (const std::uint32_t ways : {1u, 2u, 3u, 4u, 6u, 8u, 11u, 16u, 20u, 32u})
        for (const std::uint64_t base :
             {std::uint64_t{0}, (std::uint64_t{1} << 33) - 2000, std::uint64_t{1} << 60})
            for (const bool write_some : {false, true}) {
                const CacheConfig config{std::uint64_t{16} * 64 * ways, 64, ways};
                const std::vector<Line> lines = skewed_lines(base);
                std::vector<Access> kinds(lines.size(), Access::read);
                for (std::size_t i = 0; write_some && i < kinds.size(); i += 3) kinds[i] = Access::write;

                BruteForceLru list(config);
                for (std::size_t i = 0; i < lines.size(); ++i)
                    list.access(lines[i], trace::Region::reorder_buffer, kinds[i]);
                list.flush();
                for (const std::int64_t target : targets) {
                    hwy::SetSupportedTargetsForTest(target);
                    LruCache cache(config);
                    if (write_some)
                        cache.access(lines, kinds, trace::Region::reorder_buffer);
                    else
                        cache.access(lines, trace::Region::reorder_buffer);
                    cache.flush();
                    ASSERT_EQ(stats_of(cache), list.stats)
                        << hwy::TargetName(target) << ", " << ways << " ways";
                }
            }
}

TEST(LruCache, EqualsAListWithManyWays) {
    for (const CacheConfig& config :
         {CacheConfig{64 * 1024, 64, fully_associative}, CacheConfig{64 * 1024, 64, 256},
          CacheConfig{4 * 33 * 64, 64, 33}, CacheConfig{512 * 33 * 64, 64, 33}}) {
        LruCache cache(config);
        BruteForceLru list(config);
        const std::vector<Line> lines = skewed_lines(std::uint64_t{1} << 60);
        for (const Line line : lines) list.access(line, trace::Region::photons, Access::read);
        cache.access(lines, trace::Region::photons);
        EXPECT_EQ(stats_of(cache), list.stats);
    }
}

}  // namespace
}  // namespace regather::cachesim
