// replay/layouts/placement.h -- in which order memory holds the elements of a structure.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "spatial/structure.h"
#include "trace/vec.h"

namespace regather::replay {

/// Every element of a structure once, but for those of Region::photon_power, which follow their photons.
/// Those of a group stand together: a group that fits into a line lies on one.
struct Placement {
    std::vector<std::uint32_t> elements;
    std::vector<std::uint32_t> group_begins;  ///< Places in `elements`, ascending; empty: nothing is grouped.
};

/// By number: a left-balanced tree's is the heap.
Placement heap_order(const spatial::Structure& structure);

/// Each element before those below it, subtree by subtree.
Placement depth_first_order(const spatial::Structure& structure);

/// Level by level.
Placement breadth_first_order(const spatial::Structure& structure);

/// The upper half of the levels, then each subtree below it, both again in this order (Prokop,
/// "Cache-Oblivious Algorithms", 1999, section 2 on trees by van Emde Boas's scheme).
Placement van_emde_boas_order(const spatial::Structure& structure);

/// Groups that fill a line: from a root on, level by level, as many elements as fit; what hangs below them
/// begins groups of its own (Alstrup et al., "Efficient Tree Layout in a Multilevel Memory Hierarchy", 2002,
/// cut trees likewise). bytes(e) is what element e takes in memory.
Placement clustered_order(const spatial::Structure& structure, std::uint32_t line_bytes,
                          const std::function<std::uint32_t(std::uint32_t)>& bytes);

enum class SpaceCurve : std::uint8_t { morton, hilbert };

/// Elements that hold photons along a curve through 2^21 cells an axis over the photons, by the middle of the
/// box of each one's photons (equal codes: by number); the other elements before them, depth first.
/// `positions` by record.
Placement curve_order(const spatial::Structure& structure, std::span<const trace::Vec3> positions,
                      SpaceCurve curve);

/// Where the program that was walked had each element, by element; only for a structure that tells it. Gaps
/// are shortened by multiples of gap_stretch to less than twice that: so a table of all lines in between can
/// be held, no two elements come to share a line, and the sets of a cache whose sets hold up to gap_stretch
/// bytes with one way are as they were.
std::vector<std::uint64_t> given_addresses(const spatial::Structure& structure);
inline constexpr std::uint64_t gap_stretch = std::uint64_t{1} << 28;

}  // namespace regather::replay
