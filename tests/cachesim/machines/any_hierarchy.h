// tests/cachesim/machines/any_hierarchy.h -- small machines and short streams of accesses, drawn at random.
#pragma once
#include <rapidcheck.h>

#include <string>
#include <vector>

#include "cachesim/machines/hierarchy.h"
#include "tests/cachesim/brute_force.h"

namespace regather::cachesim {

/// One from the list.
template <class T>
T one_of(std::initializer_list<T> list) {
    return *rc::gen::elementOf(std::vector<T>(list));
}

/// `plain`: without what plain_hierarchy.h does not know.
inline PolicyConfig any_cache(std::uint32_t line_bytes, bool plain) {
    PolicyConfig cache;
    const std::uint32_t ways = one_of({1u, 2u, 3u, 4u, 8u}), sets = one_of({1u, 2u, 3u, 4u});
    cache.geometry = {std::uint64_t{ways} * sets * line_bytes, line_bytes, ways};
    cache.policy = plain ? one_of({Policy::lru, Policy::fifo})
                         : one_of({Policy::lru, Policy::fifo, Policy::srrip, Policy::random});
    if (plain) return cache;
    if (ways == 1 || ways == 2 || ways == 4 || ways == 8) cache.policy = one_of({cache.policy, Policy::plru});
    if (sets != 3) cache.index = one_of({SetIndex::modulo, SetIndex::hashed});
    return cache;
}

inline std::vector<LevelConfig> any_levels(std::size_t count, bool plain = false) {
    const std::uint32_t line = 64, sector = one_of({16u, 32u, 64u});
    std::vector<LevelConfig> levels(count);
    for (std::size_t i = 0; i < count; ++i) {
        LevelConfig& level = levels[i];
        level.name = std::to_string(i);
        level.cache = any_cache(line, plain);
        level.sector_bytes = sector;
        level.victim_lines = one_of({0u, 0u, 1u, 3u});
        if (i > 0) level.inclusion = one_of({Inclusion::neither, Inclusion::inclusive, Inclusion::exclusive});
        level.cache.write_miss = one_of({WriteMiss::allocate, WriteMiss::allocate, WriteMiss::no_allocate});
        level.prefetch = one_of({Prefetch::none, Prefetch::on_miss, Prefetch::tagged, Prefetch::always});
        if (plain || level.inclusion == Inclusion::exclusive) level.prefetch = Prefetch::none;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const bool exclusive = levels[i].inclusion == Inclusion::exclusive ||
                               (i + 1 < count && levels[i + 1].inclusion == Inclusion::exclusive);
        if (!exclusive)
            levels[i].cache.write = one_of({WritePolicy::back, WritePolicy::back, WritePolicy::through});
    }
    return levels;
}

struct Step {
    ByteAccess access;
    trace::Region region;
};

inline constexpr std::uint64_t lines_asked = 40;

inline std::vector<Step> any_steps(std::size_t count) {
    Scatter scatter(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<Step> steps;
    while (steps.size() < count) {
        const std::uint64_t line = scatter.below(3) == 0 ? scatter.below(lines_asked) : scatter.below(8);
        const std::uint64_t first = scatter.below(60), bytes = 1 + scatter.below(80);
        steps.push_back({{line * 64 + first, bytes, scatter.below(3) == 0 ? Access::write : Access::read},
                         static_cast<trace::Region>(scatter.below(trace::region_count))});
    }
    return steps;
}

inline void run(Hierarchy& hierarchy, const Step& step) {
    hierarchy.access({&step.access, 1}, step.region);
}

inline constexpr DramConfig small_dram{.banks = 4, .row_bytes = 128, .burst_bytes = 16, .channel_bytes = 16};

}  // namespace regather::cachesim
