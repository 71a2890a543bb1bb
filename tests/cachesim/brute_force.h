// tests/cachesim/brute_force.h -- LRU by definition: each set is a list, most recently used first. And a
// random stream.
#pragma once
#include <algorithm>
#include <array>
#include <list>
#include <vector>

#include "cachesim/cache.h"

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
