#include "cachesim/cache.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>

#include "cachesim/lru/engine.h"
#include "trace/error.h"

namespace regather::cachesim {

void check(const CacheConfig& config) {
    const std::uint64_t size = config.size_bytes, line = config.line_bytes, ways = config.ways;
    if (!std::has_single_bit(line))
        throw trace::UsageError(fmt::format("line_bytes: found {}, expected a power of two", line));
    if (size == 0 || size % line != 0)
        throw trace::UsageError(
            fmt::format("size_bytes: found {}, expected a multiple of the line of {} bytes, from one line up",
                        size, line));
    const std::uint64_t lines = size / line;
    if (lines > max_lines)
        throw trace::UsageError(
            fmt::format("size_bytes: found {}, which is {} lines of {} bytes, expected at most {} lines",
                        size, lines, line, max_lines));
    if (ways == fully_associative) return;
    if (lines % ways != 0 || !std::has_single_bit(lines / ways))
        throw trace::UsageError(
            fmt::format("ways: found {} ways of {} lines ({} bytes in lines of {}), which is {} sets, "
                        "expected a power of two of sets",
                        ways, lines, size, line, static_cast<double>(lines) / static_cast<double>(ways)));
}

namespace {

const CacheConfig& checked(const CacheConfig& config) {
    check(config);
    return config;
}

}  // namespace

LruCache::LruCache(const CacheConfig& config)
    : config_(checked(config)),
      engine_(set_engine_serves(config) ? make_set_engine(config) : make_list_engine(config)) {}
LruCache::~LruCache() = default;
LruCache::LruCache(LruCache&&) noexcept = default;
LruCache& LruCache::operator=(LruCache&&) noexcept = default;

void LruCache::access(std::span<const Line> lines, trace::Region region, Access kind) {
    stats_[static_cast<std::size_t>(region)].accesses += lines.size();
    engine_->access({lines, &kind, 0, region}, stats_);
}

void LruCache::access(std::span<const Line> lines, std::span<const Access> kinds, trace::Region region) {
    assert(lines.size() == kinds.size());
    stats_[static_cast<std::size_t>(region)].accesses += lines.size();
    engine_->access({lines, kinds.data(), 1, region}, stats_);
}

void LruCache::flush() {
    engine_->flush(stats_);
}

CacheStats LruCache::total() const {
    CacheStats sum;
    for (const CacheStats& region : stats_) {
        sum.accesses += region.accesses;
        sum.misses += region.misses;
        sum.writebacks += region.writebacks;
    }
    return sum;
}

std::uint64_t LruCache::traffic_bytes() const {
    const CacheStats sum = total();
    return (sum.misses + sum.writebacks) * config_.line_bytes;
}

}  // namespace regather::cachesim
