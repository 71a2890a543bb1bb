#include "cachesim/sweep.h"

#include <tbb/parallel_for_each.h>

#include <algorithm>

namespace regather::cachesim {

namespace {

constexpr std::size_t batch_lines = 1 << 16;  // lines and kinds of a batch stay in the second-level cache

}  // namespace

Sweep::Sweep(std::span<const CacheConfig> configs) {
    for (const CacheConfig& config : configs) {
        caches_.emplace_back(config);
        auto group = std::find_if(groups_.begin(), groups_.end(),
                                  [&](const SameLine& g) { return g.line_bytes == config.line_bytes; });
        if (group == groups_.end()) group = groups_.insert(group, {config.line_bytes, {}, {}, {}});
        group->caches.push_back(caches_.size() - 1);
    }
}

void Sweep::access(std::span<const ByteAccess> accesses) {
    tbb::parallel_for_each(groups_, [&](SameLine& group) { split(accesses, group); });
}

void Sweep::split(std::span<const ByteAccess> accesses, SameLine& group) {
    for (const ByteAccess& access : accesses)
        for_each_line(access.address, access.bytes, group.line_bytes, [&](Line line) {
            group.lines.push_back(line);
            group.kinds.push_back(access.kind);
            if (group.lines.size() == batch_lines) run(group);
        });
    run(group);
}

void Sweep::run(SameLine& group) {
    const bool writes = std::find(group.kinds.begin(), group.kinds.end(), Access::write) != group.kinds.end();
    tbb::parallel_for_each(group.caches, [&](std::size_t cache) {
        if (writes)
            caches_[cache].access(group.lines, group.kinds, trace::Region::other);
        else
            caches_[cache].access(group.lines, trace::Region::other);
    });
    group.lines.clear();
    group.kinds.clear();
}

void Sweep::flush() {
    for (LruCache& cache : caches_) cache.flush();
}

}  // namespace regather::cachesim
