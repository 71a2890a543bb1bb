// capture/images/flip.h -- FLIP, the difference that a viewer sees when two images alternate on one screen.
// LDR: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020. HDR: Andersson, Nilsson, Shirley, Akenine-Moller, "Visualizing Errors in
// Rendered High Dynamic Range Images", Eurographics 2021 short papers, with the ACES curve. Constants as
// published: q_c 0.7, q_f 0.5, p_c 0.4, p_t 0.95, w 0.082 degrees. Borders repeat the outermost pixel.
#pragma once
#include <vector>

#include "capture/images/image.h"

namespace regather::capture {

/// A monitor 0.7 m wide with 3840 pixels, seen from 0.7 m: 0.7 * 3840 / 0.7 * pi / 180.
inline constexpr double default_pixels_per_degree = 67.02064327658226;

/// One value a pixel, 0: no difference, 1: the most. Images are linear RGB and are clamped to [0, 1].
/// Symmetric. trace::DataError as image_errors() throws it.
std::vector<float> ldr_flip(const Image& image, const Image& reference,
                            double pixels_per_degree = default_pixels_per_degree);

struct Exposures {
    double start = 0, stop = 0;  ///< [stops, powers of 2]
    unsigned count = 0;
};

/// From the exposure that takes the brightest luminance to 0.85 on the ACES curve to the one that takes the
/// median there; a median of 0, which the paper leaves open, is replaced by the least luminance above 0. A
/// black image has one, 0.
Exposures flip_exposures(const Image& reference);

/// The maximum of LDR-FLIP over the exposures. Linear RGB radiance, negative values count as 0. Not
/// symmetric: the reference sets the exposures.
std::vector<float> hdr_flip(const Image& image, const Image& reference,
                            double pixels_per_degree = default_pixels_per_degree);

/// The mean of a map, as the authors report it.
double mean_flip(const std::vector<float>& map);

}  // namespace regather::capture
