// cli/capture_options.h -- what a capture can be asked for, from a command line or an experiment file.
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "capture/capture.h"

namespace CLI {
class App;
}

namespace regather::cli {

/// Defaults: the paper's Tables 1 and 2.
struct CaptureOptions {
    std::uint32_t width = 512, height = 512, gather_rays = 100, shadow_rays = 16, photons = 1'000'000, k = 100;
    double radius = 0;  ///< [scene units]; 0: unlimited
    std::uint64_t seed = 1;
    std::string gather_order = "hilbert";  ///< Of the searches within a batch of pixels; changes the time only.
    bool rays = true;                      ///< Store the rays, too.

    void add_to(CLI::App& app);
    /// Throws trace::UsageError for a value out of range or an unknown ordering.
    capture::CaptureConfig config() const;
};

/// The "capture" object of an experiment; `file` is for messages.
CaptureOptions capture_options(const nlohmann::json& object, const std::string& file);

}  // namespace regather::cli
