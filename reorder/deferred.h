// reorder/deferred.h -- what it costs to collect queries and sort them before any is processed. The paper,
// section 6.3.2: "the search location, the RGB weight, and the destination pixel must be stored".
#pragma once
#include "reorder/ordering.h"
#include "reorder/tiling.h"

namespace regather::reorder {

struct DeferredSort {
    std::uint64_t ops_per_key = 0;
    std::uint32_t key_bits = 0;  ///< Of the code alone: tiles are sorted by being made one after the other.
};

std::uint64_t queries_in_fullest_tile(const Workload& work, const Tiling& tiling);

/// The queries of the fullest tile are buffered as records of query_record_bytes and sorted by a radix sort
/// with 8-bit digits. Tiles that do not fit the chip are first distributed 256 ways through memory until the
/// parts fit.
Cost deferred_cost(const Workload& work, const Tiling& tiling, const DeferredSort& sort,
                   std::uint64_t onchip_bytes);

/// The same sort's batches when the fullest tile does not fit; else nothing.
BufferUse deferred_buffer_use(const Workload& work, const Tiling& tiling, std::uint64_t onchip_bytes,
                              std::span<const std::uint32_t> permutation);

}  // namespace regather::reorder
