#include "reorder/key_file.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <type_traits>

#include "reorder/deferred.h"
#include "reorder/tiling.h"
#include "trace/digest.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::reorder {
namespace {

/// Whole numbers of any type in one order: the smallest int64 is 0, where there are signs.
template <class T>
std::uint64_t key_of(T value) {
    if constexpr (std::is_signed_v<T>)
        return static_cast<std::uint64_t>(std::int64_t{value}) ^ std::uint64_t{1} << 63;
    else
        return value;
}

}  // namespace

KeyFile::KeyFile(const std::filesystem::path& path, FileHolds holds)
    : path_(path), holds_(holds), column_(path) {
    if (holds == FileHolds::permutation) check_permutation();
}

std::string KeyFile::shown_path() const {
    return trace::shown(path_.string(), trace::most_shown_path);
}

void KeyFile::check_permutation() const {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    const std::uint64_t count = column_.size();
    if (count >= none)
        throw trace::DataError(
            fmt::format("{}: found {} rows, expected fewer than 2^32 - 1", shown_path(), count));
    std::vector<std::uint32_t> row_of(count, none);
    column_.visit([&](auto rows) {
        for (std::uint32_t row = 0; row < count; ++row) {
            const auto value = rows[row];
            if (value < 0 || static_cast<std::uint64_t>(value) >= count)
                throw trace::DataError(fmt::format("{}: row {}: found {}, expected a query from 0 to {}",
                                                   shown_path(), row, value, count - 1));
            std::uint32_t& before = row_of[static_cast<std::size_t>(value)];
            if (before != none)
                throw trace::DataError(
                    fmt::format("{}: row {}: found {}, as in row {}, expected each query once", shown_path(),
                                row, value, before));
            before = row;
        }
    });
}

std::string KeyFile::checksum() const {
    return trace::hexadecimal(column_.checksum());
}

Cost KeyFile::assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                          std::span<std::uint64_t> keys) const {
    if (column_.size() != keys.size())
        throw trace::DataError(fmt::format("{}: found {} rows, expected {}, one for each query", shown_path(),
                                           column_.size(), keys.size()));
    std::uint64_t range = keys.empty() ? 0 : keys.size() - 1;
    column_.visit([&](auto rows) {
        if (holds_ == FileHolds::permutation) {
            for (std::size_t r = 0; r < keys.size(); ++r) keys[static_cast<std::size_t>(rows[r])] = r;
            return;
        }
        tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) { keys[i] = key_of(rows[i]); });
        const auto [least, greatest] = std::minmax_element(keys.begin(), keys.end());
        if (!keys.empty()) range = *greatest - *least;
    });
    return deferred_cost(work, Tiling(work, {}),
                         {.key_bits = static_cast<std::uint32_t>(std::bit_width(range))}, onchip_bytes);
}

BufferUse KeyFile::buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                              std::span<const std::uint32_t> permutation) const {
    return deferred_buffer_use(work, Tiling(work, {}), onchip_bytes, permutation);
}

}  // namespace regather::reorder
