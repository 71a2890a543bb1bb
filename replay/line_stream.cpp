#include "replay/line_stream.h"

#include <algorithm>
#include <limits>

namespace regather::replay {

LineStream::LineStream(std::uint32_t line_bytes)
    : line_bytes_(line_bytes), recent_(most_sets, std::numeric_limits<std::uint64_t>::max()) {}

void LineStream::add_cache(cachesim::LruCache& cache) {
    caches_.push_back(&cache);
    recent_.resize(std::min<std::size_t>(recent_.size(), cache.config().sets()));
}

void LineStream::drain() {
    std::size_t begin = 0;
    for (const Stretch& stretch : stretches_) {
        const std::span<const cachesim::Line> lines(lines_.data() + begin, stretch.end - begin);
        for (cachesim::LruCache* cache : caches_) cache->access(lines, stretch.region, stretch.kind);
        begin = stretch.end;
    }
    stretches_.clear();
    lines_.clear();
}

CacheStream::CacheStream(std::span<const cachesim::CacheConfig> configs) {
    caches_.reserve(configs.size());
    for (const cachesim::CacheConfig& config : configs) {
        caches_.emplace_back(config);
        std::size_t stream = 0;
        while (stream < streams_.size() && streams_[stream].line_bytes() != config.line_bytes) ++stream;
        if (stream == streams_.size()) streams_.emplace_back(config.line_bytes);
        streams_[stream].add_cache(caches_.back());
        stream_of_.push_back(stream);
    }
}

void CacheStream::finish() {
    for (LineStream& stream : streams_) stream.drain();
    for (cachesim::LruCache& cache : caches_) cache.flush();
}

cachesim::CacheStats CacheStream::stats(std::size_t cache, trace::Region region) const {
    cachesim::CacheStats stats = caches_[cache].stats(region);
    stats.accesses = streams_[stream_of_[cache]].accesses(region);
    return stats;
}

}  // namespace regather::replay
