// reorder/hashed.h -- queries pass through a few bounded buckets, chosen by position. The paper,
// section 6.3.2, "Hashed reordering" and "Tiled direction-binning Hashed reordering"; run as the machine that
// it describes.
#pragma once
#include <memory>
#include <utility>

#include "reorder/ordering.h"

namespace regather::reorder {

struct HashedConfig {
    std::uint32_t buckets = 512;
    std::uint32_t capacity = 64;  ///< Queries a bucket holds.
    std::uint32_t cells = 16;     ///< Of the position grid, along the longest edge of the bounds.
};

/// The bucket of a cell: the spatial hash of Teschner et al., "Optimized Spatial Hashing", VMV 2003.
std::uint32_t bucket_of(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t buckets);

/// Queries are made in capture order, each put into the bucket of its cell, until the bucket needed is full;
/// the making then stalls. One query is processed at a time, first in first out, from the active bucket; when
/// that is empty, the fullest one becomes active, the first of equals. After each, the making goes on as far
/// as it can. NaN and infinite positions share a cell beside the grid.
class Hashed final : public Ordering {
public:
    explicit Hashed(const HashedConfig& config);  ///< trace::UsageError names the field at fault.
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> permutation) const override;

    /// The same machine fed in another order: incoming[r] is made r-th.
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<const std::uint32_t> incoming, std::span<std::uint64_t> keys) const;
    /// Likewise; record_bytes is 0 when the buckets fit.
    BoundedBuckets buckets(const Workload& work, std::uint64_t onchip_bytes,
                           std::vector<std::uint32_t> incoming) const;
    std::uint64_t buffer_bytes() const;

private:
    HashedConfig config_;
};

/// Hashed, fed by an ordering that makes queries in passes over tiles. Costs are summed; the buckets are
/// placed on the chip first.
class HashedBehind final : public Ordering {
public:
    HashedBehind(std::unique_ptr<const Ordering> making, const HashedConfig& hashing)
        : making_(std::move(making)), hashing_(hashing) {}
    Reads reads() const override { return making_->reads(); }
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> permutation) const override;

private:
    /// The chip's room for the pixel state: the buckets come first.
    std::uint64_t making_onchip(std::uint64_t onchip_bytes) const {
        const std::uint64_t buckets = hashing_.buffer_bytes();
        return buckets <= onchip_bytes ? onchip_bytes - buckets : onchip_bytes;
    }

    std::unique_ptr<const Ordering> making_;
    Hashed hashing_;
};

}  // namespace regather::reorder
