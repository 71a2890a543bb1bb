// tests/reorder/buffer_bytes.h -- what an ordering's buffer writes and reads, summed up from its parts:
// records are read as often as they are written, a state of the pixels is read in every pass but the first.
#pragma once
#include "reorder/buffer_use.h"

namespace regather::reorder {

inline std::uint64_t record_bytes(const BufferUse& use) {
    std::uint64_t bytes = 0;
    if (use.batches && !use.batches->ends.empty())
        bytes += use.batches->ends.back() * use.batches->record_bytes * use.batches->rounds;
    if (use.buckets) bytes += use.buckets->bucket.size() * use.buckets->record_bytes;
    return bytes;
}
inline std::uint64_t pixel_bytes(const BufferUse& use) {
    return use.state
               ? std::uint64_t{use.state->image_width} * use.state->image_height * use.state->state_bytes
               : 0;
}
inline std::uint64_t written_bytes(const BufferUse& use) {
    return record_bytes(use) + pixel_bytes(use);
}
inline std::uint64_t read_bytes(const BufferUse& use) {
    return record_bytes(use) + (use.state ? pixel_bytes(use) * (use.state->passes - 1) : 0);
}

}  // namespace regather::reorder
