// Who missed, why, and what was used: a cache drawn after every access, and caches by definition.
#include "cachesim/attributed_cache.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <list>
#include <set>

#include "tests/cachesim/brute_force.h"
#include "trace/error.h"

namespace regather::cachesim {
static void PrintTo(const ClassStats& s, std::ostream* out) {
    *out << s.accesses << " accesses, " << s.misses << " misses (" << s.compulsory << '/' << s.capacity << '/'
         << s.conflict << "), " << s.writebacks << " writebacks, " << s.used_bytes << " used bytes";
}

namespace {

constexpr auto read = Access::read, write = Access::write;
constexpr std::uint32_t a = 0, b = 1;

TEST(AttributedCache, CountsAreThoseDrawnAfterEveryAccess) {
    // Four lines of 16 bytes: even lines in set 0, odd ones in set 1, two ways each.
    AttributedCache cache({.size_bytes = 64, .line_bytes = 16, .ways = 2}, 2);
    struct Step {
        ByteAccess access;
        std::uint32_t by;
        ClassStats total;  // accesses, misses, compulsory, capacity, conflict, writebacks, used
    };
    const Step steps[] = {
        // bytes       by    total                     set 0     set 1   fully associative   bytes used of the
        // lines
        {{0, 4, read}, a, {{1, 0, 0}, 1, 1, 0, 0}},  // 0               0                   0: 0-3
        {{4, 4, read}, a, {{1, 0, 0}, 2, 1, 0, 0}},  // 0               0                   0: 0-7
        {{14, 4, read},
         b,
         {{2, 0, 0}, 4, 2, 0, 0}},  // 0         1     1 0                 0: 0-7 14-15, 1: 0-1
        {{32, 4, write}, b, {{3, 0, 0}, 5, 3, 0, 0}},  // 2* 0      1     2 1 0               2: 0-3
        {{64, 1, read}, a, {{4, 0, 0}, 6, 4, 0, 10}},  // 4 2*      1     4 2 1 0             4: 0; 0 had 10
        {{0, 16, read}, a, {{4, 0, 1}, 7, 5, 1, 14}},  // 0 4       1     0 4 2 1             0: 0-15; 2 had 4
        {{48, 1, read}, a, {{5, 0, 1}, 8, 6, 1, 14}},  // 0 4       3 1   3 0 4 2             3: 0
        {{80, 1, read}, a, {{6, 0, 1}, 9, 7, 1, 16}},  // 0 4       5 3   5 3 0 4             5: 0; 1 had 2
        {{32, 1, read}, b, {{6, 1, 1}, 10, 8, 1, 17}},   // 2 0       5 3   2 5 3 0             2: 0; 4 had 1
        {{40, 4, write}, a, {{6, 1, 1}, 11, 8, 1, 17}},  // 2* 0      5 3   2 5 3 0             2: 0 8-11
    };
    for (const Step& step : steps) {
        cache.access(step.access, step.by);
        EXPECT_EQ(cache.total(), step.total) << "after access of " << step.access.address;
    }
    cache.flush();  // 0 had 16, 2 had 5, 3 and 5 had 1; 2 was written last by a
    EXPECT_EQ(cache.stats()[a], (ClassStats{{4, 0, 1}, 7, 5, 1, 10 + 1 + 16 + 1 + 1}));
    EXPECT_EQ(cache.stats()[b], (ClassStats{{2, 1, 0}, 4, 3, 1, 4 + 2 + 5}));
    EXPECT_EQ(cache.traffic_bytes(cache.total()), (8 + 2) * 16u);
}

TEST(AttributedCache, NoBytesTouchNoLineAndTheLastByteOfAllHasOne) {
    AttributedCache cache({.size_bytes = 64, .line_bytes = 16, .ways = 2}, 1);
    cache.access({5, 0, read}, a);
    EXPECT_EQ(cache.total(), ClassStats{});
    cache.access({~std::uint64_t{0}, 1, read}, a);
    cache.flush();
    EXPECT_EQ(cache.total(), (ClassStats{{1, 0, 0}, 1, 1, 0, 1}));
}

TEST(AttributedCache, AnImpossibleGeometryIsRefused) {
    EXPECT_THROW(AttributedCache({.size_bytes = 64, .line_bytes = 12, .ways = 2}, 1), trace::UsageError);
}

/// By definition: bytes as numbers in a set, the fully associative cache as a list of lines.
class BruteForce {
public:
    BruteForce(const CacheConfig& config, std::size_t classes)
        : stats(classes),
          config_(config),
          lines_(config.size_bytes / config.line_bytes),
          sets_(config.sets()) {}

