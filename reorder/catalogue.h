// reorder/catalogue.h -- the built-in orderings, in one table, and how a spec names one of them.
// A spec is "hilbert", "hilbert:tile=16,bits=16", or a user's library: "./libmine.so", "./libmine.so:any
// parameters".
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "reorder/ordering.h"
#include "trace/parameters.h"

namespace regather::reorder {

using trace::Parameter, trace::Parameters;

struct Entry {
    std::string_view name;
    std::string_view summary;
    std::span<const Parameter> parameters;
    std::unique_ptr<Ordering> (*make)(Parameters& parameters);
};

/// The one table of orderings.
std::span<const Entry> catalogue();

/// What a spec asked for, as the result files tell it.
struct OrderingSpec {
    std::string name;                   ///< "hilbert"; of a library, what it calls its ordering.
    std::optional<std::uint32_t> tile;  ///< Edge [pixels]; none: the whole image, or no such parameter.
    std::optional<std::uint32_t> bins;  ///< Of an n x n grid of directions: n.
    std::string text;  ///< All parameters, defaults too: "hilbert:tile=16,bits=16". A spec again,
                       ///< except that a library's is written by name instead of path.
};

struct ParsedOrdering {
    OrderingSpec spec;
    std::unique_ptr<Ordering> ordering;
};

/// A spec with '/' in it, or ending in ".so" before its parameters, names a shared library
/// (reorder/shared_library.h). Throws trace::UsageError for unknown names and parameters (with the nearest
/// and all known ones) and for values out of range.
ParsedOrdering parse_ordering(std::string_view spec);

/// parse_ordering(spec).ordering
std::unique_ptr<Ordering> make_ordering(std::string_view spec);

}  // namespace regather::reorder
