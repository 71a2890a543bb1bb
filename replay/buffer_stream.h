// replay/buffer_stream.h -- the accesses of an ordering's buffers in memory, one after the other, in step
// with the searches: reorder/buffer_use.h says what happens, this says where and when.
//
// Addresses are offsets from the start of the buffers. The pixel state of one tile comes first, then the
// records; each array starts on a multiple of `alignment`, and the next tile or batch uses it again.
// - Batches: when the first search of a batch is due, all its records are written in capture order, each at
// the next
//   free place of the part that it belongs to. Parts are 256 runs of equally many records of the sorted batch
//   (of the part, in later rounds). A further round reads them place by place and writes them into a second
//   array, and the next one back. Just before search r of the batch, place r is read.
// - Buckets: a record is written into its bucket, which is a ring of `capacity` places, as soon as it is
// made, and read
//   just before its search.
// - Pixel state: just before a query of a pass is made, the state of all pixels of the tile up to its own; in
// row order.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cachesim/lines.h"
#include "reorder/buffer_use.h"
#include "replay/layout.h"

namespace regather::replay {

class BufferStream {
public:
    /// `permutation` as the use was made for; both outlive the stream. Throws std::invalid_argument when they
    /// do not fit.
    BufferStream(const reorder::BufferUse& use, std::span<const std::uint32_t> permutation);

    using Sink = std::function<void(std::span<const cachesim::ByteAccess>)>;
    /// What happens just before search r; to be called with r = 0, 1, 2, ... once each.
    void before(std::uint64_t r, const Sink& sink);
    /// What happens after the last search.
    void finish(const Sink& sink);

    static constexpr std::uint64_t alignment = 4096;

private:
    void distribute(std::uint64_t begin, std::uint64_t end, const Sink& sink);
    void make_all_possible(const Sink& sink);
    void pass_over(std::uint64_t made, std::uint32_t query, const Sink& sink);
    void pass_until(std::uint64_t pass, std::uint64_t place, const Sink& sink);
    void touch(std::uint64_t offset, std::uint64_t bytes, cachesim::Access kind, const Sink& sink);
    void drain(const Sink& sink);
    std::uint64_t batch_place(std::uint32_t array, std::uint64_t place) const;

    const reorder::BufferUse& use_;
    std::span<const std::uint32_t> permutation_;
    std::uint64_t records_ = 0, second_records_ = 0;  // offsets of the arrays
    std::size_t batch_ = 0;
    std::uint64_t batch_begin_ = 0;
    std::uint64_t made_ = 0;
    std::vector<std::uint64_t> pushed_, popped_;  // by bucket
    std::size_t run_ = 0;
    std::uint64_t pass_ = 0, place_ = 0;  // the pixel whose state comes next
    std::vector<cachesim::ByteAccess> ready_;
};

/// Where the buffers start, behind all elements: a multiple of the line size and of the alignment.
std::uint64_t buffer_base(const Layout& layout, std::uint32_t line_bytes);

}  // namespace regather::replay
