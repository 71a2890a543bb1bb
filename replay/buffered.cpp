#include "replay/buffered.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "cachesim/lines.h"
#include "replay/buffer_stream.h"
#include "replay/walk_run.h"

namespace regather::replay {
namespace {

using cachesim::Access, cachesim::Line, cachesim::LruCache;

/// The caches of one line size, and the accesses on their way to them: stretches of one region and kind.
class MixedStream {
public:
    MixedStream(const Layout& layout, std::uint32_t line_bytes)
        : layout_(layout),
          shift_(std::countr_zero(line_bytes)),
          base_(buffer_base(layout, line_bytes)),
          recent_(most_sets, std::numeric_limits<std::uint64_t>::max()) {}

    void add_cache(LruCache& cache) {
        caches_.push_back(&cache);
        recent_.resize(std::min<std::size_t>(recent_.size(), cache.config().sets()));
    }
    std::uint32_t line_bytes() const { return std::uint32_t{1} << shift_; }

    void append(std::span<const std::uint32_t> elements) {
        layout_.for_each(elements, [&](std::uint32_t, std::uint64_t address, std::uint32_t bytes) {
            append(address, bytes, Access::read, trace::Region::photons);
        });
        if (lines_.size() >= ready_lines) drain();
    }
    void append(std::span<const cachesim::ByteAccess> buffers) {
        for (const cachesim::ByteAccess& access : buffers)
            append(base_ + access.address, access.bytes, access.kind, trace::Region::reorder_buffer);
        if (lines_.size() >= ready_lines) drain();
    }
    void drain() {
        std::size_t begin = 0;
        for (const Stretch& stretch : stretches_) {
            const std::span<const Line> lines(lines_.data() + begin, stretch.end - begin);
            for (LruCache* cache : caches_) cache->access(lines, stretch.region, stretch.kind);
            begin = stretch.end;
        }
        stretches_.clear();
        lines_.clear();
    }
    std::uint64_t accesses(trace::Region region) const { return accesses_[static_cast<std::size_t>(region)]; }

private:
    struct Stretch {
        std::size_t end;
        trace::Region region;
        Access kind;
    };
    static constexpr std::size_t ready_lines = 16384, most_sets = 4096;

    /// A read of the line that is the last one used of its set changes nothing in an LRU cache, nor in one of
    /// more sets; such reads are counted, but not passed on.
    void append(std::uint64_t address, std::uint64_t bytes, Access kind, trace::Region region) {
        cachesim::for_each_line(address, bytes, line_bytes(), [&](Line line) {
            ++accesses_[static_cast<std::size_t>(region)];
            std::uint64_t& last_used = recent_[static_cast<std::uint64_t>(line) & (recent_.size() - 1)];
            if (kind == Access::read && last_used == static_cast<std::uint64_t>(line)) return;
            last_used = static_cast<std::uint64_t>(line);
            if (stretches_.empty() || stretches_.back().region != region || stretches_.back().kind != kind)
                stretches_.push_back({lines_.size(), region, kind});
            lines_.push_back(line);
            ++stretches_.back().end;
        });
    }

    const Layout& layout_;
    int shift_;
    std::uint64_t base_;
    std::vector<std::uint64_t> recent_;  // by set of the cache with the fewest: the line last used
    std::vector<Line> lines_;
    std::vector<Stretch> stretches_;
    std::array<std::uint64_t, trace::region_count> accesses_{};
    std::vector<LruCache*> caches_;
};

}  // namespace

std::vector<BufferedTraffic> replay_with_buffers(const WalkStore& walks, const Layout& layout,
                                                 std::span<const std::uint32_t> permutation,
                                                 const reorder::BufferUse& use,
                                                 std::span<const cachesim::CacheConfig> caches,
                                                 const QueriesDone& progress) {
    std::vector<LruCache> simulated;
    simulated.reserve(caches.size());
    std::vector<MixedStream> streams;
    std::vector<std::size_t> stream_of;
    for (const cachesim::CacheConfig& config : caches) {
        simulated.emplace_back(config);
        std::size_t stream = 0;
        while (stream < streams.size() && streams[stream].line_bytes() != config.line_bytes) ++stream;
        if (stream == streams.size()) streams.emplace_back(layout, config.line_bytes);
        streams[stream].add_cache(simulated.back());
        stream_of.push_back(stream);
    }

    BufferStream buffers(use, permutation);
    const BufferStream::Sink into_streams = [&](std::span<const cachesim::ByteAccess> accesses) {
        for (MixedStream& stream : streams) stream.append(accesses);
    };
    std::uint64_t r = 0;
    run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> elements) {
        buffers.before(r++, into_streams);
        for (MixedStream& stream : streams) stream.append(elements);
    });
    buffers.finish(into_streams);
    for (MixedStream& stream : streams) stream.drain();

    std::vector<BufferedTraffic> result;
    for (std::size_t i = 0; i < simulated.size(); ++i) {
        LruCache& cache = simulated[i];
        cache.flush();
        const auto of = [&](trace::Region region) {
            cachesim::CacheStats stats = cache.stats(region);
            stats.accesses = streams[stream_of[i]].accesses(region);
            return stats;
        };
        BufferedTraffic traffic{cache.config(), of(trace::Region::photons), of(trace::Region::reorder_buffer),
                                0, 0};
        const std::uint64_t line = cache.config().line_bytes;
        traffic.photon_bytes = (traffic.photons.misses + traffic.photons.writebacks) * line;
        traffic.buffer_bytes = (traffic.buffers.misses + traffic.buffers.writebacks) * line;
        result.push_back(traffic);
    }
    return result;
}

}  // namespace regather::replay
