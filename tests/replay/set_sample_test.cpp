// Set sampling against caches simulated set by set: what is sampled is exact, the estimate is Cochran's, and
// the interval holds the truth as often as it says.
#include "replay/set_sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_group.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "replay/student.h"
#include "tests/replay/traced.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using cachesim::CacheConfig;
using testing::HasSubstr;

Replayed sampled(const Searched& searched, std::span<const std::uint32_t> order,
                 const std::vector<CacheConfig>& caches, const Sampling& sampling,
                 const Placed& layout = {}) {
    const WalkStore walks = searched.walks();
    const Layout places = searched.layout(layout);
    return SetSample(walks, places, caches, sampling, count_line_use(walks, places, caches)).replay(order);
}

/// Misses of one cache by the class of the line, from lists.
std::vector<double> misses_by_class(const Searched& searched, std::span<const std::uint32_t> order,
                                    const CacheConfig& cache, std::uint64_t classes,
                                    const Placed& layout = {}) {
    std::vector<double> misses(classes);
    ListedLru list(cache.sets(), cache.ways);
    for (const std::uint64_t line : searched.lines_of(order, cache.line_bytes, layout))
        misses[line % classes] += list.misses(line) ? 1 : 0;
    return misses;
}

/// Walks times lines that they touch, by class, of the lines that at most a tenth of the walks touches.
std::vector<double> touches_by_class(const Searched& searched, std::uint64_t line_bytes,
                                     std::uint64_t classes, const Placed& layout = {}) {
    std::map<std::uint64_t, double> walks;
    for (std::uint32_t q = 0; q < searched.points.size(); ++q) {
        const std::vector<std::uint64_t> lines = searched.lines_of(q, line_bytes, layout);
        for (const std::uint64_t line : std::set<std::uint64_t>(lines.begin(), lines.end())) ++walks[line];
    }
    std::vector<double> touches(classes);
    for (const auto& [line, count] : walks)
        if (10 * count <= static_cast<double>(searched.points.size())) touches[line % classes] += count;
    return touches;
}

struct Estimate {
    double misses, standard_error;
};

/// Two classes of `misses.size()`, by Cochran's formulas 6.1 and 6.13 with his finite population correction.
Estimate estimate_of_two(const std::vector<double>& misses, const std::vector<double>& touches, std::size_t a,
                         std::size_t b) {
    const auto all = static_cast<double>(misses.size());
    double sum = 0;
    for (const double walks : touches) sum += walks;
    const double ratio = (misses[a] + misses[b]) / (touches[a] + touches[b]);
    const double residual_a = misses[a] - ratio * touches[a], residual_b = misses[b] - ratio * touches[b];
    const double variance = residual_a * residual_a + residual_b * residual_b;  // over n - 1 = 1
    return {ratio * sum, all * std::sqrt((1 - 2 / all) / 2 * variance)};
}

