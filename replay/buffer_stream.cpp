#include "replay/buffer_stream.h"

#include <algorithm>
#include <stdexcept>

#include "reorder/sort.h"

namespace regather::replay {
namespace {

using cachesim::Access;

constexpr std::size_t ready_accesses = 1024;
constexpr std::uint64_t parts = 256;

std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + BufferStream::alignment - 1) / BufferStream::alignment * BufferStream::alignment;
}

void require(bool fits, const char* what) {
    if (!fits)
        throw std::invalid_argument(std::string("buffer use: found other ") + what +
                                    " than the permutation's");
}

/// Where a pixel is in its tile, and how large that is; in the clipped tiles at the edges, too.
struct TileShape {
    std::uint64_t tile, columns, rows;
    std::uint64_t left, top;

    TileShape(const reorder::PixelPasses& state, std::uint64_t number) : tile(number) {
        const std::uint64_t edge = state.tile, across = (state.image_width - 1) / edge + 1;
        left = number % across * edge;
        top = number / across * edge;
        columns = std::min<std::uint64_t>(edge, state.image_width - left);
        rows = std::min<std::uint64_t>(edge, state.image_height - top);
    }
    std::uint64_t pixels() const { return columns * rows; }
    std::uint64_t place(std::uint32_t pixel, std::uint32_t image_width) const {
        return (pixel / image_width - top) * columns + (pixel % image_width - left);
    }
};

std::uint64_t tiles_of(const reorder::PixelPasses& state) {
    return std::uint64_t{(state.image_width - 1) / state.tile + 1} *
           ((state.image_height - 1) / state.tile + 1);
}

}  // namespace

std::uint64_t buffer_base(const Layout& layout, std::uint32_t line_bytes) {
    const std::uint64_t multiple = std::max<std::uint64_t>(line_bytes, BufferStream::alignment);
    return (layout.end_byte() + multiple - 1) / multiple * multiple;
}

BufferStream::BufferStream(const reorder::BufferUse& use, std::span<const std::uint32_t> permutation)
    : use_(use), permutation_(permutation) {
    const std::uint64_t queries = permutation.size();
    if (use.state) {
        require(use.state->pixel.size() == queries, "pixels");
        require((use.state->runs.empty() ? 0 : use.state->runs.back().end) == queries, "passes");
        const std::uint64_t pixels = std::uint64_t{std::min(use.state->tile, use.state->image_width)} *
                                     std::min(use.state->tile, use.state->image_height);
        records_ = aligned(pixels * use.state->state_bytes);
    }
    if (use.batches) {
        require(!use.batches->ends.empty() && use.batches->ends.back() == queries, "batches");
        std::uint64_t longest = 0, begin = 0;
        for (const std::uint64_t end : use.batches->ends) {
            longest = std::max(longest, end - begin);
            begin = end;
        }
        second_records_ = records_ + aligned(longest * use.batches->record_bytes);
    }
    if (use.buckets) {
        require(use.buckets->bucket.size() == queries, "buckets");
        require(use.buckets->made.empty() || use.buckets->made.size() == queries, "makings");
        pushed_.resize(use.buckets->buckets);
        popped_.resize(use.buckets->buckets);
    }
    ready_.reserve(ready_accesses);
}

void BufferStream::before(std::uint64_t r, const Sink& sink) {
    if (use_.batches) {
        if (r == batch_begin_) distribute(batch_begin_, use_.batches->ends[batch_], sink);
        touch(batch_place((use_.batches->rounds - 1) % 2, r - batch_begin_), use_.batches->record_bytes,
              Access::read, sink);
        if (r + 1 == use_.batches->ends[batch_]) {
            ++batch_;
            batch_begin_ = r + 1;
        }
    } else if (use_.buckets) {
        make_all_possible(sink);
        const std::uint32_t bucket = use_.buckets->bucket[permutation_[r]];
        require(popped_[bucket] < pushed_[bucket], "buckets");
        const std::uint64_t place =
            std::uint64_t{bucket} * use_.buckets->capacity + popped_[bucket]++ % use_.buckets->capacity;
        if (const std::uint64_t bytes = use_.buckets->record_bytes; bytes > 0)
            touch(records_ + place * bytes, bytes, Access::read, sink);
    } else if (use_.state) {
        pass_over(r, permutation_[r], sink);
    }
    drain(sink);
}

void BufferStream::finish(const Sink& sink) {
    if (use_.state) pass_until(tiles_of(*use_.state) * use_.state->passes, 0, sink);
    drain(sink);
}

