#include "replay/pixel_traffic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "replay/replay.h"
#include "tests/replay/traced.h"
#include "trace/error.h"

namespace regather::replay {
namespace {
constexpr cachesim::CacheConfig cache{.size_bytes = 4096, .line_bytes = 64, .ways = 4};

std::vector<std::uint64_t> traffic(const Searched& searched, const std::vector<std::uint32_t>& order,
                                   const std::vector<std::uint32_t>& pixels, std::uint64_t count) {
    return pixel_traffic(searched.walks(), searched.layout(), order, pixels, count, cache);
}

TEST(PixelTraffic, EachQueryIsChargedWhatAListOfItsMissesSays) {
    const Searched searched(2000, 120, 10);
    std::vector<std::uint32_t> order(120), pixels(120);
    std::iota(order.rbegin(), order.rend(), 0u);
    for (std::uint32_t q = 0; q < 120; ++q) pixels[q] = q / 10;
    // By hand: 16 sets of 4, most recent first.
    std::vector<std::list<std::uint64_t>> sets(16);
    std::vector<std::uint64_t> expected(13);
    for (const std::uint32_t q : order)
        for (const std::uint64_t line : searched.lines_of(q, 64)) {
            std::list<std::uint64_t>& set = sets[line % 16];
            const auto found = std::find(set.begin(), set.end(), line);
            if (found == set.end()) {
                expected[pixels[q]] += 64;
                if (set.size() == 4) set.pop_back();
            } else {
                set.erase(found);
            }
            set.push_front(line);
        }
    EXPECT_EQ(traffic(searched, order, pixels, 13), expected);
    EXPECT_EQ(expected[12], 0u);
}

TEST(PixelTraffic, OfAllPixelsTogetherIsTheReplays) {
    const Searched searched(5000, 500, 20);
    std::vector<std::uint32_t> order(500), pixels(500);
    std::iota(order.begin(), order.end(), 0u);
    for (std::uint32_t q = 0; q < 500; ++q) pixels[q] = (q * 7) % 50;
    const std::vector<std::uint64_t> bytes = traffic(searched, order, pixels, 50);
    const ReplayConfig config{{cache}};
    const Replayed replayed = replay(searched.walks(), searched.layout(), order, config,
                                     count_revisits(searched.walks(), searched.layout(), config));
    EXPECT_EQ(std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0}),
              replayed.caches[0].traffic_bytes);
}

TEST(PixelTraffic, OfAPixelOutsideTheImageIsRefused) {
    const Searched searched(100, 3, 5);
    EXPECT_THROW(traffic(searched, {0, 1, 2}, {0, 4, 1}, 4), trace::DataError);
}

}  // namespace
}  // namespace regather::replay
