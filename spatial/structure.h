// spatial/structure.h -- what was walked, as a replay knows it: its elements, and how its walks give them
// back. A structure's file says how it is built and searched; where an element lies in memory is a layout's
// affair (replay/layout.h).
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trace/region.h"

namespace regather::spatial {

/// Consecutive elements of one kind.
struct ElementRange {
    trace::Region region = trace::Region::photons;
    std::uint32_t first = 0, count = 0;
    friend bool operator==(const ElementRange&, const ElementRange&) = default;
};

/// Which of ascending `ranges` an element of theirs lies in.
inline std::size_t range_at(std::span<const ElementRange> ranges, std::uint32_t element) {
    std::size_t r = 0;
    while (r + 1 < ranges.size() && element >= ranges[r + 1].first) ++r;
    return r;
}

/// Why a walk cannot be decoded.
enum class WalkFault : std::uint8_t { none, ends_early, bytes_left_over, enters_missing_child };

/// Gives walks back as elements. One thread at a time.
class WalkDecoder {
public:
    virtual ~WalkDecoder() = default;
    struct Visits {
        WalkFault fault = WalkFault::none;
        std::span<const std::uint32_t> elements;  ///< In the order of the visits; up to the fault.
    };
    /// The result lives until the next call.
    virtual Visits decode(std::span<const std::uint8_t> walk) = 0;
    /// How many bytes of the last walk its visits took, where the fault was none or bytes_left_over.
    std::size_t walk_bytes() const { return walk_bytes_; }

protected:
    std::size_t walk_bytes_ = 0;
};

/// Its elements have numbers below end(), in the order of ranges(); numbers between ranges stand for nothing.
/// Elements of Region::photons hold records of photons, counted in the order of their numbers. Where walks
/// tell which photons were found, the r-th element of Region::photon_power is what a record holds besides
/// what a search looks at; it hangs below no element and is no root.
class Structure {
public:
    virtual ~Structure() = default;
    virtual std::string_view name() const = 0;
    /// Ascending, without overlaps; none is empty.
    std::span<const ElementRange> ranges() const { return ranges_; }
    /// One more than the greatest element.
    std::uint32_t end() const { return ranges_.empty() ? 0 : ranges_.back().first + ranges_.back().count; }
    /// Steps from the root, or from where a search begins; 0 there.
    virtual std::uint32_t level(std::uint32_t element) const = 0;
    virtual std::unique_ptr<WalkDecoder> decoder() const = 0;
    /// Whether every walk means the same in both.
    virtual bool same_as(const Structure& other) const {
        return name() == other.name() && ranges_ == other.ranges_;
    }
    /// Appends the elements that hang below this one, in the order of their numbers; a leaf has none.
    virtual void append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const = 0;
    /// The elements that hang below no other.
    virtual std::vector<std::uint32_t> roots() const = 0;
    /// How many records an element holds: the photons of a leaf, else 1.
    virtual std::uint32_t records(std::uint32_t) const { return 1; }
    /// The first record of an element of Region::photons.
    virtual std::uint32_t first_record(std::uint32_t element) const {
        return element - range_of(trace::Region::photons).first;
    }
    /// Whether a walk comes back to elements whose photons it has looked at, each time from one of a greater
    /// number; it comes to others from smaller ones.
    virtual bool comes_back() const { return false; }
    /// Whether append_children() and roots() tell how elements hang together.
    virtual bool tells_children() const { return true; }
    /// What an element of Region::nodes or Region::directory takes, where a layout says nothing else [bytes].
    virtual std::uint32_t node_bytes() const { return 8; }
    /// What each element takes, where the structure says it and no record of a layout [bytes]; else empty.
    virtual std::span<const std::uint32_t> own_bytes() const { return {}; }
    /// Where each element lay in the program that was walked; empty where that is not told.
    virtual std::span<const std::uint64_t> own_addresses() const { return {}; }
    /// Without elements where the structure has none of this region.
    ElementRange range_of(trace::Region region) const {
        for (const ElementRange& range : ranges_)
            if (range.region == region) return range;
        return {region, 0, 0};
    }

protected:
    explicit Structure(std::vector<ElementRange> ranges) : ranges_(std::move(ranges)) {}

private:
    std::vector<ElementRange> ranges_;
};

}  // namespace regather::spatial