TEST(SetSample, AnEstimateIsTheRatioOfTwoOfTheClassesAndEveryClassComesToItsTurn) {
    const Searched searched(4000, 150, 15);
    const auto order = shuffled_queries(150, 2);
    const std::vector<CacheConfig> caches{{16 * 4 * 64, 64, 4}, {64 * 64, 64, 1}, {16 * 32 * 64, 64, 32}};
    constexpr std::uint64_t classes = 16;  // as many as the fewest sets
    const std::vector<double> touches = touches_by_class(searched, 64, classes);
    std::vector<std::vector<double>> misses;
    for (const CacheConfig& cache : caches)
        misses.push_back(misses_by_class(searched, order, cache, classes));

    const std::uint64_t accesses = searched.lines_of(order, 64).size();
    std::set<std::size_t> seen;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const Replayed replayed = sampled(searched, order, caches, {8, seed});
        // The pair that gives the first cache's estimate gives those of all.
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        for (std::size_t a = 0; a < classes; ++a)
            for (std::size_t b = a + 1; b < classes; ++b) {
                bool all_equal = true;
                for (std::size_t c = 0; c < caches.size(); ++c) {
                    const Estimate expected = estimate_of_two(misses[c], touches, a, b);
                    const CacheTraffic& found = replayed.caches[c];
                    all_equal = all_equal &&
                                std::abs(static_cast<double>(found.misses) - expected.misses) < 0.501 &&
                                std::abs(found.error->standard_error - expected.standard_error) <
                                    1e-9 * (1 + expected.standard_error);
                }
                if (all_equal) pairs.emplace_back(a, b);
            }
        ASSERT_EQ(pairs.size(), 1u) << "seed " << seed;
        seen.insert({pairs[0].first, pairs[0].second});
        for (std::size_t c = 0; c < caches.size(); ++c) {
            const CacheTraffic& found = replayed.caches[c];
            EXPECT_EQ(found.error->sampled_sets, caches[c].sets() / 8);
            EXPECT_EQ(found.traffic_bytes, found.misses * 64);
            EXPECT_EQ(found.accesses, accesses);
            EXPECT_FALSE(found.classes);
            // 12.706205 standard errors, as n - 1 = 1; what was seen to miss is a floor.
            const double seen_misses = misses[c][pairs[0].first] + misses[c][pairs[0].second];
            const Estimate e = estimate_of_two(misses[c], touches, pairs[0].first, pairs[0].second);
            EXPECT_NEAR(static_cast<double>(found.error->high), e.misses + 12.706205 * e.standard_error,
                        0.501);
            EXPECT_NEAR(static_cast<double>(found.error->low),
                        std::max(seen_misses, e.misses - 12.706205 * e.standard_error), 0.501);
        }
        EXPECT_EQ(replayed.visited_nodes, searched.recording.visited_nodes);
        EXPECT_EQ(replayed.raw_bytes, 20 * searched.recording.visited_nodes);
    }
    EXPECT_EQ(seen.size(), classes);
}

/// Gaps between nodes, nodes of several lines, and a first node in the middle of a line.
TEST(SetSample, AnyLayoutsEstimateIsTheRatioOfTwoOfItsClasses) {
    const Searched searched(2000, 120, 12);
    const auto order = shuffled_queries(120, 2);
    const std::vector<CacheConfig> caches{{16 * 4 * 32, 32, 4}, {32 * 32, 32, 1}};
    for (const Placed& layout :
         {Placed{"gaps", 0, 24, 20}, Placed{"hot", 8, 32, 12}, Placed{"wide", 4100, 80, 75},
          Placed{"shared", 72, 20, 33}, Placed{"scattered", 4099, 0, 0, true}}) {
        const std::vector<double> touches = touches_by_class(searched, 32, 16, layout);
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            const Replayed replayed = sampled(searched, order, caches, {8, seed}, layout);
            for (std::size_t c = 0; c < caches.size(); ++c) {
                const CacheTraffic& found = replayed.caches[c];
                const std::vector<double> misses = misses_by_class(searched, order, caches[c], 16, layout);
                int fitting = 0;
                for (std::size_t a = 0; a < 16; ++a)
                    for (std::size_t b = a + 1; b < 16; ++b) {
                        const Estimate expected = estimate_of_two(misses, touches, a, b);
                        fitting += std::abs(static_cast<double>(found.misses) - expected.misses) < 0.501 &&
                                   std::abs(found.error->standard_error - expected.standard_error) <
                                       1e-9 * (1 + expected.standard_error);
                    }
                EXPECT_EQ(fitting, 1) << layout.name << seed;
                EXPECT_EQ(found.accesses, searched.lines_of(order, 32, layout).size()) << layout.name;
            }
        }
    }
}

