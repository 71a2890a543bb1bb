// replay/line_stream.h -- byte accesses of several regions on their way to LRU caches, each of which gets all
// of them as if it were alone.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/lines.h"

namespace regather::replay {

/// Caches of one line size.
class LineStream {
public:
    explicit LineStream(std::uint32_t line_bytes);

    /// Before the first access; outlives the stream.
    void add_cache(cachesim::LruCache& cache);
    std::uint32_t line_bytes() const { return line_bytes_; }
    void append(const cachesim::ByteAccess& access, trace::Region region) {
        cachesim::for_each_line(access.address, access.bytes, line_bytes_,
                                [&](cachesim::Line line) { append(line, access.kind, region); });
        if (lines_.size() >= most_waiting) drain();
    }
    /// Passes on all that waits.
    void drain();
    /// Line accesses so far.
    std::uint64_t accesses(trace::Region region) const { return accesses_[static_cast<std::size_t>(region)]; }

private:
    struct Stretch {
        std::size_t end;
        trace::Region region;
        cachesim::Access kind;
    };
    static constexpr std::size_t most_waiting = 16384, most_sets = 4096;

    /// A read of the line that is the last one used of its set changes nothing in an LRU cache, nor in one of
    /// more sets; such reads are counted, but not passed on.
    void append(cachesim::Line line, cachesim::Access kind, trace::Region region) {
        ++accesses_[static_cast<std::size_t>(region)];
        std::uint64_t& last_used = recent_[static_cast<std::uint64_t>(line) & (recent_.size() - 1)];
        if (kind == cachesim::Access::read && last_used == static_cast<std::uint64_t>(line)) return;
        last_used = static_cast<std::uint64_t>(line);
        if (stretches_.empty() || stretches_.back().region != region || stretches_.back().kind != kind)
            stretches_.push_back({lines_.size(), region, kind});
        lines_.push_back(line);
        ++stretches_.back().end;
    }

    std::uint32_t line_bytes_;
    std::vector<std::uint64_t> recent_;  // by set of the cache with the fewest: the line last used
    std::vector<cachesim::Line> lines_;
    std::vector<Stretch> stretches_;
    std::array<std::uint64_t, trace::region_count> accesses_{};
    std::vector<cachesim::LruCache*> caches_;
};

/// Caches of any line sizes.
class CacheStream {
public:
    /// Throws trace::UsageError as cachesim::check().
    explicit CacheStream(std::span<const cachesim::CacheConfig> configs);
    CacheStream(const CacheStream&) = delete;
    CacheStream& operator=(const CacheStream&) = delete;

    /// One for each line size, where accesses are to depend on it.
    std::span<LineStream> streams() { return streams_; }
    void append(const cachesim::ByteAccess& access, trace::Region region) {
        for (LineStream& stream : streams_) stream.append(access, region);
    }
    /// Drains, and flushes the caches: the last access.
    void finish();
    /// Of a cache by its place in the list.
    cachesim::CacheStats stats(std::size_t cache, trace::Region region) const;
    /// Bytes fetched and written back for all regions.
    std::uint64_t traffic_bytes(std::size_t cache) const { return caches_[cache].traffic_bytes(); }

private:
    std::vector<cachesim::LruCache> caches_;
    std::vector<LineStream> streams_;
    std::vector<std::size_t> stream_of_;  // by cache
};

}  // namespace regather::replay
