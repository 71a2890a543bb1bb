// spatial/listed_columns.h -- the elements of a listed structure (spatial/listed.h) as columns:
// element_region, element_bytes, element_address, element_level and element_parent, a row an element.
// docs/bringing_walks.md.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "spatial/listed.h"
#include "trace/folder.h"

namespace regather::spatial {

inline constexpr std::uint32_t most_element_levels = 1 << 16;
inline constexpr std::uint32_t most_element_bytes = 1 << 24;

/// "0 photons, 2 other, 3 nodes": the regions that an element may be in.
std::string element_regions();

/// `region` by element, or empty. Throws trace::DataError that names the file in `folder`, the row, what was
/// found and what was expected: for a region that no element may be in; more than most_element_bytes bytes,
/// or bytes beyond the end of memory; a level from most_element_levels on, told or by parents; parents that
/// are no elements or lead in a circle; and, unless `overlaps`, bytes that two elements share.
void check_elements(const Listed::Elements& elements, std::span<const std::uint32_t> region, bool overlaps,
                    const std::filesystem::path& folder);

/// Writes the columns that are not empty, and element_region.
void store_elements(trace::TraceWriter& writer, const Listed& structure);

/// What the columns of a trace say, of Region::photons with tree_leaf_begin. Throws trace::DataError as
/// check_elements(), for regions that do not stand together, and for leaves that do not hold the trace's
/// photons. Elements may share bytes where trace.json's parameters have "overlaps": true.
Listed::Elements open_elements(trace::TraceReader& trace);

}  // namespace regather::spatial