    void access(const ByteAccess& bytes, std::uint32_t by) {
        std::set<std::uint64_t> lines;
        for (std::uint64_t i = 0; i < bytes.bytes; ++i)
            lines.insert((bytes.address + i) / config_.line_bytes);
        for (const std::uint64_t line : lines) {
            ++stats[by].accesses;
            const bool full_holds = std::find(full_.begin(), full_.end(), line) != full_.end();
            full_.remove(line);
            full_.push_front(line);
            if (full_.size() > lines_) full_.pop_back();
            std::list<Held>& set = sets_[line % sets_.size()];
            auto held = std::find_if(set.begin(), set.end(), [&](const Held& h) { return h.line == line; });
            if (held == set.end()) {
                ++stats[by].misses;
                ++(touched_.insert(line).second ? stats[by].compulsory
                   : full_holds                 ? stats[by].conflict
                                                : stats[by].capacity);
                if (set.size() == (config_.ways == 0 ? lines_ : config_.ways)) evict(set);
                set.push_front({line, by, {}, {}});
            } else {
                set.splice(set.begin(), set, held);
            }
            for (std::uint64_t i = 0; i < bytes.bytes; ++i)
                if ((bytes.address + i) / config_.line_bytes == line)
                    set.front().used.insert(bytes.address + i);
            if (bytes.kind == write) set.front().writer = by;
        }
    }
    void flush() {
        for (auto& set : sets_)
            while (!set.empty()) evict(set);
    }
    std::vector<ClassStats> stats;

private:
    struct Held {
        std::uint64_t line;
        std::uint32_t fetched_by;
        std::set<std::uint64_t> used;
        std::optional<std::uint32_t> writer;
    };
    void evict(std::list<Held>& set) {
        stats[set.back().fetched_by].used_bytes += set.back().used.size();
        if (set.back().writer) ++stats[*set.back().writer].writebacks;
        set.pop_back();
    }
    CacheConfig config_;
    std::uint64_t lines_;
    std::list<std::uint64_t> full_;
    std::set<std::uint64_t> touched_;
    std::vector<std::list<Held>> sets_;
};

CacheConfig any_cache() {
    CacheConfig config;
    config.line_bytes = *rc::gen::element(1u, 4u, 16u, 64u, 128u, 256u);
    const auto sets = *rc::gen::element(1u, 2u, 8u);
    config.ways = *rc::gen::inRange(0u, 5u);
    config.size_bytes = std::uint64_t{config.line_bytes} * sets * std::max(config.ways, 1u);
    return config;
}

TEST(AttributedCache, ClassesOfMissesAndUsedBytesAreThoseOfTheDefinition) {
    ASSERT_TRUE(rc::check([] {
        const CacheConfig config = any_cache();
        const std::uint64_t memory = config.size_bytes * *rc::gen::element(1u, 2u, 4u);
        AttributedCache cache(config, 3);
        BruteForce expected(config, 3);
        LruCache plain(config);
        const auto accesses = *rc::gen::inRange(0, 300);
        for (int i = 0; i < accesses; ++i) {
            const ByteAccess access{*rc::gen::inRange<std::uint64_t>(0, memory),
                                    *rc::gen::inRange<std::uint64_t>(1, 2 * config.line_bytes + 2),
                                    *rc::gen::element(read, write)};
            const auto by = *rc::gen::inRange(0u, 3u);
            cache.access(access, by);
            expected.access(access, by);
            std::vector<Line> lines;
            append_lines(lines, access.address, access.bytes, config.line_bytes);
            plain.access(lines, trace::Region::other, access.kind);
        }
        cache.flush();
        expected.flush();
        plain.flush();
        RC_ASSERT(std::vector(cache.stats().begin(), cache.stats().end()) == expected.stats);
        const ClassStats total = cache.total();
        RC_ASSERT(total.accesses == plain.total().accesses);
        RC_ASSERT(total.misses == plain.total().misses);
        RC_ASSERT(total.writebacks == plain.total().writebacks);
        RC_ASSERT(total.compulsory + total.capacity + total.conflict == total.misses);
        RC_ASSERT(total.used_bytes <= total.misses * config.line_bytes);
        if (config.sets() == 1) RC_ASSERT(total.conflict == 0u);
    }));
}

}  // namespace
}  // namespace regather::cachesim
