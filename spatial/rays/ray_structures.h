// spatial/rays/ray_structures.h -- the structures that rays are cast through, in one table, and how a spec
// names one of them: "ray-bvh", "bvh-4:leaf=2,stack=8". A trace of rays says by such a spec what its walks
// were taken in.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "spatial/rays/ray_bvh.h"
#include "spatial/rays/ray_tree.h"
#include "trace/folder.h"
#include "trace/parameters.h"

namespace regather::spatial {

struct RayStructureEntry {
    std::string_view name, summary;
    std::uint32_t version;  ///< Rises when walks of the same triangles and rays change.
    std::span<const trace::Parameter> parameters;
    std::uint32_t width;     ///< Children of a node at most.
    bool renderers = false;  ///< What the renderer casts through, as it is.
};

/// The one table of structures for rays.
std::span<const RayStructureEntry> ray_structures();

/// Whether a spec's name is one of theirs.
bool is_ray_structure(std::string_view spec);

/// What a spec asked for.
struct RayStructureSpec {
    const RayStructureEntry* entry;
    RayBvh::Shape shape;
    std::optional<std::uint32_t> stack_on_chip;
    std::string text;  ///< All parameters, defaults too; a spec again.
};
/// Throws trace::UsageError for an unknown name or parameter (with the nearest and all known ones) or a value
/// out of range.
RayStructureSpec parse_ray_structure(std::string_view spec);

/// Throws as RayBvh.
RayBvh build(const RayStructureSpec& spec, std::span<const trace::Vec3> vertices,
             std::span<const TriangleIndices> triangles);

/// `bvh` is build()'s; rays of kind "shadow" end at any hit.
std::shared_ptr<const RayTree> tree_of(const RayStructureSpec& spec, const RayBvh& bvh, bool any_hit);

/// Writes the columns that open_ray_structure() reads, and which triangle lies where.
void store(const RayTree& tree, const RayBvh& bvh, trace::TraceWriter& writer);

/// What the walks of a trace of rays were taken in; its reader outlives it. Throws trace::DataError for a
/// structure, a version or a kind of rays that this binary does not know, and for columns that are no tree.
std::shared_ptr<const Structure> open_ray_structure(trace::TraceReader& trace);

}  // namespace regather::spatial
