// cachesim/cache.h -- an exact set-associative LRU cache: line numbers go in, misses are counted by region.
// Write-back, write-allocate. Knows nothing of what the lines hold. Counts events only.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "trace/region.h"

namespace regather::cachesim {

enum class Line : std::uint64_t {};  ///< Of 64-bit addresses: address / line_bytes; arithmetic needs a cast.
enum class Access : std::uint8_t { read, write };

inline constexpr std::uint32_t fully_associative = 0;

struct CacheConfig {
    std::uint64_t size_bytes = 128 * 1024;
    std::uint32_t line_bytes = 128;  ///< Power of two.
    std::uint32_t ways = 8;          ///< 1: direct mapped; fully_associative: one set of size / line ways.

    std::uint64_t sets() const { return ways == fully_associative ? 1 : size_bytes / line_bytes / ways; }
};

inline constexpr std::uint64_t max_lines = std::uint64_t{1}
                                           << 28;  ///< In one cache: its tags fit into memory.

/// Throws trace::UsageError that names the field, what was found and what was expected: line_bytes and the
/// set count are powers of two, size_bytes = sets x ways x line_bytes, at most max_lines lines.
void check(const CacheConfig& config);

struct CacheStats {
    std::uint64_t accesses = 0;    ///< Line accesses.
    std::uint64_t misses = 0;      ///< Lines fetched.
    std::uint64_t writebacks = 0;  ///< Dirty lines evicted, charged to the region that wrote them last.
    friend bool operator==(const CacheStats&, const CacheStats&) = default;
};

class LruCache {
public:
    explicit LruCache(const CacheConfig& config);  ///< check()s it.
    ~LruCache();
    LruCache(LruCache&&) noexcept;
    LruCache& operator=(LruCache&&) noexcept;

    /// In this order, one after the other.
    void access(std::span<const Line> lines, trace::Region region, Access kind = Access::read);
    /// The same with a kind for each line; `kinds` is as long as `lines`.
    void access(std::span<const Line> lines, std::span<const Access> kinds, trace::Region region);
    /// Evicts everything, so that dirty lines are counted as written back.
    void flush();

    const CacheConfig& config() const { return config_; }
    const CacheStats& stats(trace::Region region) const { return stats_[static_cast<std::size_t>(region)]; }
    CacheStats total() const;
    /// (misses + writebacks) x line_bytes.
    std::uint64_t traffic_bytes() const;

    class Engine;  ///< How the sets are kept; chosen by geometry. cachesim/lru/engine.h
private:
    CacheConfig config_;
    std::array<CacheStats, trace::region_count> stats_{};
    std::unique_ptr<Engine> engine_;
};

}  // namespace regather::cachesim
