// cachesim/sweep.h -- one stream of byte accesses through many LRU caches at once, each as if it were alone.
// Caches are simulated side by side on the threads of oneTBB; the counts do not depend on their number.
#pragma once
#include <span>
#include <vector>

#include "cachesim/lines.h"

namespace regather::cachesim {

class Sweep {
public:
    explicit Sweep(std::span<const CacheConfig> configs);  ///< check()s each.

    /// In this order. All are charged to trace::Region::other.
    void access(std::span<const ByteAccess> accesses);
    /// Writes back the dirty lines still held.
    void flush();
    /// In the order of the configs.
    std::span<const LruCache> caches() const { return caches_; }

private:
    struct SameLine {
        std::uint32_t line_bytes;
        std::vector<std::size_t> caches;
        std::vector<Line> lines;
        std::vector<Access> kinds;
    };
    void split(std::span<const ByteAccess> accesses, SameLine& group);
    void run(SameLine& group);

    std::vector<LruCache> caches_;
    std::vector<SameLine> groups_;  // the caches by line size: a batch is split into lines once for each
};

}  // namespace regather::cachesim
