// results/geometry.h -- the shape of a cache as people write and read it, and bytes in units that fit a cell.
// Cache sizes are powers of two and get KiB, MiB; traffic gets decimal units (1 GB = 1e9 bytes), as in the
// paper.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "results/row.h"

namespace regather::results {

struct Geometry {
    std::uint64_t cache_bytes = 128 * 1024;
    std::uint64_t line_bytes = 128;
    std::uint64_t ways = 8;  ///< 0: fully associative.
    friend bool operator==(const Geometry&, const Geometry&) = default;
};

/// "128K:128:8" or "1M:64:full"; K and M are powers of 1024. Throws trace::UsageError.
Geometry parse_geometry(std::string_view text);

/// "128 KiB, 128 B lines, 8-way".
std::string geometry_text(const Geometry& geometry);

/// The same without the size.
std::string shape_text(const Geometry& geometry);

/// Nothing for a row without a cache.
std::optional<Geometry> geometry_of(const Row& row);

/// The one with most rows; of equals the paper's (128 KiB, 128 B, 8-way), else the first. Nothing without
/// rows.
std::optional<Geometry> commonest_geometry(std::span<const Row> rows);

std::string binary_bytes(std::uint64_t bytes);   ///< "128 KiB", "1.5 MiB"
std::string decimal_bytes(std::uint64_t bytes);  ///< "211 GB", "36.0 GB", "1.23 MB", "512 B"
std::string decimal_count(double count);         ///< "26.2 M", "512"

/// The decimal unit in which `most` bytes are at least 1.
struct ByteUnit {
    const char* name;
    double bytes;
};
ByteUnit byte_unit(double most);

/// The parts that are not empty, with `separator` between them.
std::string joined(std::span<const std::string> parts, std::string_view separator);

}  // namespace regather::results
