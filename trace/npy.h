// trace/npy.h -- columns as NumPy .npy files (format 1.0, little-endian, C order): written as a stream, read
// in place. Format: numpy.lib.format, NEP 1. Which columns a trace has: trace/folder.h and
// docs/trace_format.md.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trace/error.h"
#include "trace/photon.h"
#include "trace/vec.h"

namespace regather::trace {

/// What a row of a column is.
struct ColumnType {
    std::string descr;        ///< As in the .npy header: "'<f4'", or a list of fields.
    std::string inner_shape;  ///< "" for one value a row, "3" for three.
    std::size_t row_bytes;
    std::string readable;  ///< For people: "float32 x 3".
};

template <class T>
const ColumnType& column_type();  ///< For int8 to int64, uint8 to uint64, float, Vec3 and Photon.

/// What was written: rows, and XXH3-64 of the rows' bytes (without the header).
struct ColumnDigest {
    std::uint64_t rows = 0;
    std::uint64_t checksum = 0;
    friend bool operator==(const ColumnDigest&, const ColumnDigest&) = default;
};

/// Whether the bytes are on the disk when a writer says so: needed where an earlier file goes for the sake of
/// this one.
enum class OnDisk { eventually, before_return };

/// Appends rows; the header is completed by finish(). A file that was never finished has a row count of 0 and
/// trailing bytes, which MappedColumn refuses. Throws std::runtime_error when the disk is full or the path
/// cannot be written.
class ColumnWriter {
public:
    ColumnWriter(std::filesystem::path path, const ColumnType& type);
    ~ColumnWriter();
    ColumnWriter(ColumnWriter&&) noexcept;

    template <class T>
    void append(std::span<const T> rows) {
        append_bytes(std::as_bytes(rows));
    }
    void append_bytes(std::span<const std::byte> bytes);
    ColumnDigest finish(OnDisk on_disk = OnDisk::eventually);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Maps a finished column read-only; one whose header leaves its rows where no type may stand is copied
/// instead. Throws DataError (path, found, expected) for a missing file, no or a foreign header, a wrong type
/// or shape, foreign byte order, Fortran order, and bytes missing or left over. A column of uint64 may be one
/// of int64, NumPy's own choice for whole numbers, when no value is negative.
class MappedColumn {
public:
    MappedColumn(const std::filesystem::path& path, const ColumnType& type)
        : MappedColumn(path, type, type) {}
    /// Of the one type or the other: row_bytes() tells which.
    MappedColumn(const std::filesystem::path& path, const ColumnType& type, const ColumnType& other);
    ~MappedColumn();
    MappedColumn(MappedColumn&&) noexcept;
    MappedColumn& operator=(MappedColumn&&) noexcept;

    std::uint64_t size() const { return rows_; }
    std::size_t row_bytes() const { return row_bytes_; }
    std::uint64_t checksum() const;  ///< XXH3-64 of the rows' bytes; reads them all.
    template <class T>
    std::span<const T> rows() const {
        return {reinterpret_cast<const T*>(data_), rows_};
    }
    std::span<const std::byte> bytes() const { return {data_, rows_ * row_bytes_}; }
    /// Tells the kernel that the rows are read in no order (madvise).
    void expect_random_access() const;

private:
    friend class IntegerColumn;
    /// Of one of several types: `type` is its place among them. `readable` and `expected` say them in
    /// messages.
    MappedColumn(const std::filesystem::path& path, std::span<const ColumnType* const> types,
                 std::string_view readable, std::string_view expected, std::size_t& type);

    void* map_ = nullptr;
    std::size_t map_bytes_ = 0;
    std::vector<std::uint64_t> copy_;
    const std::byte* data_ = nullptr;
    std::uint64_t rows_ = 0;
    std::size_t row_bytes_ = 0;
};

/// A column of whole numbers of any width, signed or not, as NumPy makes them. Throws as MappedColumn; floats
/// and truth values are another type.
class IntegerColumn {
public:
    explicit IntegerColumn(const std::filesystem::path& path);

    std::uint64_t size() const { return column_.size(); }
    std::uint64_t checksum() const { return column_.checksum(); }
    /// use(rows), a span of int8, int16, int32, int64, uint8, uint16, uint32 or uint64.
    template <class Use>
    decltype(auto) visit(Use&& use) const {
        switch (type_) {
            case 0:
                return use(column_.rows<std::int8_t>());
            case 1:
                return use(column_.rows<std::int16_t>());
            case 2:
                return use(column_.rows<std::int32_t>());
            case 3:
                return use(column_.rows<std::int64_t>());
            case 4:
                return use(column_.rows<std::uint8_t>());
            case 5:
                return use(column_.rows<std::uint16_t>());
            case 6:
                return use(column_.rows<std::uint32_t>());
            default:
                return use(column_.rows<std::uint64_t>());
        }
    }

private:
    std::size_t type_ = 0;
    MappedColumn column_;
};

}  // namespace regather::trace
