// capture/capture.h -- scene in, image and trace out: the photon pass, the tree, and the pixels batch by batch.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/gather_pass.h"
#include "capture/image.h"
#include "capture/photon_pass.h"
#include "capture/query_pass.h"
#include "trace/folder.h"

namespace regather::capture {

/// Which optional columns are stored.
struct Columns {
    bool rays = true, direction = true, leaf_kd = true, leaf_bvh = true;
};
// Ray columns of kinds that the scene has no need of (scenes/needs.h) are left out in any case.

/// The caustic map: photons that specular surfaces, and nothing else, have turned between light and store (Jensen 2001,
/// section 9.1: LS+D paths), gathered at every eye-visible surface. Not built for a scene without need of it.
struct CausticConfig {
    std::uint32_t photons = 200'000, k = 60;
    float radius = std::numeric_limits<float>::infinity();  ///< [scene units]
    Filter filter = Filter::cone;
};

struct CaptureConfig {
    QueryConfig pixels;
    PhotonConfig photon;
    GatherConfig gather;
    CausticConfig caustic;
    Columns columns;
    /// Order of the searches within a batch of pixels; empty: capture order. It changes the time, not a bit of the result.
    std::function<std::vector<std::uint32_t>(const Queries&)> order;
    /// Told after each step: stage, steps done, steps in all.
    std::function<void(std::string_view stage, std::uint64_t done, std::uint64_t total)> progress;
};

/// The image by the light's last turns. `specular` is all that the eye sees by way of a specular surface; the other three are
/// seen straight: emitted or reflected once (direct), the caustic map, the global map. Their sum is the image.
struct Layers {
    Image direct, caustic, indirect, specular;
    std::vector<float> variance;             ///< Of the pixel's mean luminance, from its eye rays; empty when there is only one.
    std::vector<std::uint32_t> query_count;  ///< Photon gathers a pixel.
};

struct Captured {
    Image image;
    Layers layers;
    trace::TraceInfo info;
    double photon_seconds = 0, tree_seconds = 0, query_seconds = 0, gather_seconds = 0, write_seconds = 0;
    std::uint64_t nonfinite_pixels = 0;  ///< Set to black and counted.
};

/// XXH3-64 over everything in the scene that light can see, in hexadecimal.
std::string checksum(const Scene& scene);

/// What a capture's trace.json says under "parameters": two captures with equal parameters have equal columns.
nlohmann::json parameters(const Scene& scene, const CaptureConfig& config);

/// Renders and, when `writer` is not null, writes the columns; the caller finishes the writer with Captured::info when all else
/// that belongs to the capture is written. UsageError for a picture without pixels or of 2^32 queries or more.
Captured capture(const Scene& scene, const CaptureConfig& config, trace::TraceWriter* writer);

}  // namespace regather::capture
