// cachesim/policies/opt_cache.h -- optimal replacement: the line whose next use is farthest ahead goes
// (Belady, "A study of replacement algorithms for a virtual-storage computer", 1966; Mattson et al. 1970 show
// that it misses least). Of lines never used again the smallest line number goes. Each line missed is brought
// in, as with every other policy: without that rule (bypass) fewer misses would be possible.
//
// Needs the future, so the stream is kept: 8 bytes a line access and 8 bytes a different line, once for all
// caches of one line size; each cache adds 1 byte a different line and 20 bytes a line that it can hold.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cachesim/policies/policy.h"

namespace regather::cachesim {

/// The line accesses of a trace. First append() all, then finish(), then any number of OptCache.
class OptStream {
public:
    static constexpr std::uint32_t never = ~std::uint32_t{0};
    static constexpr std::uint64_t most_accesses = never;  ///< Their numbers have 32 bits.
    /// Throws trace::UsageError when append() is asked for more than `limit` accesses, or most_accesses.
    explicit OptStream(std::uint64_t limit);

    /// `id`: of the line, as LineIds numbers it.
    void append(Line line, std::uint32_t id, Access kind, std::uint32_t bytes);
    /// Finds the next use of each access, from the last one back.
    void finish();

    std::uint64_t size() const { return size_; }
    std::span<const Line> lines() const { return lines_; }  ///< By id.
    std::uint64_t writes() const { return writes_; }
    std::uint64_t written_bytes() const { return written_bytes_; }

    std::uint32_t id(std::uint64_t access) const { return at(access).reference & ~write_bit; }
    bool is_write(std::uint64_t access) const { return (at(access).reference & write_bit) != 0; }
    /// The number of the next access to the same line, or never.
    std::uint32_t next_use(std::uint64_t access) const { return at(access).next_use; }

private:
    struct Entry {
        std::uint32_t reference, next_use;
    };
    static constexpr std::uint32_t write_bit = 1u << 31;
    static constexpr unsigned block_bits = 16;  // in blocks: a growing stream is never copied
    const Entry& at(std::uint64_t access) const {
        return blocks_[access >> block_bits][access & ((1u << block_bits) - 1)];
    }

    std::uint64_t limit_, size_ = 0, writes_ = 0, written_bytes_ = 0;
    std::vector<std::unique_ptr<Entry[]>> blocks_;
    std::vector<Line> lines_;
};

class OptCache {
public:
    /// check()s the config, whose policy is opt. `stream` is finished and outlives the cache.
    OptCache(const PolicyConfig& config, const OptStream& stream);

    /// The next accesses of the stream, one for each entry of `missed`, which becomes 1 for a miss and 0 for
    /// a hit.
    void access(std::span<std::uint8_t> missed);
    /// Evicts everything, so that dirty lines are counted as written back.
    void flush();

    const PolicyConfig& config() const { return config_; }
    /// Bytes written through are known at the end of the stream, until then 0.
    const PolicyStats& total() const { return stats_; }

private:
    struct Set {
        std::uint32_t held = 0, coming = 0, done = 0;
    };
    bool access_next();
    void await(std::uint64_t set, std::uint32_t id, std::uint32_t next_use);
    void evict(std::uint64_t set);
    bool smaller_line(std::uint32_t a, std::uint32_t b) const;

    PolicyConfig config_;
    const OptStream& stream_;
    SetOfLine index_;
    std::uint64_t ways_, now_ = 0;
    std::vector<Set> sets_;
    std::vector<std::uint64_t> coming_;  // 2 x ways a set, a heap: next use and id, the farthest on top
    std::vector<std::uint32_t> done_;    // ways a set, a heap: ids never used again, the smallest line on top
    std::vector<std::uint8_t> states_;   // by id
    PolicyStats stats_;
};

}  // namespace regather::cachesim
