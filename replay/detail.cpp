#include "replay/detail.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "replay/buffer_stream.h"
#include "replay/walk_run.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

/// The levels of each region of a structure, numbered.
class Classes {
public:
    explicit Classes(const spatial::Structure& structure) : structure_(structure) {
        for (const spatial::ElementRange& range : structure.ranges()) {
            std::uint32_t levels = 0;
            for (std::uint32_t e = range.first; e < range.first + range.count; ++e)
                levels = std::max(levels, structure.level(e) + 1);
            starts_.push_back(count());
            for (std::uint32_t l = 0; l < levels; ++l) classes_.push_back({range.region, l});
        }
    }
    std::uint32_t count() const { return static_cast<std::uint32_t>(classes_.size()); }
    std::uint32_t of(std::uint32_t element) const {
        return starts_[spatial::range_at(structure_.ranges(), element)] + structure_.level(element);
    }
    trace::Region region(std::uint32_t c) const { return classes_[c].region; }
    std::uint32_t level(std::uint32_t c) const { return classes_[c].level; }

private:
    struct Class {
        trace::Region region;
        std::uint32_t level;
    };
    const spatial::Structure& structure_;
    std::vector<std::uint32_t> starts_;  // by range: its first class
    std::vector<Class> classes_;
};

}  // namespace

cachesim::ClassStats Detail::sum(std::optional<trace::Region> region) const {
    cachesim::ClassStats sum;
    for (const DetailPart& part : parts)
        if (!region || part.region == *region) sum += part.stats;
    return sum;
}

std::uint64_t Detail::traffic_bytes(std::optional<trace::Region> region) const {
    std::uint64_t sum = 0;
    for (const DetailPart& part : parts)
        if (!region || part.region == *region) sum += part.traffic_bytes;
    return sum;
}

Detail replay_in_detail(const WalkStore& walks, const Layout& layout,
                        std::span<const std::uint32_t> permutation, const reorder::BufferUse& use,
                        const DetailConfig& config, const QueriesDone& progress) {
    if (config.slices == 0) throw trace::UsageError("slices: found 0, expected at least 1");
    const auto start = std::chrono::steady_clock::now();
    const Classes classes(walks.structure());
    const std::uint32_t buffers = classes.count();  // the class after the last level
    cachesim::AttributedCache cache(config.cache, buffers + 1);
    BufferStream stream(use, permutation);
    const std::uint64_t base = buffer_base(layout, config.cache.line_bytes);
    const BufferStream::Sink into_cache = [&](std::span<const cachesim::ByteAccess> accesses) {
        for (cachesim::ByteAccess access : accesses) {
            access.address += base;
            cache.access(access, buffers);
        }
    };

    Detail detail;
    const std::uint64_t queries = permutation.size(), slices = std::min(config.slices, queries);
    cachesim::ClassStats before;
    std::uint64_t r = 0, first = 0;
    const auto end_slice = [&] {
        const cachesim::ClassStats now = cache.total();
        detail.slices.push_back(
            {first, r - first, now.accesses - before.accesses, now.misses - before.misses});
        before = now;
        first = r;
    };
    run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> elements) {
        stream.before(r, into_cache);
        layout.for_each(elements, [&](std::uint32_t element, std::uint64_t address, std::uint32_t bytes) {
            cache.access({address, bytes, cachesim::Access::read}, classes.of(element));
        });
        if (++r == queries) stream.finish(into_cache);
        if (r == (detail.slices.size() + 1) * queries / slices) end_slice();
    });
    if (queries == 0) stream.finish(into_cache);
    cache.flush();

    const std::span<const cachesim::ClassStats> stats = cache.stats();
    for (std::uint32_t c = 0; c < buffers; ++c)
        detail.parts.push_back(
            {classes.region(c), classes.level(c), stats[c], cache.traffic_bytes(stats[c])});
    detail.parts.push_back(
        {trace::Region::reorder_buffer, {}, stats[buffers], cache.traffic_bytes(stats[buffers])});
    detail.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return detail;
}

}  // namespace regather::replay
