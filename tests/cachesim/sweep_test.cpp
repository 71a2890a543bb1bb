#include "cachesim/sweep.h"

#include <gtest/gtest.h>

#include "tests/cachesim/brute_force.h"
#include "trace/error.h"

namespace regather::cachesim {
namespace {

std::vector<ByteAccess> scattered_accesses(bool write_some) {
    Scatter scatter(3);
    std::vector<ByteAccess> accesses(50'000);
    for (ByteAccess& access : accesses)
        access = {scatter.below(1 + scatter.below(1 << 16)), 1 + scatter.below(100),
                  write_some && scatter.below(4) == 0 ? Access::write : Access::read};
    return accesses;
}

TEST(Sweep, EveryCacheCountsAsIfItWereAlone) {
    const CacheConfig configs[] = {{16 * 1024, 64, 8}, {4 * 1024, 32, 1},  {16 * 1024, 64, fully_associative},
                                   {1024, 1, 4},       {12 * 1024, 64, 3}, {16 * 1024, 64, 8}};
    for (const bool write_some : {false, true}) {
        const std::vector<ByteAccess> accesses = scattered_accesses(write_some);
        Sweep sweep(configs);
        // In uneven batches: what a batch is must not matter.
        for (std::size_t begin = 0, size = 1; begin < accesses.size(); begin += size, size = size * 3 + 1)
            sweep.access(std::span(accesses).subspan(begin, std::min(size, accesses.size() - begin)));
        sweep.flush();
        ASSERT_EQ(sweep.caches().size(), std::size(configs));
        for (std::size_t i = 0; i < std::size(configs); ++i) {
            BruteForceLru list(configs[i]);
            for (const ByteAccess& access : accesses)
                for (std::uint64_t byte = access.address, line = ~std::uint64_t{0};
                     byte < access.address + access.bytes; ++byte)
                    if (byte / configs[i].line_bytes != line) {
                        line = byte / configs[i].line_bytes;
                        list.access(Line{line}, trace::Region::other, access.kind);
                    }
            list.flush();
            EXPECT_EQ(stats_of(sweep.caches()[i]), list.stats) << "cache " << i;
        }
    }
}

TEST(Sweep, ALongAccessTouchesEveryLine) {
    const CacheConfig configs[] = {{1024, 1, 1}, {1024, 128, 1}};
    Sweep sweep(configs);
    sweep.access(std::vector{ByteAccess{64, 1'000'000, Access::write}});
    sweep.flush();
    EXPECT_EQ(sweep.caches()[0].total(), (CacheStats{1'000'000, 1'000'000, 1'000'000}));
    EXPECT_EQ(sweep.caches()[1].total(),
              (CacheStats{7813, 7813, 7813}));  // bytes 64 to 1,000,063: lines 0 to 7812
}

TEST(Sweep, AnImpossibleGeometryIsRefused) {
    const CacheConfig configs[] = {{1024, 64, 1}, {1000, 64, 1}};
    EXPECT_THROW(Sweep sweep(configs), trace::UsageError);
}

}  // namespace
}  // namespace regather::cachesim
