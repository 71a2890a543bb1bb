// cachesim/lru/family_sweep.h -- one stream of byte accesses through every LRU cache of some line sizes: 1 to
// 2^16 sets (powers of two) of 1 to 16 ways, and fully associative ones of each power of two of lines that
// the stream can fill.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/lines.h"
#include "cachesim/lru/lru_family.h"
#include "cachesim/miss_class.h"

namespace regather::cachesim {

/// `misses` is the sum of the MissClasses, if those were asked for.
struct FamilyRow : MissClasses {
    CacheConfig config{};
    std::uint64_t accesses = 0, misses = 0;
};

class FamilySweep {
public:
    /// Line sizes are powers of two: trace::UsageError otherwise. With `ways` from 1 to 32.
    FamilySweep(std::span<const std::uint32_t> line_sizes, std::uint32_t ways, bool classes);

    /// In this order; a write counts as a read does. Line sizes run side by side on the threads of oneTBB.
    void access(std::span<const ByteAccess> accesses);
    /// By line size, then sets, then ways; last the fully associative ones by size. So far.
    std::vector<FamilyRow> rows();

private:
    struct LineSize {
        std::uint32_t line_bytes;
        std::vector<Line> lines;
        LruFamily family;
    };
    bool classes_;
    std::vector<LineSize> sizes_;
};

}  // namespace regather::cachesim
