// capture/film.h -- where the light of all paths comes together: sums by pixel, layer and eye ray, in one
// fixed order.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "capture/gather_pass.h"
#include "capture/images/image.h"
#include "capture/query_pass.h"

namespace regather::capture {

/// The image by the light's last turns. `specular` is all that the eye sees by way of a specular surface; the
/// other three are seen straight: emitted or reflected once (direct), the caustic map, the global map. Their
/// sum is the image, to rounding.
struct Layers {
    std::array<Image, layer_names.size()> images;  ///< By Layer.
    std::vector<float> variance;  ///< Of the pixel's luminance, from its eye rays, photon maps held fixed;
                                  ///< empty for one eye ray.
    std::vector<std::uint32_t> query_count;  ///< Photon gathers a pixel, of both maps.

    /// All as channels of an EXR: "direct.R" ..., "variance.Y" where there is one, "queries.N".
    std::vector<Channel> channels() const;
    const Image& operator[](Layer layer) const { return images[static_cast<std::size_t>(layer)]; }
};

class Film {
public:
    Film(std::uint32_t width, std::uint32_t height, std::uint32_t samples);

    /// The next pixels in row order: as many as `work` has.
    void add(const PixelWork& work, const Gathered& gathered, const Gathered& caustics);

    const Nonfinite& nonfinite() const { return nonfinite_; }  ///< Estimates that were left out.

    Image image() const { return image_; }
    Layers layers() const { return layers_; }

private:
    using Sums = std::array<std::array<double, 3>, layer_names.size()>;

    std::uint32_t samples_;
    Image image_;
    Layers layers_;
    Nonfinite nonfinite_;
};

}  // namespace regather::capture
