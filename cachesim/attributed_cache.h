// cachesim/attributed_cache.h -- an exact LRU cache that says who missed, why, and what the fetched bytes
// were good for. Accesses are byte ranges and belong to a class, a small number that means whatever the
// caller wants. Write-back, write-allocate, as LruCache and with the same counts, but slower: misses are
// classified one by one (miss_class.h), and every line held knows which of its bytes were accessed since it
// was fetched.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/line_ids.h"
#include "cachesim/lines.h"
#include "cachesim/miss_class.h"
#include "cachesim/recency_list.h"

namespace regather::cachesim {

struct ClassStats : MissClasses {
    std::uint64_t accesses = 0;    ///< Line accesses.
    std::uint64_t misses = 0;      ///< Lines fetched; the sum of the MissClasses.
    std::uint64_t writebacks = 0;  ///< Dirty lines evicted, charged to the class that wrote them last.
    /// Bytes of the lines that this class fetched which any class accessed before they were evicted; a line
    /// that is fetched again counts again.
    std::uint64_t used_bytes = 0;

    ClassStats& operator+=(const ClassStats& other);
    friend bool operator==(const ClassStats&, const ClassStats&) = default;
};

/// One thread. Memory grows with the different lines accessed.
class AttributedCache {
public:
    /// check()s the configuration. Classes are 0 .. classes-1.
    AttributedCache(const CacheConfig& config, std::uint32_t classes);

    /// One access of every line that the bytes lie on, ascending.
    void access(const ByteAccess& bytes, std::uint32_t by);
    /// Evicts everything, so that dirty lines are counted as written back and the bytes of those held as
    /// used. The last call.
    void flush();

    const CacheConfig& config() const { return config_; }
    std::span<const ClassStats> stats() const { return stats_; }  ///< By class.
    ClassStats total() const;
    /// (misses + writebacks) x line_bytes.
    std::uint64_t traffic_bytes(const ClassStats& stats) const {
        return (stats.misses + stats.writebacks) * config_.line_bytes;
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    /// A line that is held; in the list of its set.
    struct Slot : Links {
        std::uint32_t id = none;
        std::uint32_t fetched_by = none, dirty_by = none;  // a class; or none: clean
    };
    struct Set : RecencyList {
        std::uint32_t used = 0;
    };

    void access_line(std::uint64_t line, std::uint32_t first, std::uint32_t last, Access kind,
                     std::uint32_t by);
    std::uint32_t fetch(std::uint32_t id, Set& set, std::uint32_t by);
    void settle(std::uint32_t slot);
    void mark(std::uint32_t slot, std::uint32_t first, std::uint32_t last);

    CacheConfig config_;
    int shift_;
    std::uint64_t ways_;
    std::uint32_t words_;  // of 64 bits, a bit a byte of the line
    std::vector<ClassStats> stats_;
    LineIds ids_;
    FullLru full_;
    std::vector<std::uint32_t> slot_of_;  // by id
    std::vector<Set> sets_;
    std::vector<Slot> slots_;
    std::vector<std::uint64_t> used_;  // by slot: words_ each
    std::uint64_t last_line_ = 0;      // accessed last, in last_slot_ if there was one
    std::uint32_t last_slot_ = none;
};

}  // namespace regather::cachesim
