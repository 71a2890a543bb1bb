#include "replay/replay.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <limits>
#include <string_view>

#include "cachesim/distinct.h"
#include "cachesim/lines.h"
#include "spatial/walk.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

constexpr std::uint64_t prefetch_table = 32, prefetch_walk = 12, progress_queries = 1 << 16;

[[noreturn]] void refuse(std::uint64_t query, spatial::WalkFault fault) {
    constexpr std::array<std::string_view, 4> found{"", "a walk that ends early", "bytes after the walk's end",
                                                    "a walk that enters a node that does not exist"};
    throw trace::DataError(fmt::format("walk.npy: query {}: found {}, expected the walk of a search in this tree", query,
                                       found[static_cast<std::size_t>(fault)]));
}

/// The caches of one line size, and the lines on their way to them.
class LineStream {
public:
    LineStream(const HeapLayout& layout, std::uint32_t line_bytes)
        : layout_(layout),
          shift_(std::countr_zero(line_bytes)),
          recent_(most_sets, std::numeric_limits<std::uint64_t>::max()),
          lines_(capacity) {}

    void add_cache(cachesim::LruCache& cache) {
        caches_.push_back(&cache);
        recent_.resize(std::min<std::size_t>(recent_.size(), cache.config().sets()));
    }
    std::uint32_t line_bytes() const { return std::uint32_t{1} << shift_; }

    /// A line that is the last one used of its set hits in an LRU cache and changes nothing there; nor in one of more sets,
    /// which split that set. Such accesses are counted but not passed on.
    void append(std::span<const std::uint32_t> slots) {
        for (; slots.size() > part; slots = slots.subspan(part)) append_part(slots.first(part));
        append_part(slots);
    }
    std::uint64_t accesses() const { return accesses_; }
    void drain() {
        const std::span<const cachesim::Line> ready(lines_.data(), fill_);
        for (cachesim::LruCache* cache : caches_) cache->access(ready, trace::Region::photons);
        fill_ = 0;
    }

private:
    void append_part(std::span<const std::uint32_t> slots) {
        if (fill_ + slots.size() * most_lines() > lines_.size()) drain();
        cachesim::Line* to = lines_.data() + fill_;
        std::uint64_t* const recent = recent_.data();
        const std::uint64_t set_mask = recent_.size() - 1;
        std::uint64_t accesses = 0;
        const auto pass = [&](std::uint64_t line, bool wanted) {
            std::uint64_t& last_used = recent[line & set_mask];
            *to = cachesim::Line{line};
            to += static_cast<int>(wanted) & static_cast<int>(last_used != line);  // else overwritten
            last_used = line;
        };
        for (const std::uint32_t slot : slots) {
            const std::uint64_t address = layout_.address(slot);
            const std::uint64_t first = address >> shift_, last = (address + layout_.used_bytes - 1) >> shift_;
            accesses += last - first + 1;
            pass(first, true);
            if (last - first <= 1) {
                pass(last, last != first);
            } else {
                for (std::uint64_t line = first + 1; line <= last; ++line) pass(line, true);
            }
        }
        accesses_ += accesses;
        fill_ = static_cast<std::size_t>(to - lines_.data());
    }
    static constexpr std::size_t part = 256, capacity = 16384, most_sets = 4096;
    std::size_t most_lines() const { return layout_.used_bytes / line_bytes() + 2; }
    const HeapLayout layout_;
    int shift_;
    std::size_t fill_ = 0;
    std::uint64_t accesses_ = 0;
    std::vector<std::uint64_t> recent_;  // by set of the cache with the fewest: the line last used
    std::vector<cachesim::Line> lines_;
    std::vector<cachesim::LruCache*> caches_;
};

}  // namespace

Replayed replay(const WalkStore& walks, const HeapLayout& layout, std::span<const std::uint32_t> permutation,
                std::span<const cachesim::CacheConfig> caches, const std::function<void(std::uint64_t)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<cachesim::LruCache> simulated;
    simulated.reserve(caches.size());
    std::vector<LineStream> streams;
    streams.reserve(caches.size());
    for (const cachesim::CacheConfig& config : caches) {
        simulated.emplace_back(config);
        LineStream* stream = nullptr;
        for (LineStream& candidate : streams)
            if (candidate.line_bytes() == config.line_bytes) stream = &candidate;
        if (!stream) stream = &streams.emplace_back(layout, config.line_bytes);
        stream->add_cache(simulated.back());
    }

    spatial::WalkDecoder decoder(walks.photons());
    Replayed result;
    std::uint64_t visited = 0;
    for (std::uint64_t r = 0; r < permutation.size(); ++r) {
        if (r + prefetch_table < permutation.size()) walks.prefetch(permutation[r + prefetch_table]);
        if (r + prefetch_walk < permutation.size()) {
            const std::span<const std::uint8_t> ahead = walks.walk(permutation[r + prefetch_walk]);
            __builtin_prefetch(ahead.data());
            __builtin_prefetch(ahead.data() + ahead.size());
        }
        const auto [fault, slots] = decoder.decode(walks.walk(permutation[r]));
        if (fault != spatial::WalkFault::none) refuse(permutation[r], fault);
        visited += slots.size();
        for (LineStream& stream : streams) stream.append(slots);
        if (progress && (r + 1) % progress_queries == 0) progress(r + 1);
    }
    for (LineStream& stream : streams) stream.drain();
    if (progress) progress(permutation.size());

    result.visited_nodes = visited;
    result.raw_bytes = visited * layout.used_bytes;
    for (const cachesim::LruCache& cache : simulated) {
        const auto stream = std::find_if(streams.begin(), streams.end(), [&](const LineStream& candidate) {
            return candidate.line_bytes() == cache.config().line_bytes;
        });
        result.caches.push_back({cache.config(), stream->accesses(), cache.total().misses, cache.traffic_bytes()});
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

std::vector<bool> touched_nodes(const WalkStore& walks) {
    const std::size_t slots = std::size_t{walks.photons()} + 1;
    struct Part {
        spatial::WalkDecoder decoder;
        std::vector<bool> touched;
    };
    tbb::enumerable_thread_specific<Part> parts(
        [&] { return Part{spatial::WalkDecoder(walks.photons()), std::vector<bool>(slots)}; });
    tbb::parallel_for(tbb::blocked_range<std::uint64_t>(0, walks.queries(), 4096), [&](const auto& range) {
        Part& part = parts.local();
        for (std::uint64_t q = range.begin(); q != range.end(); ++q) {
            const spatial::WalkDecoder::Visits visits = part.decoder.decode(walks.walk(q));
            if (visits.fault != spatial::WalkFault::none) refuse(q, visits.fault);
            for (const std::uint32_t slot : visits.slots) part.touched[slot] = true;
        }
    });
    std::vector<bool> touched(slots);
    for (const Part& part : parts)
        for (std::size_t s = 0; s < slots; ++s)
            if (part.touched[s]) touched[s] = true;
    return touched;
}

std::uint64_t compulsory_bytes(const std::vector<bool>& touched, const HeapLayout& layout, std::uint32_t line_bytes) {
    cachesim::DistinctLines distinct;
    std::vector<cachesim::Line> lines;
    for (std::uint32_t slot = 1; slot < touched.size(); ++slot) {
        if (!touched[slot]) continue;
        lines.clear();
        cachesim::append_lines(lines, layout.address(slot), layout.used_bytes, line_bytes);
        distinct.add(lines);
    }
    return distinct.count() * line_bytes;
}

}  // namespace regather::replay
