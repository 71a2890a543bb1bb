// reorder/catalogue.h -- the built-in orderings, in one table, and how a spec names one of them.
// A spec is "hilbert", "hilbert:tile=16,bits=16", a file made in NumPy: "file:keys.npy", or a user's library:
// "./libmine.so", "./libmine.so:any parameters".
#pragma once
#include <cstdint>
#include <filesystem>
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
    std::string name;  ///< "hilbert"; of a library, what it calls its ordering; of a file "file:NAME.npy".
    std::optional<std::uint32_t> tile;  ///< Edge [pixels]; none: the whole image, or no such parameter.
    std::optional<std::uint32_t> bins;  ///< Of an n x n grid of directions or strata: n.
    std::string text;  ///< All parameters, defaults too: "hilbert:tile=16,bits=16". A spec again,
                       ///< except that a library's and a file's is written by name instead of path.
};

struct ParsedOrdering {
    OrderingSpec spec;
    std::unique_ptr<Ordering> ordering;
};

/// "file:" before a path names a .npy file (reorder/key_file.h), relative to `folder`; it may be followed by
/// ",as=keys" or ",as=permutation", and by ",xxh3=" and the checksum that it must have. Another spec with '/'
/// in it, or ending in ".so" before its parameters, names a shared library (reorder/shared_library.h). Throws
/// trace::UsageError for unknown names and parameters (with the nearest and all known ones) and for values
/// out of range; trace::DataError for what is wrong in a .npy file.
ParsedOrdering parse_ordering(std::string_view spec, const std::filesystem::path& folder = {});

/// parse_ordering(spec).ordering
std::unique_ptr<Ordering> make_ordering(std::string_view spec);

}  // namespace regather::reorder
