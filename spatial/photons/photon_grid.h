// spatial/photons/photon_grid.h -- a uniform grid over photons: an entry for each cell says where its photons
// lie. A search goes out in shells of cells (Bentley & Friedman, "Data Structures for Range Searching", 1979,
// section on cells) until none can hold a photon that is near enough.
#pragma once
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "spatial/listed.h"
#include "spatial/photons/cell_planes.h"
#include "spatial/photons/photon_parts.h"

namespace regather::spatial {

/// Elements: an entry of Region::directory for each cell, x first, then y and z; then the parts of the cells'
/// photons, each below its cell.
class PhotonGrid {
public:
    static constexpr std::uint32_t node_bytes = 8;  ///< Of an entry: where the cell's photons begin and end.

    /// So many cells as there are photons over `cell_photons`, or fewer; the i-th photon is node i of what a
    /// search finds. Throws as check_photons().
    PhotonGrid(std::span<const Photon> photons, std::uint32_t cell_photons, std::string name = "grid");

    std::shared_ptr<const Listed> share_structure() const { return structure_; }
    const PhotonParts& parts() const { return parts_; }
    std::uint32_t size() const { return parts_.size(); }
    const CellPlanes& planes() const { return planes_; }
    /// By cell, and one more: its first part.
    std::span<const std::uint32_t> first_part() const { return first_part_; }

private:
    CellPlanes planes_;
    PhotonParts parts_;
    std::vector<std::uint32_t> first_part_;
    std::shared_ptr<const Listed> structure_;
};

/// Fills `found` with the nearest photons of `point`: exact, equal distances by number. The listener is told
/// every entry that is read, empty or not, and every part.
template <class Listener = Unheard>
void nearest(const PhotonGrid& grid, Vec3 point, NearestSet& found, Listener&& listener = {}) {
    found.clear();
    if (grid.size() == 0 || !trace::is_finite(point)) return;
    const auto entries = static_cast<std::uint32_t>(grid.planes().cells());
    grid.planes().for_each_near(
        point, [&] { return found.bound2(); },
        [&](const CellPlace& place) {
            const auto cell = static_cast<std::uint32_t>(grid.planes().number(place));
            listener.visit(cell);
            for (std::uint32_t part = grid.first_part()[cell]; part < grid.first_part()[cell + 1]; ++part)
                grid.parts().read(part, entries + part, point, found, listener);
        },
        std::numeric_limits<std::uint64_t>::max(), [](std::uint32_t) {});
}

/// The structure of a directory of `entries` entries, numbered from 0, and parts behind them: `entry_of` has
/// the entry of each part.
std::shared_ptr<const Listed> directory_structure(std::string name, std::uint32_t entries,
                                                  std::span<const std::uint32_t> entry_of,
                                                  const PhotonParts& parts, std::uint32_t entry_bytes);

}  // namespace regather::spatial
