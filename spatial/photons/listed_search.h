// spatial/photons/listed_search.h -- how structures with list walks (spatial/list_walk.h) stand in the table
// of structures: built over photons, stored with a trace, and opened again.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "spatial/photons/structures.h"

namespace regather::spatial {

/// Index: PhotonGrid, HashedGrid, PhotonOctree, PhotonBvh or BlockHashing. For rows of structures().
template <class Index>
std::unique_ptr<PhotonSearch> build_listed(std::span<const Photon> heap, const trace::Parameters& given,
                                           std::string text, std::uint32_t k, float radius);
template <class Index>
std::shared_ptr<const Structure> open_listed(trace::TraceReader& trace);

/// What other programs have walked.
std::shared_ptr<const Structure> open_brought(trace::TraceReader& trace);

}  // namespace regather::spatial
