#include "capture/record_error.h"

#include "capture/images/flip.h"
#include "capture/images/image_error.h"

namespace regather::capture {

RecordError record_error(const Image& image, const Image& whole, double farthest) {
    const double mean = mean_radiance(whole), share = mean > 0 ? 1 / mean : 0;
    return {.farthest = farthest,
            .relative_rmse = image_errors(image, whole).rmse * share,
            .relative_mean = (mean_radiance(image) - mean) * share,
            .flip = mean_flip(hdr_flip(image, whole))};
}

}  // namespace regather::capture
