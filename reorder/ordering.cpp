#include "reorder/ordering.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <chrono>

#include "reorder/sort.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::reorder {
namespace {

std::string file_of(const Workload& work, std::string_view column) {
    return trace::shown((work.folder / fmt::format("query_{}.npy", column)).string(), trace::most_shown_path);
}

void check_column(const Workload& work, std::string_view name, std::size_t rows, bool needed) {
    const std::size_t queries = work.position.size();
    if (rows == queries) return;
    if (rows != 0)
        throw trace::DataError(fmt::format("{}: found {} rows, expected {} as in query_position.npy",
                                           file_of(work, name), rows, queries));
    if (needed)
        throw trace::UsageError(
            fmt::format("the ordering reads column {}, which this capture does not have", name));
}

/// The first query whose pixel is outside the image, or the number of queries.
std::size_t first_outside(std::span<const std::uint32_t> pixel, std::uint64_t pixels) {
    using Range = tbb::blocked_range<std::size_t>;
    const auto scan = [&](const Range& range, std::size_t first) {
        for (std::size_t i = range.begin(); i < std::min(range.end(), first); ++i)
            if (pixel[i] >= pixels) return i;
        return first;
    };
    return tbb::parallel_reduce(Range(0, pixel.size(), 1 << 16), pixel.size(), scan,
                                [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

void check(const Workload& work, Reads reads) {
    const std::size_t queries = work.position.size();
    if (queries > 0xffffffffu)
        throw trace::UsageError(fmt::format("{} queries to order, at most 4294967295 are possible", queries));
    check_column(work, "pixel", work.pixel.size(), true);
    check_column(work, "direction", work.direction.size(), reads.direction);
    check_column(work, "leaf_kd", work.leaf_kd.size(), reads.leaf_kd);
    check_column(work, "leaf_bvh", work.leaf_bvh.size(), reads.leaf_bvh);
    check_column(work, "end", work.end.size(), reads.end);
    check_column(work, "guess", work.guess.size(), reads.guess);
    const std::uint64_t pixels = std::uint64_t{work.image_width} * work.image_height;
    if (pixels == 0 || pixels > std::uint64_t{1} << 32)
        throw trace::DataError(fmt::format("image of {} x {} pixels, expected 1 to 2^32 pixels",
                                           work.image_width, work.image_height));
    const std::size_t outside = first_outside(work.pixel, pixels);
    if (outside != queries)
        throw trace::DataError(fmt::format("{}: row {}: found {}, expected less than {} ({} x {} pixels)",
                                           file_of(work, "pixel"), outside, work.pixel[outside], pixels,
                                           work.image_width, work.image_height));
}

}  // namespace

BufferUse Ordering::buffer_use(const Workload&, std::uint64_t, std::span<const std::uint32_t>) const {
    return {.known = false, .batches = {}, .buckets = {}, .state = {}};
}

Ordered order(const Ordering& ordering, const Workload& work, std::uint64_t onchip_bytes) {
    check(work, ordering.reads());
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::uint64_t> keys(work.position.size());
    Ordered result;
    result.cost = ordering.assign_keys(work, onchip_bytes, keys);
    result.permutation = sorted_permutation(keys);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace regather::reorder
