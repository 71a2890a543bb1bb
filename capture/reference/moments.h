// capture/reference/moments.h -- mean and spread of samples that come one by one (Welford, "Note on a method
// for calculating corrected sums of squares and products", 1962): the same bits however they are cut into
// runs.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace regather::capture {

/// Of samples of so many channels; how many there were is the caller's to know.
template <std::size_t channels>
struct MomentsOf {
    std::array<double, channels> mean{};
    std::array<double, channels> squares{};  ///< Sum of squared distances from the mean.

    /// `number` of samples with this one.
    void add(const std::array<double, channels>& sample, std::uint64_t number) {
        for (std::size_t c = 0; c < channels; ++c) {
            const double before = sample[c] - mean[c];
            mean[c] += before / static_cast<double>(number);
            squares[c] += before * (sample[c] - mean[c]);
        }
    }
    /// Of the mean, for one channel; 0 for fewer than two samples.
    double variance(std::size_t channel, std::uint64_t samples) const {
        if (samples < 2) return 0;
        const auto n = static_cast<double>(samples);
        return squares[channel] / ((n - 1) * n);
    }
    friend bool operator==(const MomentsOf&, const MomentsOf&) = default;
};

/// RGB of one pixel: a row of a reference's column of moments.
using Moments = MomentsOf<3>;
static_assert(sizeof(Moments) == 48);

}  // namespace regather::capture
