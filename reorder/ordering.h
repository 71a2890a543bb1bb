// reorder/ordering.h -- decides the order in which captured queries are replayed, and says what that costs.
// An ordering only assigns sort keys and order() does the sorting: every result is therefore a permutation,
// ties keep capture order, and the same input gives the same order on every machine.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reorder/buffer_use.h"
#include "trace/bounds.h"
#include "trace/vec.h"

namespace regather::reorder {

using trace::Bounds3;
using trace::Vec3;

/// Bytes of one buffered query: location (12), RGB weight (12), destination pixel (4); the paper,
/// section 6.3.2.
inline constexpr std::uint64_t query_record_bytes = 28;
/// Bytes kept per pixel so that later passes need not cast its eye ray again: intersection (12), surface
/// normal (12), ray direction (12), BRDF (12: two RGB triples as RGBE, exponent); the paper, section 6.3.1.
inline constexpr std::uint64_t pixel_state_bytes = 48;

/// Which columns an ordering reads besides position and pixel.
struct Reads {
    bool direction = false, leaf_kd = false, leaf_bvh = false;
    bool end = false, guess = false;  ///< Of a ray.
    bool captured = false;            ///< Whichever were captured: what is missing is empty.

    Reads& operator|=(const Reads& other) {
        direction |= other.direction;
        leaf_kd |= other.leaf_kd;
        leaf_bvh |= other.leaf_bvh;
        end |= other.end;
        guess |= other.guess;
        captured |= other.captured;
        return *this;
    }
};

/// All that an ordering may look at: the queries in capture order (pixels in row order, samples in a pixel
/// together). Columns that were not captured are empty.
struct Workload {
    std::span<const Vec3> position;                   ///< [scene units]; may hold NaN or infinity.
    std::span<const Vec3> direction;                  ///< Of the gather ray that ended here, unit length.
    std::span<const std::uint32_t> pixel;             ///< y * image_width + x
    std::span<const std::uint32_t> leaf_kd;           ///< Leaf label: kd-tree over the triangles.
    std::span<const std::uint32_t> leaf_bvh;          ///< Leaf label: BVH over the triangles.
    std::span<const Vec3> end = {};                   ///< Where a ray ends [scene units].
    std::span<const Vec3> guess = {};                 ///< Where it would end in a coarse model.
    Bounds3 bounds;                                   ///< Of all finite positions.
    std::uint32_t image_width = 1, image_height = 1;  ///< [pixels]
    std::filesystem::path folder = {};                ///< Of the columns' files, for messages.
};

/// What producing an ordering costs a machine that does it as the paper describes. Counts, no ratios.
struct Cost {
    std::uint64_t keys = 0;     ///< Keys computed, or membership tests against a pass's direction interval.
    std::uint64_t key_ops = 0;  ///< Integer and floating-point operations spent on them.
    std::uint64_t sort_passes = 0;  ///< Digit passes of a radix sort with 8-bit digits over the key.
    std::uint64_t moved_records =
        0;  ///< Buffered records written to another place (into a bucket, by a digit pass).
    std::uint64_t buffered_bytes = 0;  ///< Peak bytes of queries or pixel state held back.
    std::uint64_t reorder_bytes =
        0;                          ///< Bytes written to and read from memory outside the chip because of it.
    std::uint64_t recast_rays = 0;  ///< Eye rays cast again; rays cast through a coarse model.
    std::uint64_t stalls = 0;       ///< Times the generation of queries had to wait for a full bucket.
};

class Ordering {
public:
    virtual ~Ordering() = default;
    virtual Reads reads() const { return {}; }
    /// keys[i] belongs to query i; smaller keys run first. A rank is a key, so any order can be said.
    /// `onchip_bytes`: what the chip can buffer; a larger buffer makes reorder_bytes.
    virtual Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                             std::span<std::uint64_t> keys) const = 0;
    /// What makes the reorder_bytes; empty when nothing does. `permutation` is that of order() with the same
    /// workload and onchip_bytes. By default not known.
    virtual BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                                 std::span<const std::uint32_t> permutation) const;
};

struct Ordered {
    std::vector<std::uint32_t> permutation;  ///< permutation[r] = the query that runs r-th.
    Cost cost;
    double seconds = 0;  ///< Measured here: keys and sort.
};

inline constexpr std::uint64_t default_onchip_bytes = 1 << 20;

/// At most 2^32 - 1 queries (trace::UsageError otherwise, and when a column the ordering reads is missing).
Ordered order(const Ordering& ordering, const Workload& work,
              std::uint64_t onchip_bytes = default_onchip_bytes);

}  // namespace regather::reorder