TEST(SetSample, WhenManyWalksTouchEveryLineTheMeanOfTheClassesIsTheEstimate) {
    // 200 photons on lines of 16 bytes, of which each search touches more than a tenth: no line is left for a
    // ratio.
    const Searched searched(200, 60, 60);
    const auto order = shuffled_queries(60, 3);
    const std::vector<CacheConfig> caches{{16 * 2 * 16, 16, 2}};
    const std::vector<double> misses = misses_by_class(searched, order, caches[0], 16);
    for (const double walks : touches_by_class(searched, 16, 16)) ASSERT_EQ(walks, 0);
    std::set<std::size_t> seen;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const CacheTraffic found = sampled(searched, order, caches, {8, seed}).caches[0];
        std::size_t fitting = 0;
        for (std::size_t a = 0; a < 16; ++a)
            for (std::size_t b = a + 1; b < 16; ++b) {
                // The standard error of a mean of two of 16, times 16.
                const double spread = std::abs(misses[a] - misses[b]);
                const double error = 16 * std::sqrt((1 - 2. / 16) / 2 * spread * spread / 2);
                if (static_cast<double>(found.misses) != 8 * (misses[a] + misses[b]) ||
                    std::abs(found.error->standard_error - error) > 1e-6)
                    continue;
                ++fitting;
                seen.insert({a, b});
            }
        EXPECT_GE(fitting, 1u) << "seed " << seed;
    }
    EXPECT_EQ(seen.size(), 16u);
}

TEST(SetSample, IntervalsHoldTheTruthAndEstimatesMeetAroundIt) {
    // Were each interval to hold the truth with a chance of 95 %, fewer than 48 of 60 would in 1 of 10^5
    // cases; the seeds are fixed, so that what holds once holds always.
    const Searched searched(20'000, 400, 20);
    const auto order = shuffled_queries(400, 2);
    const std::vector<CacheConfig> caches{{64 * 4 * 64, 64, 4}, {256 * 64, 64, 1}, {64 * 16 * 64, 64, 16}};
    const WalkStore walks = searched.walks();
    const Layout layout = searched.layout();
    const LineUse use = count_line_use(walks, layout, caches);
    const ReplayConfig config{caches, false};
    const Replayed exact = replay(walks, layout, order, config, count_revisits(walks, layout, config));
    std::vector<int> held(caches.size());
    std::vector<double> sum(caches.size());
    constexpr int seeds = 60;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const Replayed found = SetSample(walks, layout, caches, {8, seed}, use).replay(order);
        for (std::size_t c = 0; c < caches.size(); ++c) {
            const SampleError& error = *found.caches[c].error;
            EXPECT_LE(error.low, found.caches[c].misses);
            EXPECT_GE(error.high, found.caches[c].misses);
            EXPECT_EQ(found.caches[c].accesses, exact.caches[c].accesses);
            held[c] += error.low <= exact.caches[c].misses && exact.caches[c].misses <= error.high ? 1 : 0;
            sum[c] += static_cast<double>(found.caches[c].misses);
        }
    }
    for (std::size_t c = 0; c < caches.size(); ++c) {
        EXPECT_GE(held[c], 48) << c;
        const auto truth = static_cast<double>(exact.caches[c].misses);
        EXPECT_NEAR(sum[c] / seeds, truth, 0.02 * truth) << c;
    }
}

TEST(SetSample, ASeedIsASample) {
    const Searched searched(4000, 150, 15);
    const auto order = shuffled_queries(150, 2);
    const std::vector<CacheConfig> caches{{64 * 4 * 64, 64, 4}, {128 * 128, 128, 1}};
    const WalkStore walks = searched.walks();
    const Layout layout = searched.layout();
    const LineUse use = count_line_use(walks, layout, caches);
    const auto numbers = [&](const Replayed& replayed) {
        std::vector<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, double>> all;
        for (const CacheTraffic& t : replayed.caches)
            all.emplace_back(t.misses, t.error->low, t.error->high, t.error->standard_error);
        return all;
    };
    std::set<decltype(numbers(Replayed{}))> different;
    for (const std::uint64_t seed : {0ull, 1ull, 2ull, ~0ull}) {
        const SetSample sample(walks, layout, caches, {8, seed}, use);
        const auto once = numbers(sample.replay(order));
        EXPECT_EQ(numbers(SetSample(walks, layout, caches, {8, seed}, use).replay(order)), once);
        std::vector<Replayed> at_once(2);
        tbb::task_group replays;
        for (Replayed& replayed : at_once) replays.run([&] { replayed = sample.replay(order); });
        replays.wait();
        for (const Replayed& replayed : at_once) EXPECT_EQ(numbers(replayed), once);
        different.insert(once);
    }
    EXPECT_EQ(different.size(), 4u);
}