/// Writes the records of a batch into memory, and through it as often as there are rounds.
void BufferStream::distribute(std::uint64_t begin, std::uint64_t end, const Sink& sink) {
    const std::uint64_t bytes = use_.batches->record_bytes;
    // By place: the rank in the sorted batch of the record that is there; at first the places are those of
    // the capture.
    const std::vector<std::uint64_t> captured(permutation_.begin() + static_cast<std::ptrdiff_t>(begin),
                                              permutation_.begin() + static_cast<std::ptrdiff_t>(end));
    std::vector<std::uint32_t> rank = reorder::sorted_permutation(captured), placed(rank.size());
    std::vector<std::uint32_t> ends{static_cast<std::uint32_t>(rank.size())}, next_ends;
    for (std::uint32_t round = 0; round < use_.batches->rounds; ++round) {
        std::uint64_t first = 0;
        next_ends.clear();
        for (const std::uint32_t last : ends) {
            // A part holds the ranks that are its places.
            const std::uint64_t records = last - first;
            std::uint64_t free[parts];
            for (std::uint64_t part = 0; part < parts; ++part)
                free[part] = first + (part * records + parts - 1) / parts;
            for (std::uint64_t place = first; place < last; ++place) {
                if (round > 0) touch(batch_place((round - 1) % 2, place), bytes, Access::read, sink);
                const std::uint64_t to = free[(rank[place] - first) * parts / records]++;
                placed[to] = rank[place];
                touch(batch_place(round % 2, to), bytes, Access::write, sink);
            }
            for (std::uint64_t part = 0, from = first; part < parts; from = free[part++])
                if (free[part] != from) next_ends.push_back(static_cast<std::uint32_t>(free[part]));
            first = last;
        }
        ends.swap(next_ends);
        rank.swap(placed);
    }
}

std::uint64_t BufferStream::batch_place(std::uint32_t array, std::uint64_t place) const {
    return (array == 0 ? records_ : second_records_) + place * use_.batches->record_bytes;
}

void BufferStream::make_all_possible(const Sink& sink) {
    const reorder::BoundedBuckets& buckets = *use_.buckets;
    for (; made_ < permutation_.size(); ++made_) {
        const std::uint32_t query = buckets.made.empty() ? static_cast<std::uint32_t>(made_)
                                                         : buckets.made[static_cast<std::size_t>(made_)];
        const std::uint32_t bucket = buckets.bucket[query];
        if (pushed_[bucket] - popped_[bucket] == buckets.capacity) return;
        if (use_.state) pass_over(made_, query, sink);
        const std::uint64_t place =
            std::uint64_t{bucket} * buckets.capacity + pushed_[bucket]++ % buckets.capacity;
        if (const std::uint64_t bytes = buckets.record_bytes; bytes > 0)
            touch(records_ + place * bytes, bytes, Access::write, sink);
    }
}

/// The query made r-th needs the state of its pixel.
void BufferStream::pass_over(std::uint64_t made, std::uint32_t query, const Sink& sink) {
    const reorder::PixelPasses& state = *use_.state;
    while (made >= state.runs[run_].end) ++run_;
    const std::uint64_t pass = state.runs[run_].pass;
    const TileShape tile(state, pass / state.passes);
    pass_until(pass, tile.place(state.pixel[query], state.image_width) + 1, sink);
}

/// Everything up to the first `place` pixels of a pass.
void BufferStream::pass_until(std::uint64_t pass, std::uint64_t place, const Sink& sink) {
    const reorder::PixelPasses& state = *use_.state;
    while (pass_ < pass || (pass_ == pass && place_ < place)) {
        const std::uint64_t pixels = TileShape(state, pass_ / state.passes).pixels();
        const Access kind = pass_ % state.passes == 0 ? Access::write : Access::read;
        const std::uint64_t until = pass_ < pass ? pixels : place;
        for (; place_ < until; ++place_) touch(place_ * state.state_bytes, state.state_bytes, kind, sink);
        if (pass_ == pass) return;
        ++pass_;
        place_ = 0;
    }
}

void BufferStream::touch(std::uint64_t offset, std::uint64_t bytes, Access kind, const Sink& sink) {
    ready_.push_back({offset, bytes, kind});
    if (ready_.size() == ready_accesses) drain(sink);
}

void BufferStream::drain(const Sink& sink) {
    if (ready_.empty()) return;
    sink(ready_);
    ready_.clear();
}

}  // namespace regather::replay
