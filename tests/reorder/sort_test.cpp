#include "reorder/sort.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

std::vector<std::uint32_t> stable_order(const std::vector<std::uint64_t>& keys) {
    std::vector<std::uint32_t> order(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return keys[a] < keys[b]; });
    return order;
}

TEST(Sort, EqualsStableSortOnAnyKeys) {
    ASSERT_TRUE(rc::check([] {
        const auto bits = *rc::gen::inRange(0, 65);
        auto keys = *rc::gen::arbitrary<std::vector<std::uint64_t>>();
        for (std::uint64_t& key : keys) key = bits == 0 ? 0 : scrambled(key) >> (64 - bits);
        RC_ASSERT(sorted_permutation(keys) == stable_order(keys));
    }));
}

TEST(Sort, InvertsRanks) {
    EXPECT_EQ(sorted_permutation(std::vector<std::uint64_t>{2, 0, 3, 1}),
              (std::vector<std::uint32_t>{1, 3, 0, 2}));
    EXPECT_EQ(sorted_permutation(std::vector<std::uint64_t>{2, 0, 2, 1}),
              (std::vector<std::uint32_t>{1, 3, 0, 2}));
}

// Long enough for chunks, merged pieces and runs of equal tops that cross them.
TEST(Sort, LongInputsEqualStableSortOnOneAndTwoThreads) {
    constexpr std::size_t count = 300'000;
    const std::function<std::uint64_t(std::uint64_t)> kinds[] = {
        [](std::uint64_t i) { return scrambled(i); },         // 64 bits, hardly ties
        [](std::uint64_t i) { return scrambled(i) % 1000; },  // many ties
        [](std::uint64_t i) {
            return scrambled(i) % 3 << 62 | scrambled(~i) % 1000;
        },  // long runs of equal tops
        [](std::uint64_t i) { return i == 7 ? 0 : ~std::uint64_t{0} - scrambled(i) % 50; },
        [](std::uint64_t i) { return count - i; },
    };
    for (const auto& kind : kinds) {
        std::vector<std::uint64_t> keys(count);
        for (std::size_t i = 0; i < count; ++i) keys[i] = kind(i);
        const auto expected = stable_order(keys);
        for (const std::size_t threads : {1, 2}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            ASSERT_TRUE(sorted_permutation(keys) == expected) << threads << " threads, first key " << keys[0];
        }
    }
}

}  // namespace
}  // namespace regather::reorder
