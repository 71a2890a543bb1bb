// replay/layouts/catalogue.h -- the layouts in two tables: in which order memory holds the elements, and what
// a record of one is. A spec names one of each and parameters: "heap-20", "van-emde-boas-32",
// "clusters-20:line=64", "depth-first-20:top=8".
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "replay/layout.h"
#include "trace/parameters.h"
#include "trace/vec.h"

namespace regather::replay {

struct LayoutOrder {
    std::string_view name, summary;
};
std::span<const LayoutOrder> layout_orders();

/// A photon in memory.
struct PhotonRecord {
    std::string_view name, summary;
    std::uint32_t stride_bytes, used_bytes;  ///< From one photon to the next; what a visit reads.
    std::uint32_t apart_bytes = 0;           ///< Elsewhere, read of the photons found.
    bool tells_axis = true;                  ///< By which axis it splits, where photons are inner nodes.
};
std::span<const PhotonRecord> photon_records();

/// A triangle in memory, of a structure that rays are cast through.
struct TriangleRecord {
    std::string_view name, summary;
    std::uint32_t bytes;
};
std::span<const TriangleRecord> triangle_records();
/// An entry of a ray's stack: a child, and how far ahead the ray enters it.
inline constexpr std::uint32_t stack_entry_bytes = 8;

std::span<const trace::Parameter> layout_parameters();

/// The layout that a spec names. The regions of a structure follow one another in the order of its ranges,
/// each from a multiple of 4096 on, the first from 0; what photons have apart lies in the order of the
/// photons. Parameters: `line` [bytes], a power of two, for clusters (128); `top`, so many levels from the
/// root are kept on chip and read nothing (0); `node` [bytes] of an inner node. A structure for rays has
/// records of triangles, and nodes of what their children's boxes take (spatial::RayTree::node_bytes()) or
/// more. Throws trace::UsageError for an unknown word (with the nearest and all known ones), a value out of
/// range, and a record that does not suit the structure. `positions` of the records, by number: what orders
/// along a curve want; without, those are refused.
Layout make_layout(std::string_view spec, const spatial::Structure& structure,
                   std::span<const trace::Vec3> positions = {});

/// Where elements lie when nobody chooses: heap-20, the paper's; of a structure for rays, depth-first-48.
Layout usual_layout(const spatial::Structure& structure);

}  // namespace regather::replay
