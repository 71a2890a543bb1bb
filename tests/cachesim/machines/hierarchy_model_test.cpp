// Small machines of every kind against a second, plain model of docs/machines.md: contents and counts of
// every level and region after every access.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/cachesim/machines/any_hierarchy.h"
#include "tests/cachesim/machines/plain_hierarchy.h"

namespace regather::cachesim {
namespace {

std::string text(const LevelStats& s) {
    return fmt::format(
        "accesses {} hits {} misses {} sector misses {} victim hits {} writebacks {} clean victims {} passed "
        "writes {} back invalidations {} prefetches {} {} bytes in {} out {}",
        s.accesses, s.hits, s.misses, s.sector_misses, s.victim_hits, s.writebacks, s.clean_victims,
        s.passed_writes, s.back_invalidations, s.prefetches, s.useful_prefetches, s.bytes_in, s.bytes_out);
}

void expect_equal(const Hierarchy& hierarchy, PlainHierarchy& plain) {
    for (std::size_t level = 0; level < hierarchy.levels(); ++level) {
        const unsigned sectors = 64 / hierarchy.config(level).sector();
        for (std::uint64_t line = 0; line < lines_asked + 3; ++line)
            for (unsigned sector = 0; sector < sectors; ++sector)
                RC_ASSERT(hierarchy.holds(level, Line{line}, sector) == plain.holds(level, line, sector));
        for (std::size_t r = 0; r < trace::region_count; ++r) {
            const auto region = static_cast<trace::Region>(r);
            RC_ASSERT(text(hierarchy.stats(level, region)) == text(plain.stats(level, region)));
        }
    }
    for (std::size_t r = 0; r < trace::region_count; ++r) {
        const DramStats& dram = hierarchy.dram()->stats(static_cast<trace::Region>(r));
        RC_ASSERT(dram.bursts_read == plain.bursts_read[r]);
        RC_ASSERT(dram.bursts_written == plain.bursts_written[r]);
    }
}

TEST(HierarchyModel, EveryMachineDoesWhatThePagesSay) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<LevelConfig> levels = any_levels(one_of({1u, 2u, 3u, 4u}), true);
        Hierarchy hierarchy(levels, small_dram);
        PlainHierarchy plain(levels);
        int number = 0;
        for (const Step& step : any_steps(250)) {
            run(hierarchy, step);
            plain.access(step.access, step.region);
            if (++number % 5 == 0) expect_equal(hierarchy, plain);
        }
        hierarchy.flush();
        plain.flush();
        expect_equal(hierarchy, plain);
    }));
}

}  // namespace
}  // namespace regather::cachesim
