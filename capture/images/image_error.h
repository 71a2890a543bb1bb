// capture/images/image_error.h -- how far an image is from a reference: RMSE, relative MSE (Rousselle, Knaus
// & Zwicker, "Adaptive Sampling and Reconstruction using Greedy Error Minimization", SIGGRAPH Asia 2011,
// section 3, epsilon 0.01) with and without its worst pixels, and MAPE. All are means over pixels and the
// three channels, each channel by itself:
//     RMSE    root of the mean of (x - r)^2               [W / (m^2 sr)]
//     relMSE  mean of (x - r)^2 / (r^2 + 0.01)
//     MAPE    mean of |x - r| / (|r| + 0.01)
// As published, 0.01 is in the unit of the image: in a scene far darker than 0.1 W / (m^2 sr) relMSE turns
// into 100 MSE.
#pragma once
#include <cstdint>
#include <vector>

#include "capture/images/image.h"

namespace regather::capture {

inline constexpr double relative_epsilon =
    0.01;  ///< Of relMSE [(W / (m^2 sr))^2] and of MAPE [W / (m^2 sr)].
inline constexpr std::uint32_t trimmed_share = 1000;  ///< relMSE without the worst pixel of so many.

struct ImageErrors {
    double rmse = 0;  ///< [W / (m^2 sr)]
    double rel_mse = 0;
    double rel_mse_trimmed =
        0;  ///< Without the ceil(pixels / 1000) pixels of the largest relMSE: fireflies do not decide.
    double mape = 0;  ///< 0.05 is 5 %.
};

/// trace::DataError when the sizes differ, when there are no pixels, or when a pixel is not finite.
ImageErrors image_errors(const Image& image, const Image& reference);

/// Throws as image_errors() does, for anything that compares two images. `what` names the first.
void check_comparable(const Image& image, const Image& reference, const char* what);

/// Mean of the three channels over all pixels [W / (m^2 sr)].
double mean_radiance(const Image& image);

}  // namespace regather::capture
