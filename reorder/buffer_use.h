// reorder/buffer_use.h -- what an ordering's buffers do in memory when the chip cannot hold them: the bytes
// that Cost::reorder_bytes counts, with enough to say when each is written and read. The paper,
// sections 6.3.1 and 6.3.2. Values without addresses; replay/buffer_stream.h places and plays them.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace regather::reorder {

/// Queries are collected batch by batch and sorted by a distribution through memory: each round writes every
/// record to one of 256 parts of the part that it is in, and the next round or the processing reads it.
struct SortedBatches {
    std::uint64_t record_bytes = 0;
    std::uint32_t rounds = 1;
    std::vector<std::uint64_t> ends;  ///< Of the batches, in the permutation; the last one is all queries.
};

/// Queries are made one after the other and put into bounded first-in first-out buckets, until the one needed
/// is full; the permutation is the order in which they are taken out.
struct BoundedBuckets {
    std::uint64_t record_bytes =
        0;  ///< 0: the buckets are on the chip, but what is made when depends on them.
    std::uint32_t buckets = 1, capacity = 1;
    std::vector<std::uint32_t> bucket;  ///< By query.
    std::vector<std::uint32_t> made;    ///< made[m] is made m-th; empty: in capture order.
};

/// Each pass over a tile goes over all its pixels in row order: the first writes their state, the later ones
/// read it.
struct PixelPasses {
    std::uint64_t state_bytes = 0;
    std::uint32_t image_width = 1, image_height = 1, tile = 1;  ///< [pixels]
    std::uint32_t passes = 1;
    std::span<const std::uint32_t> pixel;  ///< By query: the workload's column.
    /// A run of queries that one pass makes: `pass` counts passes over all tiles, tile x passes + pass, and
    /// ascends; `end` is in the order of making, which is that of the buckets, or else the permutation.
    struct Run {
        std::uint64_t pass, end;
    };
    std::vector<Run> runs;
};

/// At most one of batches and buckets is there.
struct BufferUse {
    bool known = true;  ///< false: an ordering that tells its cost only.
    std::optional<SortedBatches> batches;
    std::optional<BoundedBuckets> buckets;
    std::optional<PixelPasses> state;

    bool empty() const { return !batches && !buckets && !state; }
};

}  // namespace regather::reorder
