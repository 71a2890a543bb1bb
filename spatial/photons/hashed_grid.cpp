#include "spatial/photons/hashed_grid.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace regather::spatial {
namespace {

constexpr std::uint32_t most_cells_along = 1u << 20;

std::vector<std::uint64_t> cells_of(const CellPlanes& planes, std::span<const Photon> photons) {
    std::vector<std::uint64_t> cells(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i)
        cells[i] = planes.number(planes.cell_of(photons[i].position));
    return cells;
}

std::size_t different(std::vector<std::uint64_t> cells) {
    std::sort(cells.begin(), cells.end());
    return static_cast<std::size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
}

CellPlanes planes_over(std::span<const Photon> photons, std::uint32_t cell_photons) {
    check_photons(photons);
    trace::Bounds3 box;
    for (const Photon& photon : photons) box.include(photon.position);
    const Vec3 side = box.extent();
    const std::uint64_t wanted = (photons.size() + cell_photons - 1) / cell_photons;
    std::uint32_t along = cells_along(box, std::max<std::uint64_t>(1, wanted));
    if (side.x == 0 && side.y == 0 && side.z == 0) along = most_cells_along;
    // A quarter more along each axis until enough of the cells hold photons.
    while (along < most_cells_along && different(cells_of({box, along}, photons)) < wanted)
        along = std::min(most_cells_along, std::max(along + 1, along / 4 * 5));
    return {box, along};
}

}  // namespace

HashedGrid::HashedGrid(std::span<const Photon> photons, std::uint32_t cell_photons, std::string name)
    : planes_(planes_over(photons, cell_photons)) {
    const std::vector<std::uint64_t> cell = cells_of(planes_, photons);
    std::vector<std::uint32_t> by_cell(photons.size());
    std::iota(by_cell.begin(), by_cell.end(), 0u);
    std::sort(by_cell.begin(), by_cell.end(), [&](std::uint32_t a, std::uint32_t b) {
        return cell[a] < cell[b] || (cell[a] == cell[b] && a < b);
    });
    // Photons of the entries, by cell.
    struct Bucket {
        std::uint32_t begin, end;
    };
    std::vector<Bucket> buckets;
    for (std::uint32_t i = 0; i < by_cell.size(); ++i) {
        if (i == 0 || cell[by_cell[i]] != cell[by_cell[i - 1]]) buckets.push_back({i, i});
        buckets.back().end = i + 1;
    }
    entries_.resize(std::bit_ceil(std::max<std::size_t>(2, 2 * buckets.size())));
    shift_ = 64 - std::countr_zero(entries_.size());
    std::vector<std::uint32_t> bucket_at(entries_.size());
    for (std::uint32_t b = 0; b < buckets.size(); ++b) {
        const std::uint64_t own = cell[by_cell[buckets[b].begin]];
        std::size_t at = home(own);
        while (entries_[at].cell != no_cell) at = (at + 1) % entries_.size();
        entries_[at].cell = own;
        bucket_at[at] = b;
    }
    std::vector<std::uint32_t> entry_of;
    for (std::uint32_t at = 0; at < entries_.size(); ++at) {
        if (entries_[at].cell == no_cell) continue;
        const Bucket& bucket = buckets[bucket_at[at]];
        entries_[at].first_part = parts_.count();
        parts_.add(std::span(by_cell).subspan(bucket.begin, bucket.end - bucket.begin), photons);
        entries_[at].end_part = parts_.count();
        entry_of.resize(parts_.count(), at);
    }
    structure_ = directory_structure(std::move(name),
                                     photons.empty() ? 0 : static_cast<std::uint32_t>(entries_.size()),
                                     entry_of, parts_, node_bytes);
}

}  // namespace regather::spatial
