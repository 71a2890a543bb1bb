#include "spatial/photons/photon_parts.h"

#include <fmt/format.h>

#include "trace/error.h"

namespace regather::spatial {

void check_photons(std::span<const Photon> photons) {
    if (photons.size() >= std::size_t{1} << 31)
        throw trace::DataError(fmt::format("photons: found {}, expected fewer than 2^31", photons.size()));
    for (std::size_t i = 0; i < photons.size(); ++i)
        if (!trace::is_finite(photons[i].position))
            throw trace::DataError(fmt::format("photon {}: found a position that is not finite", i));
}

}  // namespace regather::spatial
