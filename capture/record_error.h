// capture/record_error.h -- what photon records of fewer bytes cost a picture: it beside the same picture
// from whole records, with the same rays, queries and paths of photons.
#pragma once
#include <array>
#include <cstdint>

#include "capture/images/image.h"

namespace regather::capture {

/// What a photon is stored in.
enum class PhotonRecord : std::uint8_t {
    whole,   ///< 20 bytes: trace/photon.h.
    packed,  ///< 16 bytes: trace/packed_photon.h.
};
inline constexpr std::array<const char*, 2> photon_record_names{"20", "16"};

struct RecordError {
    double farthest = 0;  ///< How far a photon moved at most, of both maps [scene units].
    double relative_rmse =
        0;  ///< RMSE (capture/images/image_error.h) by the mean radiance from whole records.
    double relative_mean = 0;  ///< By how much the mean radiance is more than from whole records, as a share.
    double flip = 0;           ///< Mean of HDR-FLIP (capture/images/flip.h).
};

/// Of an image against that from whole records, of the same size and finite. Of black ones all is 0.
RecordError record_error(const Image& image, const Image& whole, double farthest);

}  // namespace regather::capture
