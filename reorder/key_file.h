// reorder/key_file.h -- an ordering made elsewhere, as in NumPy: a .npy file with a key for each query, or
// with the queries' numbers in the order in which they run.
#pragma once
#include <filesystem>
#include <string>

#include "reorder/ordering.h"
#include "trace/npy.h"

namespace regather::reorder {

enum class FileHolds : std::uint8_t {
    keys,         ///< Row i: the key of query i; smaller keys run first, equal ones in capture order.
    permutation,  ///< Row r: the query that runs r-th.
};

/// The file has as many rows as there are queries; assign_keys() throws trace::DataError otherwise. Keys cost
/// nothing; the queries are collected and sorted by them, digit by digit over the bits in which keys differ
/// from the smallest, a permutation over those of a rank.
class KeyFile final : public Ordering {
public:
    /// Throws trace::DataError, one line that names the file, for a type that is not of whole numbers, for
    /// more than one dimension, and for a permutation's row and value that are no query or one that was there
    /// before.
    KeyFile(const std::filesystem::path& path, FileHolds holds);

    std::string checksum() const;  ///< XXH3-64 of the rows' bytes, in hexadecimal.
    Reads reads() const override { return {.rows = true}; }
    Cost assign_keys(const Workload& work, std::uint64_t onchip_bytes,
                     std::span<std::uint64_t> keys) const override;
    BufferUse buffer_use(const Workload& work, std::uint64_t onchip_bytes,
                         std::span<const std::uint32_t> permutation) const override;

private:
    std::string shown_path() const;
    void check_permutation() const;

    std::filesystem::path path_;
    FileHolds holds_;
    trace::IntegerColumn column_;
};

}  // namespace regather::reorder
