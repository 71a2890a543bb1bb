// study/convergence.h -- error against run time: renders a setting with several seeds and tells seconds,
// errors against the reference, and bias and variance apart.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "capture/reference/reference.h"
#include "results/convergence_row.h"
#include "study/error_parts.h"
#include "study/ladder.h"

namespace regather::study {

struct ConvergenceConfig {
    std::uint32_t width = 64, height = 64;  ///< [pixels]
    std::uint32_t shadow_rays = 16;
    std::uint32_t seeds = 4;
    std::uint64_t first_seed = 1;
    double interior_radius = 0;  ///< [scene units]; 0: a twentieth of the box's diagonal.
};

capture::CaptureConfig capture_config(const Setting& setting, const ConvergenceConfig& config,
                                      std::uint64_t seed);

/// 1 for each pixel that counts for RMSE, bias and variance; 0 where the image, or a pixel beside, is
/// brighter than 10 times its median: lights, and their images in mirrors. Their edges, sampled by few eye
/// rays, would drown the error of all the rest.
std::vector<std::uint8_t> counted_pixels(const capture::Image& image);

Truth truth_of(const capture::Reference& reference);

/// Hexadecimal checksum of size, mean and variance.
std::string checksum(const Truth& truth);

struct Measured {
    results::ConvergenceRow row;
    capture::Image first;  ///< The image of the first seed.
};

class Convergence {
public:
    /// The scene outlives it. trace::DataError when the reference has another size.
    Convergence(const scenes::Scene& scene, Truth truth, const ConvergenceConfig& config);

    /// Renders config.seeds images. `told`: after each image, how many are done.
    Measured measure(const Setting& setting, const std::function<void(std::uint32_t)>& told = {}) const;

    /// Whether the row is of this scene, reference and configuration ...
    bool belongs(const results::ConvergenceRow& row) const;
    /// ... and has this setting: it need not be measured again.
    bool holds(const results::ConvergenceRow& row, const Setting& setting) const;

    const Truth& truth() const { return truth_; }
    double reference_rmse() const { return reference_rmse_; }  ///< Over the pixels that count.
    double mean_radiance() const;                              ///< Likewise.

private:
    void describe(results::ConvergenceRow& row, const Setting& setting) const;

    const scenes::Scene& scene_;
    Truth truth_;
    ConvergenceConfig config_;
    std::string truth_checksum_;
    std::vector<std::uint8_t> counted_, interior_;
    double reference_rmse_ = 0;
};

/// What a setting will take, learnt from those that were measured.
class CostModel {
public:
    CostModel(std::uint64_t pixels, std::uint32_t seeds) : pixels_(pixels), seeds_(seeds) {}
    /// All seeds [s].
    double seconds(const Setting& setting) const;
    /// `elapsed`: wall clock of all seeds and their analysis [s].
    void learn(const Setting& setting, const results::ConvergenceRow& row, double elapsed);

private:
    double photon_work(const Setting& setting) const;
    double render_work(const Setting& setting) const;
    std::uint64_t pixels_;
    std::uint32_t seeds_;
    // Guesses until the first measurement [s]: a photon, a photon looked at in a gather, the analysis of a
    // pixel.
    double photon_seconds_ = 3e-6, render_seconds_ = 5e-8, analysis_seconds_ = 2e-5;
};

struct LadderRun {
    std::span<const Setting> settings;
    std::span<const results::ConvergenceRow> known;  ///< Not measured again.
    double seconds = 120;
    /// Told before and while a setting is rendered: it, and the share of the predicted time that has passed.
    std::function<void(const Setting&, double share)> progress;
    std::function<void(const Setting&, const Measured&)> measured;
};

/// In rising cost, as long as the next setting is predicted to fit into the time left. Returns those that did
/// not.
std::vector<Setting> run(const Convergence& convergence, const ConvergenceConfig& config,
                         const LadderRun& ladder);

}  // namespace regather::study
