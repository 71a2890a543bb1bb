// replay/layout.h -- where an element of a structure lies in memory: a choice of the replay, not of the
// capture. Addresses are computed, never taken from the host. Everything that a replay reads goes through
// for_each().
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spatial/structure.h"

namespace regather::replay {

/// What a visit of an element reads.
struct Extent {
    std::uint64_t address = 0;
    std::uint32_t bytes = 0;  ///< 0: nothing, the element is kept on chip.
    friend bool operator==(const Extent&, const Extent&) = default;
};

class Layout {
public:
    /// Elements in the order of their numbers, `stride_bytes` apart from `base` on; a visit reads the first
    /// `used_bytes`.
    Layout(std::string name, const spatial::Structure& structure, std::uint64_t base,
           std::uint32_t stride_bytes, std::uint32_t used_bytes);
    /// extents[e] is element e's; as many as structure.end().
    Layout(std::string name, const spatial::Structure& structure, std::vector<Extent> extents);

    std::string_view name() const { return name_; }
    /// All that elements read lies from first_byte() to before end_byte(). No bytes: 0 and 0.
    std::uint64_t first_byte() const { return first_byte_; }
    std::uint64_t end_byte() const { return end_byte_; }
    /// The most that one visit reads.
    std::uint32_t widest() const { return widest_; }

    Extent extent(std::uint32_t element) const {
        return extents_.empty() ? Extent{origin_ + std::uint64_t{element} * stride_bytes_, widest_}
                                : extents_[element];
    }
    trace::Region region(std::uint32_t element) const {
        return ranges_[spatial::range_at(ranges_, element)].region;
    }
    /// Calls use(element, address, bytes) for what each of `elements` reads, in their order.
    template <class Use>
    void for_each(std::span<const std::uint32_t> elements, Use&& use) const {
        if (extents_.empty()) {
            for (const std::uint32_t e : elements)
                use(e, origin_ + std::uint64_t{e} * stride_bytes_, widest_);
        } else {
            for (const std::uint32_t e : elements)
                if (const Extent x = extents_[e]; x.bytes > 0) use(e, x.address, x.bytes);
        }
    }
    /// Bytes that visits of `elements` read.
    std::uint64_t bytes(std::span<const std::uint32_t> elements) const;

private:
    std::string name_;
    std::vector<spatial::ElementRange> ranges_;
    std::uint64_t first_byte_ = 0, end_byte_ = 0;
    std::uint64_t origin_ = 0;  ///< Where element 0 would lie; modulo 2^64.
    std::uint32_t stride_bytes_ = 0, widest_ = 0;
    std::vector<Extent> extents_;  ///< By element; empty when they stand in a row.
};

/// The paper's: photons in heap order, 20 bytes each.
Layout heap_20(const spatial::Structure& structure);

}  // namespace regather::replay
