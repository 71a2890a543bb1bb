// tests/cachesim/brute_force.h -- caches by definition: LRU sets as lists, most recently used first; sets of
// every other policy as ways whose past is kept in full; optimal replacement by looking ahead. And a random
// stream.
#pragma once
#include <algorithm>
#include <array>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/policies/policy.h"

namespace regather::cachesim {

class BruteForceLru {
public:
    explicit BruteForceLru(const CacheConfig& config)
        : ways_(config.ways == fully_associative ? config.size_bytes / config.line_bytes : config.ways),
          sets_(config.sets()) {}

    void access(Line line, trace::Region region, Access kind) {
        std::list<Held>& set = sets_[static_cast<std::uint64_t>(line) % sets_.size()];
        CacheStats& mine = stats[static_cast<std::size_t>(region)];
        ++mine.accesses;
        const auto held = std::find_if(set.begin(), set.end(), [&](const Held& h) { return h.line == line; });
        if (held != set.end()) {
            set.splice(set.begin(), set, held);
        } else {
            ++mine.misses;
            if (set.size() == ways_) evict(set);
            set.push_front({line, false, region});
        }
        if (kind == Access::write) set.front() = {line, true, region};
    }

    void flush() {
        for (auto& set : sets_)
            while (!set.empty()) evict(set);
    }

    std::array<CacheStats, trace::region_count> stats{};

private:
    struct Held {
        Line line;
        bool dirty;
        trace::Region writer;
    };
    void evict(std::list<Held>& set) {
        if (set.back().dirty) ++stats[static_cast<std::size_t>(set.back().writer)].writebacks;
        set.pop_back();
    }

    std::uint64_t ways_;
    std::vector<std::list<Held>> sets_;
};

inline std::array<CacheStats, trace::region_count> stats_of(const LruCache& cache) {
    std::array<CacheStats, trace::region_count> stats;
    for (std::size_t r = 0; r < stats.size(); ++r) stats[r] = cache.stats(static_cast<trace::Region>(r));
    return stats;
}

inline void PrintTo(const CacheStats& s, std::ostream* out) {
    *out << s.accesses << " accesses, " << s.misses << " misses, " << s.writebacks << " writebacks";
}

inline void PrintTo(const PolicyStats& s, std::ostream* out) {
    *out << s.accesses << " accesses, " << s.misses << " misses, " << s.fetches << " fetches, "
         << s.writebacks << " writebacks, " << s.passed_writes << " writes of " << s.passed_bytes
         << " bytes passed on";
}

/// One line access.
struct Touch {
    std::uint64_t line = 0;
    bool write = false;
    std::uint32_t bytes = 4;
    trace::Region region = trace::Region::other;
};

/// Bit by bit: bit b of the set is the XOR of bits b, b + n, b + 2n, ... of the line.
inline std::uint64_t brute_force_set(const PolicyConfig& config, std::uint64_t line) {
    if (config.index == SetIndex::modulo) return line % config.sets();
    unsigned n = 0;
    while (std::uint64_t{1} << n < config.sets()) ++n;
    std::uint64_t set = 0;
    for (unsigned bit = 0; n != 0 && bit < 64; ++bit) set ^= (line >> bit & 1) << bit % n;
    return set;
}

/// Every policy but random. Of each way: when it was used and fetched, its prediction; of each set: the bits
/// of its tree, named by the ways [first, last) that a bit divides.
class BruteForcePolicy {
public:
    explicit BruteForcePolicy(const PolicyConfig& config) : config_(config), sets_(config.sets()) {
        for (Set& set : sets_) set.ways.resize(config.ways());
    }

    /// True for a hit. `future` has the accesses that follow.
    bool access(const Touch& touch, std::span<const Touch> future = {}) {
        ++now_;
        PolicyStats& mine = stats[static_cast<std::size_t>(touch.region)];
        ++mine.accesses;
        Set& set = sets_[brute_force_set(config_, touch.line)];
        const bool through = touch.write && config_.write == WritePolicy::through;
        std::size_t way = find(set, touch.line);
        const bool hit = way != set.ways.size();
        const bool around = !hit && touch.write && config_.write_miss == WriteMiss::no_allocate;
        if (through || around) {
            ++mine.passed_writes;
            mine.passed_bytes += touch.bytes;
        }
        mine.misses += !hit;
        if (around) return false;
        if (!hit) {
            ++mine.fetches;
            way = empty_way(set);
            if (way == set.ways.size()) {
                way = victim(set, future);
                write_back(*set.ways[way]);
            }
            set.ways[way] = Way{touch.line, now_, now_, 2, {}};
        }
        Way& used = *set.ways[way];
        used.used = now_;
        if (hit) used.prediction = 0;
        point_away(set, way, 0, set.ways.size());
        if (touch.write && !through) used.writer = touch.region;
        return hit;
    }

