// One pass over a family of caches against a simulation of each of them.
#include "cachesim/lru/family_sweep.h"

#include <gtest/gtest.h>

#include "cachesim/policies/policy_sweep.h"
#include "tests/cachesim/brute_force.h"

namespace regather::cachesim {
namespace {

TEST(FamilySweep, CountsAndClassesAreThoseOfEachCacheAlone) {
    Scatter scatter(4);
    std::vector<ByteAccess> accesses;
    for (int i = 0; i < 4000; ++i)
        accesses.push_back(
            {scatter.below(1 + scatter.below(3000)) * 20, 1 + scatter.below(60), Access::read});
    const std::vector<std::uint32_t> line_sizes{32, 64};
    FamilySweep family(line_sizes, 3, true);
    family.access(std::span(accesses).first(1500));
    family.access(std::span(accesses).subspan(1500));
    std::vector<FamilyRow> rows = family.rows();
    std::erase_if(rows, [](const FamilyRow& row) { return row.config.size_bytes > 32 * 1024; });
    ASSERT_GT(rows.size(), 2u * 3 * 8);
    std::vector<PolicyConfig> configs;
    for (const FamilyRow& row : rows) configs.push_back({row.config});
    PolicySweep sweep(configs, {});
    sweep.access(accesses);
    const std::vector<PolicyRow> alone = sweep.finish([](std::uint64_t, std::uint64_t) {});
    std::uint64_t conflicts = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].accesses, alone[i].stats.accesses) << i;
        EXPECT_EQ(rows[i].misses, alone[i].stats.misses) << i;
        EXPECT_EQ(static_cast<const MissClasses&>(rows[i]), *alone[i].classes) << i;
        conflicts += rows[i].conflict;
    }
    EXPECT_GT(conflicts, 0u);
}

/// Sizes of one line size after the other; of each the sets, then the ways; the full ones end where nothing
/// but first touches misses.
TEST(FamilySweep, ListsEveryCacheOnceAndFullOnesUpToTheStream) {
    std::vector<ByteAccess> accesses;
    for (std::uint64_t i = 0; i < 5; ++i) accesses.push_back({i * 64, 1, Access::read});
    accesses.push_back(accesses.front());
    const std::vector<std::uint32_t> line_sizes{64};
    FamilySweep family(line_sizes, 2, false);
    family.access(accesses);
    const std::vector<FamilyRow> rows = family.rows();
    ASSERT_EQ(rows.size(), 17u * 2 + 4);  // full: 1, 2, 4 and 8 lines
    EXPECT_EQ(rows[3].config.size_bytes, 2u * 2 * 64);
    EXPECT_EQ(rows[3].config.ways, 2u);
    EXPECT_EQ(rows.back().config.size_bytes, 8u * 64);
    EXPECT_EQ(rows.back().config.ways, fully_associative);
    EXPECT_EQ(rows.back().misses, 5u);
    EXPECT_EQ(rows[rows.size() - 2].misses, 6u);
}

}  // namespace
}  // namespace regather::cachesim