TEST(SetSample, CachesOfOneSampleDoNotKnowOfTheirOrder) {
    const Searched searched(4000, 150, 15);
    const auto order = shuffled_queries(150, 2);
    std::vector<CacheConfig> caches{
        {64 * 4 * 64, 64, 4}, {128 * 128, 128, 1}, {256 * 64, 64, 1}, {64 * 7 * 64, 64, 7}};
    const Replayed forwards = sampled(searched, order, caches, {4, 3});
    std::reverse(caches.begin(), caches.end());
    const Replayed backwards = sampled(searched, order, caches, {4, 3});
    ASSERT_EQ(forwards.caches.size(), caches.size());
    for (std::size_t c = 0; c < caches.size(); ++c) {
        const CacheTraffic &a = forwards.caches[c], &b = backwards.caches[caches.size() - 1 - c];
        EXPECT_EQ(a.config.size_bytes, b.config.size_bytes);
        EXPECT_EQ(a.config.ways, b.config.ways);
        EXPECT_EQ(a.misses, b.misses);
        EXPECT_EQ(a.accesses, b.accesses);
        EXPECT_EQ(a.error->standard_error, b.error->standard_error);
    }
}

TEST(LineUse, CountsTheWalksThatTouchEachLine) {
    const Searched searched(300, 10'000, 5);
    const std::vector<CacheConfig> caches{{4096, 64, 1}, {4096, 16, 1}, {8192, 64, 2}};
    const auto counted_by = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return count_line_use(searched.walks(), searched.layout(), caches);
    };
    const LineUse use = counted_by(2);
    EXPECT_EQ(counted_by(1), use);
    ASSERT_EQ(use.size(), 2u);
    for (const auto& [line_bytes, walks] : use) {
        std::vector<std::uint64_t> expected((300 * 20 - 1) / line_bytes + 1);
        for (std::uint32_t q = 0; q < 10'000; ++q) {
            const auto lines = searched.lines_of(q, line_bytes);
            for (const std::uint64_t line : std::set<std::uint64_t>(lines.begin(), lines.end()))
                ++expected[line];
        }
        EXPECT_EQ(walks, expected);
    }
}

TEST(SetSample, ALayoutsBaseMovesTheClassesWithTheLines) {
    // 2^20 bytes are whole turns of 16 sets of 64 bytes: the same sets, the same sample.
    const Searched searched(4000, 150, 15);
    const auto order = shuffled_queries(150, 2);
    const std::vector<CacheConfig> caches{{16 * 4 * 64, 64, 4}};
    const WalkStore walks = searched.walks();
    std::vector<CacheTraffic> found;
    for (const std::uint64_t base : {std::uint64_t{0}, std::uint64_t{1} << 20, std::uint64_t{1} << 40}) {
        const Layout layout = searched.layout({"moved", base, 20, 20});
        found.push_back(SetSample(walks, layout, caches, {8, 5}, count_line_use(walks, layout, caches))
                            .replay(order)
                            .caches[0]);
        EXPECT_EQ(found.back().misses, found.front().misses);
        EXPECT_EQ(found.back().error->standard_error, found.front().error->standard_error);
    }
}

TEST(SetSample, RefusesWhatCannotBeSampled) {
    const auto refused = [](const CacheConfig& cache, std::uint32_t one_of, const std::string& part) {
        try {
            SetSample::check(std::span(&cache, 1), {one_of, 1});
            ADD_FAILURE() << "accepted: 1/" << one_of << " of " << cache.sets();
        } catch (const trace::UsageError& error) {
            EXPECT_THAT(error.what(), HasSubstr(part));
        }
    };
    const CacheConfig cache{1 << 20, 64, 4};  // 4096 sets
    for (const std::uint32_t one_of : {0u, 1u, 3u, 6u, 1023u, 2048u, 0x80000000u})
        refused(cache, one_of, "1/" + std::to_string(one_of));
    refused({1 << 20, 64, cachesim::fully_associative}, 2, "all");
    refused({64 * 64, 64, 64}, 2, "64 ways");
    refused({1024 * 33 * 64, 64, 33}, 2, "33 ways");
    refused({16 * 4 * 64, 64, 4}, 16, "at least 32 sets");
    refused({2 * 64, 64, 1}, 2, "at least 4 sets");
    refused({100, 64, 1}, 2, "100");
    SetSample::check(std::vector<CacheConfig>{{32 * 4 * 64, 64, 4}}, {16, 1});
    SetSample::check(std::vector<CacheConfig>{{1024 * 32 * 64, 64, 32}}, {2, 1});
    SetSample::check(std::vector<CacheConfig>{{2048 * 64, 64, 1}}, {1024, 1});
    const Searched searched(50, 3, 2);
    EXPECT_THROW(sampled(searched, shuffled_queries(3, 1), {{16 * 4 * 64, 64, 4}}, {16, 1}),
                 trace::UsageError);
}