    void flush() {
        for (Set& set : sets_)
            for (auto& way : set.ways)
                if (way) write_back(*way);
    }
    PolicyStats total() const {
        PolicyStats sum;
        for (const PolicyStats& region : stats) sum += region;
        return sum;
    }

    std::array<PolicyStats, trace::region_count> stats{};

private:
    struct Way {
        std::uint64_t line, used, fetched;
        int prediction;
        std::optional<trace::Region> writer;
    };
    struct Set {
        std::vector<std::optional<Way>> ways;
        std::map<std::pair<std::size_t, std::size_t>, bool> right_half_goes;
    };

    static std::size_t find(const Set& set, std::uint64_t line) {
        std::size_t way = 0;
        while (way < set.ways.size() && !(set.ways[way] && set.ways[way]->line == line)) ++way;
        return way;
    }
    static std::size_t empty_way(const Set& set) {
        std::size_t way = 0;
        while (way < set.ways.size() && set.ways[way]) ++way;
        return way;
    }

    std::size_t victim(Set& set, std::span<const Touch> future) {
        const auto first_by = [&](auto before) {
            std::size_t best = 0;
            for (std::size_t way = 1; way < set.ways.size(); ++way)
                if (before(*set.ways[way], *set.ways[best])) best = way;
            return best;
        };
        const auto next_use = [&](const Way& way) {
            std::size_t i = 0;
            while (i < future.size() && future[i].line != way.line) ++i;
            return i;
        };
        switch (config_.policy) {
            case Policy::lru:
                return first_by([](const Way& a, const Way& b) { return a.used < b.used; });
            case Policy::fifo:
                return first_by([](const Way& a, const Way& b) { return a.fetched < b.fetched; });
            case Policy::opt:
                return first_by([&](const Way& a, const Way& b) {
                    return next_use(a) != next_use(b) ? next_use(a) > next_use(b) : a.line < b.line;
                });
            case Policy::plru: {
                std::size_t first = 0, last = set.ways.size();
                while (last - first > 1)
                    (set.right_half_goes[{first, last}] ? first : last) = (first + last) / 2;
                return first;
            }
            default:
                while (true) {
                    for (std::size_t way = 0; way < set.ways.size(); ++way)
                        if (set.ways[way]->prediction == 3) return way;
                    for (auto& way : set.ways) ++way->prediction;
                }
        }
    }

    static void point_away(Set& set, std::size_t way, std::size_t first, std::size_t last) {
        if (last - first < 2) return;
        const std::size_t middle = (first + last) / 2;
        set.right_half_goes[{first, last}] = way < middle;
        way < middle ? point_away(set, way, first, middle) : point_away(set, way, middle, last);
    }

    void write_back(const Way& way) {
        if (way.writer) ++stats[static_cast<std::size_t>(*way.writer)].writebacks;
    }

    PolicyConfig config_;
    std::vector<Set> sets_;
    std::uint64_t now_ = 0;
};

/// The fewest misses of one set of `ways`, over all choices of what to evict.
inline std::uint64_t fewest_misses(std::span<const Touch> touches, std::size_t ways,
                                   const std::set<std::uint64_t>& held = {}) {
    if (touches.empty()) return 0;
    const std::uint64_t line = touches.front().line;
    const auto rest = touches.subspan(1);
    if (held.contains(line)) return fewest_misses(rest, ways, held);
    std::uint64_t fewest = ~std::uint64_t{0};
    const auto fetch_into = [&](std::set<std::uint64_t> left) {
        left.insert(line);
        fewest = std::min(fewest, 1 + fewest_misses(rest, ways, left));
    };
    if (held.size() < ways) fetch_into(held);
    for (const std::uint64_t victim : held) {
        std::set<std::uint64_t> left = held;
        left.erase(victim);
        fetch_into(left);
    }
    return fewest;
}

/// Numbers in no order, the same on every machine.
class Scatter {
public:
    explicit Scatter(std::uint64_t seed) : state_(seed) {}
    std::uint64_t below(std::uint64_t limit) {
        state_ = state_ * 6364136223846793005 + 1442695040888963407;
        return (state_ >> 32) % limit;
    }

private:
    std::uint64_t state_;
};

}  // namespace regather::cachesim
