// cachesim/lru/engine.h -- how the sets of an LruCache are kept. Two ways, with the same counts to the last
// miss: rows of tags in order of use for up to 32 ways (set_engine.cpp), hash table and lists for all else
// (list_engine.cpp).
#pragma once
#include <array>
#include <memory>
#include <span>

#include "cachesim/cache.h"

namespace regather::cachesim {

using RegionStats = std::array<CacheStats, trace::region_count>;

/// What a line's state says: 0 is clean, 1 + region is dirty, written last by that region.
inline constexpr unsigned clean = 0;
inline unsigned dirty_by(trace::Region region) {
    return 1 + static_cast<unsigned>(region);
}

/// The accesses of one region. Line i is accessed as kinds[i * kind_stride]; a stride of 0 is one kind for
/// all.
struct Run {
    std::span<const Line> lines;
    const Access* kinds;
    std::size_t kind_stride;
    trace::Region region;

    Access kind(std::size_t i) const { return kinds[i * kind_stride]; }
    bool reads_only() const { return kind_stride == 0 && *kinds == Access::read; }
};

class LruCache::Engine {
public:
    virtual ~Engine() = default;
    /// Adds misses and writebacks to `stats`; accesses are the caller's.
    virtual void access(const Run& run, RegionStats& stats) = 0;
    virtual void flush(RegionStats& stats) = 0;
};

/// Set counts from 16 and up to 32 ways.
bool set_engine_serves(const CacheConfig& config);
std::unique_ptr<LruCache::Engine> make_set_engine(const CacheConfig& config);
/// Any geometry; memory grows with the lines held, time does not grow with the ways.
std::unique_ptr<LruCache::Engine> make_list_engine(const CacheConfig& config);

}  // namespace regather::cachesim