TEST(SetSample, ASampleThatNoLineIsInIsRefused) {
    // Photons 512 bytes apart, on every eighth line: all in classes 0 and 8 of 16.
    const Searched searched(2000, 120, 12);
    const auto order = shuffled_queries(120, 2);
    const std::vector<CacheConfig> caches{{16 * 4 * 64, 64, 4}};
    const Placed apart{"apart", 0, 512, 20};
    int refused = 0, taken = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        try {
            const Replayed replayed = sampled(searched, order, caches, {8, seed}, apart);
            EXPECT_GT(replayed.caches[0].misses, 0u) << seed;
            ++taken;
        } catch (const trace::DataError& error) {
            EXPECT_THAT(error.what(),
                        testing::AllOf(HasSubstr("no touched line of 64 bytes in 1/8 of the sets by seed " +
                                                 std::to_string(seed)),
                                       testing::Not(HasSubstr("\n"))));
            ++refused;
        }
    }
    // Two of the 16 classes are sampled: 14 x 13 of 16 x 15 samples have neither.
    EXPECT_GT(refused, 20);
    EXPECT_GT(taken, 2);
}

TEST(SetSample, ADamagedWalkIsRefused) {
    Searched searched(1000, 50, 10);
    const std::vector<CacheConfig> caches{{64 * 64, 64, 1}};
    const LineUse use = count_line_use(searched.walks(), searched.layout(), caches);
    std::fill_n(searched.recording.walks.begin(), searched.recording.walk_bytes[0], std::uint8_t{0});
    const WalkStore walks = searched.walks();
    const Layout layout = searched.layout();
    EXPECT_THROW(count_line_use(walks, layout, caches), trace::DataError);
    EXPECT_THROW(SetSample(walks, layout, caches, {4, 1}, use).replay(shuffled_queries(50, 1)),
                 trace::DataError);
}

TEST(SetSample, NoQueriesNoMisses) {
    const Searched searched(10, 0, 3);
    const CacheTraffic found = sampled(searched, {}, {{64 * 64, 64, 1}}, {4, 1}).caches[0];
    EXPECT_EQ(found.misses, 0u);
    EXPECT_EQ(found.error->low, 0u);
    EXPECT_EQ(found.error->high, 0u);
    EXPECT_EQ(found.error->standard_error, 0);
}

TEST(StudentQuantile, IsThatOfTheTables) {
    for (const auto& [degrees, quantile] : std::vector<std::pair<std::uint64_t, double>>{{1, 12.706},
                                                                                         {2, 4.303},
                                                                                         {7, 2.365},
                                                                                         {15, 2.131},
                                                                                         {30, 2.042},
                                                                                         {31, 2.040},
                                                                                         {40, 2.021},
                                                                                         {60, 2.000},
                                                                                         {63, 1.998},
                                                                                         {120, 1.980}})
        EXPECT_NEAR(student_quantile_95(degrees), quantile, 0.0006) << degrees;
    EXPECT_NEAR(student_quantile_95(1'000'000), 1.960, 0.0001);
    for (std::uint64_t degrees = 2; degrees < 200; ++degrees)
        EXPECT_LT(student_quantile_95(degrees), student_quantile_95(degrees - 1));
}

}  // namespace
}  // namespace regather::replay
