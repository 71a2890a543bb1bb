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

struct CaptureConfig {
    QueryConfig pixels;
    PhotonConfig photon;
    GatherConfig gather;
    Columns columns;
    /// Order of the searches within a batch of pixels; empty: capture order. It changes the time, not a bit of the result.
    std::function<std::vector<std::uint32_t>(const Queries&)> order;
    /// Told after each step: stage, steps done, steps in all.
    std::function<void(std::string_view stage, std::uint64_t done, std::uint64_t total)> progress;
};

struct Captured {
    Image image;
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
