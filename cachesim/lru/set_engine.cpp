// Rows of 32-bit tags, until a line comes whose tag needs more; from then on rows of 64-bit tags.
#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <bit>

#include "cachesim/lru/set_kernel.h"

namespace regather::cachesim {

namespace {

// A way of all sets has at least as many bytes: then the tag of any 64-bit address is less than `empty`.
constexpr std::uint64_t min_way_bytes = 32;
constexpr std::uint32_t min_sets = 16, max_ways = 32;
static_assert(~std::uint64_t{0} / min_way_bytes < TagFormat<std::uint64_t>::empty);

class SetEngine final : public LruCache::Engine {
public:
    explicit SetEngine(const CacheConfig& config)
        : count_(config.sets() * row_of(config.ways)),
          rows_{nullptr, false, row_of(config.ways), config.ways,
                static_cast<std::uint32_t>(std::countr_zero(config.sets()))} {
        narrow_ = empty_rows<std::uint32_t>();
        rows_.tags = narrow_.get();
    }

    void access(const Run& run, RegionStats& stats) override {
        stateless_ = stateless_ && run.reads_only();
        for (std::size_t begin = 0; begin < run.lines.size();) {
            const SetCounts counts = access_sets(rows_, run, begin, stateless_);
            stats[static_cast<std::size_t>(run.region)].misses += counts.misses;
            for (std::size_t r = 0; r < trace::region_count; ++r)
                stats[r].writebacks += counts.writebacks[1 + r];
            begin += counts.done;
            if (begin < run.lines.size()) widen();
        }
    }

    void flush(RegionStats& stats) override {
        if (rows_.wide)
            flush_rows(wide_.get(), stats);
        else
            flush_rows(narrow_.get(), stats);
        stateless_ = true;
    }

private:
    using Wide = std::uint64_t;
    using Narrow = std::uint32_t;

    static std::uint32_t row_of(std::uint32_t ways) { return std::max(4u, std::bit_ceil(ways)); }

    template <class T>
    hwy::AlignedFreeUniquePtr<T[]> empty_rows() const {
        auto rows = hwy::AllocateAligned<T>(count_);
        if (!rows) throw std::bad_alloc();
        std::fill_n(rows.get(), count_, TagFormat<T>::empty);
        return rows;
    }

    void widen() {
        wide_ = empty_rows<Wide>();
        constexpr Narrow empty = TagFormat<Narrow>::empty;
        for (std::size_t i = 0; i < count_; ++i) {
            const Wide tag = narrow_[i] & empty, state = narrow_[i] >> TagFormat<Narrow>::shift;
            if (narrow_[i] != empty) wide_[i] = tag | state << TagFormat<Wide>::shift;
        }
        narrow_.reset();
        rows_.tags = wide_.get();
        rows_.wide = true;
    }

    template <class T>
    void flush_rows(T* tags, RegionStats& stats) {
        for (std::size_t i = 0; i < count_; ++i) {
            const auto state = static_cast<unsigned>(tags[i] >> TagFormat<T>::shift);
            if (state != clean) ++stats[state - 1].writebacks;
            tags[i] = TagFormat<T>::empty;
        }
    }

    std::size_t count_;
    SetRows rows_;
    hwy::AlignedFreeUniquePtr<Narrow[]> narrow_;
    hwy::AlignedFreeUniquePtr<Wide[]> wide_;
    bool stateless_ = true;
};

}  // namespace

bool set_engine_serves(const CacheConfig& config) {
    return config.ways != fully_associative && config.ways <= max_ways && config.sets() >= min_sets &&
           config.sets() * config.line_bytes >= min_way_bytes;
}

std::unique_ptr<LruCache::Engine> make_set_engine(const CacheConfig& config) {
    return std::make_unique<SetEngine>(config);
}

}  // namespace regather::cachesim
