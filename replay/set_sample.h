// replay/set_sample.h -- a replay of some of the sets of each cache: what the others miss is estimated, and
// how far off the estimate may be. Sets do not know of each other, so the sampled ones are exact (Kessler,
// Hill & Wood, "A Comparison of Trace-Sampling Techniques for Multi-Megabyte Caches", IEEE ToC 1994).
//
// Sampled are classes of lines, modulo a power of two that divides the number of sets of every cache: in each
// cache a class is a group of sets. The estimate is a ratio (Cochran, "Sampling Techniques", 1977, chapter
// 6): misses of the sampled classes, over the walks that touch their lines, times the walks that touch any.
// Lines that many walks touch are left out of both sums: they hit nearly always, and would put chance into
// the ratio.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "replay/replay.h"

namespace regather::replay {

struct Sampling {
    std::uint32_t one_of = 16;  ///< One set of so many: a power of two from 2 to 1024.
    std::uint64_t seed = 1;     ///< Which.
};

/// How many walks touch each line, from the layout's first one on; by line size.
using LineUse = std::map<std::uint32_t, std::vector<std::uint64_t>>;

/// For the line sizes of `caches`. On all cores.
LineUse count_line_use(const WalkStore& walks, const Layout& layout,
                       std::span<const cachesim::CacheConfig> caches, const QueriesDone& progress = {});

class SetSample {
public:
    /// `use` is of the same walks and layout, which outlive the sample. Throws trace::UsageError as check(),
    /// and trace::DataError where lines are touched and none of those that count is in a sampled class:
    /// nothing would tell of the others then.
    SetSample(const WalkStore& walks, const Layout& layout, std::span<const cachesim::CacheConfig> caches,
              const Sampling& sampling, const LineUse& use);

    /// Throws trace::UsageError for a rate that is not as above, and for a cache that is fully associative,
    /// has more than 32 ways or fewer than 2 x one_of sets.
    static void check(std::span<const cachesim::CacheConfig> caches, const Sampling& sampling);

    /// As replay::replay(), but misses are estimates with a SampleError. Any number of threads may call.
    Replayed replay(std::span<const std::uint32_t> permutation, const QueriesDone& progress = {}) const;

private:
    /// The caches of one line size.
    struct LineSize {
        std::uint32_t line_bytes = 0;
        std::uint64_t classes = 0;           ///< The modulus.
        std::vector<std::uint16_t> sampled;  ///< By class: its number among the sampled ones, or unsampled.
        std::vector<double> touches;         ///< By sampled class: walks x lines.
        double all_touches = 0;
        cachesim::FamilyConfig family;  ///< Of one class.
    };
    static constexpr std::uint16_t unsampled = 0xffff;
    struct Run;

    const WalkStore& walks_;
    const Layout& layout_;
    std::vector<cachesim::CacheConfig> caches_;
    std::vector<LineSize> sizes_;
};

}  // namespace regather::replay
