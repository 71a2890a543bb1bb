// spatial/photons/hashed_grid.h -- cells of one size of which only those with photons are kept, in a hash
// table with open addressing (Teschner et al., "Optimized Spatial Hashing for Collision Detection of
// Deformable Objects", 2003, hash cells likewise; here entries hold their cell, so that photons of other
// cells are never read). A search goes out in shells of cells as spatial/photons/photon_grid.h does; before a
// shell of more cells than the table has entries it reads the table from end to end instead.
#pragma once
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "spatial/photons/photon_grid.h"

namespace regather::spatial {

/// Elements: the table's entries, of Region::directory; then the parts of the cells' photons, in the order of
/// the cells' entries, each below its entry.
class HashedGrid {
public:
    static constexpr std::uint32_t node_bytes =
        16;  ///< Of an entry: the cell, where its photons begin, how many they are.

    /// Cells small enough that those with photons hold `cell_photons` each or fewer, on average; or 2^20
    /// along the longest side. The table has 2 to 4 entries a cell. Otherwise as PhotonGrid.
    HashedGrid(std::span<const Photon> photons, std::uint32_t cell_photons, std::string name = "hashed");

    struct Entry {
        std::uint64_t cell = no_cell;  ///< Its number by planes().
        std::uint32_t first_part = 0, end_part = 0;
    };
    static constexpr std::uint64_t no_cell = ~std::uint64_t{0};

    std::shared_ptr<const Listed> share_structure() const { return structure_; }
    const PhotonParts& parts() const { return parts_; }
    std::uint32_t size() const { return parts_.size(); }
    const CellPlanes& planes() const { return planes_; }
    /// A power of two of them.
    std::span<const Entry> entries() const { return entries_; }
    /// Where a cell is looked for first; then come the entries behind it, and behind the last one the first.
    std::uint32_t home(std::uint64_t cell) const {
        return static_cast<std::uint32_t>(cell * 0x9E3779B97F4A7C15u >> shift_);
    }

private:
    CellPlanes planes_;
    PhotonParts parts_;
    std::vector<Entry> entries_;
    int shift_ = 63;
    std::shared_ptr<const Listed> structure_;
};

/// As of PhotonGrid. The listener is told every entry that is read on the way to a cell.
template <class Listener = Unheard>
void nearest(const HashedGrid& grid, Vec3 point, NearestSet& found, Listener&& listener = {}) {
    found.clear();
    if (grid.size() == 0 || !trace::is_finite(point)) return;
    const CellPlanes& planes = grid.planes();
    const std::span<const HashedGrid::Entry> entries = grid.entries();
    const auto count = static_cast<std::uint32_t>(entries.size());
    const auto read = [&](const HashedGrid::Entry& entry) {
        for (std::uint32_t part = entry.first_part; part < entry.end_part; ++part)
            grid.parts().read(part, count + part, point, found, listener);
    };
    planes.for_each_near(
        point, [&] { return found.bound2(); },
        [&](const CellPlace& place) {
            const std::uint64_t cell = planes.number(place);
            for (std::uint32_t at = grid.home(cell);; at = (at + 1) % count) {
                listener.visit(at);
                if (entries[at].cell == cell) read(entries[at]);
                if (entries[at].cell == cell || entries[at].cell == HashedGrid::no_cell) return;
            }
        },
        count,
        [&](std::uint32_t steps) {
            const CellPlace home = planes.cell_of(point);
            for (std::uint32_t at = 0; at < count; ++at) {
                listener.visit(at);
                if (entries[at].cell == HashedGrid::no_cell) continue;
                const CellPlace place = planes.place(entries[at].cell);
                std::uint32_t away = 0;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    away =
                        std::max(away, std::max(place[axis], home[axis]) - std::min(place[axis], home[axis]));
                if (away >= steps && planes.distance2(place, point) <= found.bound2()) read(entries[at]);
            }
        });
}

}  // namespace regather::spatial
