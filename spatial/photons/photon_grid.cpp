#include "spatial/photons/photon_grid.h"

#include <algorithm>
#include <numeric>

namespace regather::spatial {
namespace {

trace::Bounds3 checked_bounds(std::span<const Photon> photons) {
    check_photons(photons);
    trace::Bounds3 box;
    for (const Photon& photon : photons) box.include(photon.position);
    return box;
}

CellPlanes planes_over(std::span<const Photon> photons, std::uint32_t cell_photons) {
    const trace::Bounds3 box = checked_bounds(photons);
    return {box, cells_along(box, std::max<std::uint64_t>(1, photons.size() / cell_photons))};
}

}  // namespace

std::shared_ptr<const Listed> directory_structure(std::string name, std::uint32_t entries,
                                                  std::span<const std::uint32_t> entry_of,
                                                  const PhotonParts& parts, std::uint32_t bytes) {
    Listed::Elements elements;
    if (parts.count() > 0) {
        elements.ranges = {{trace::Region::photons, entries, parts.count()}};
        if (entries > 0)
            elements.ranges.insert(elements.ranges.begin(), {trace::Region::directory, 0, entries});
        elements.parent.resize(entries);
        std::iota(elements.parent.begin(), elements.parent.end(), 0u);
        elements.parent.insert(elements.parent.end(), entry_of.begin(), entry_of.end());
    }
    elements.record_begin.assign(parts.begin().begin(), parts.begin().end());
    elements.node_bytes = bytes;
    return std::make_shared<Listed>(std::move(name), std::move(elements));
}

PhotonGrid::PhotonGrid(std::span<const Photon> photons, std::uint32_t cell_photons, std::string name)
    : planes_(planes_over(photons, cell_photons)) {
    const auto cells = static_cast<std::uint32_t>(planes_.cells());
    std::vector<std::uint32_t> begin(cells + 1), cell_of(photons.size()), photon_at(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i) {
        cell_of[i] = static_cast<std::uint32_t>(planes_.number(planes_.cell_of(photons[i].position)));
        ++begin[cell_of[i] + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t i = 0; i < photons.size(); ++i) photon_at[next[cell_of[i]]++] = i;

    std::vector<std::uint32_t> entry_of;
    first_part_.push_back(0);
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
        parts_.add(std::span(photon_at).subspan(begin[cell], begin[cell + 1] - begin[cell]), photons);
        entry_of.resize(parts_.count(), cell);
        first_part_.push_back(parts_.count());
    }
    structure_ =
        directory_structure(std::move(name), photons.empty() ? 0 : cells, entry_of, parts_, node_bytes);
}

}  // namespace regather::spatial
