// experiment/traces/capture_options.h -- what a capture can be asked for, from a command line or an
// experiment file.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capture/capture.h"

namespace regather::trace {
class Field;
}

namespace regather::experiment {

inline constexpr std::uint32_t most_pixels = 32768;  ///< Width or height of an image.
inline constexpr std::uint32_t most_photons = (1u << 31) - 1, most_samples = 1u << 16, most_rays = 1u << 20;

/// Defaults: the paper's Tables 1 and 2.
struct CaptureOptions {
    std::uint32_t width = 512, height = 512, samples = 1, gather_rays = 100, shadow_rays = 16,
                  photons = 1'000'000, k = 100;
    double radius = 0;  ///< [scene units]; 0 or infinity: unlimited
    std::string mode = "final-gather",
                filter = "none";                      ///< capture::visualisation_names, capture::filter_names
    std::string sampling{capture::default_sampling};  ///< Of gather rays, a spec.
    std::string irradiance_cache;  ///< A spec of capture/irradiance/irradiance_metric.h; empty: none.
    bool surface_check = true;
    std::uint32_t caustic_photons = 100'000, caustic_k = 60;
    double caustic_radius = 0;  ///< [scene units]; 0 or infinity: unlimited
    std::string caustic_filter = "cone";
    std::string photon_record = "20";    ///< capture::photon_record_names [bytes]
    std::uint32_t precompute_every = 0;  ///< CaptureConfig::precompute_every.
    std::uint32_t reverse_pixels = 0;    ///< CaptureConfig::reverse_pixels.
    std::vector<std::string> keep;       ///< Parts that the scene has no need of.
    std::string frames;   ///< Of the camera path, as of experiment/frames.h; empty: the standing camera.
    double exposure = 0;  ///< Of image.png [1 / radiance]; 0: by the image's mean.
    std::string tone = "exponential";
    std::uint64_t seed = 1;
    std::string gather_order =
        "hilbert";     ///< Of the searches within a batch of pixels; changes the time only.
    bool rays = true;  ///< Store the rays, too.

    /// Throws trace::UsageError for a value out of range or an unknown ordering.
    capture::CaptureConfig config() const;
    capture::Tone tone_curve() const;  ///< Throws as config().
};

/// One of the options: a key of an experiment's "capture" object, and of a command line with dashes
/// ("gather_rays", "--gather-rays"); what is true by default is denied there ("--no-rays").
struct CaptureKey {
    std::string_view name;
    std::variant<std::uint32_t CaptureOptions::*, std::uint64_t CaptureOptions::*, double CaptureOptions::*,
                 bool CaptureOptions::*, std::string CaptureOptions::*,
                 std::vector<std::string> CaptureOptions::*>
        value;
    std::string_view help;  ///< Of a truth: of its denial.
    std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();  ///< Of a whole number.
    std::span<const char* const> words = {};  ///< Of a text that is one of some.
    bool infinite = false;                    ///< A number that may be infinity; none is below 0.
};
/// The one table of them.
std::span<const CaptureKey> capture_keys();

/// Keys that have no effect beside the value of another: to be refused where they are given.
struct IdleKeys {
    std::vector<std::string_view> keys;
    std::string_view beside, value, reason;  ///< "mode", "direct", "casts no such rays".
};
std::vector<IdleKeys> idle_keys(const CaptureOptions& options);

/// The "capture" object of an experiment. Throws trace::DataError.
CaptureOptions capture_options(const trace::Field& object);

}  // namespace regather::experiment
