// capture/capture.h -- scene in, image and trace out: the photon pass, the tree, and the pixels batch by
// batch.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/beside.h"
#include "capture/film.h"
#include "capture/gather_pass.h"
#include "capture/images/image.h"
#include "capture/irradiance/waiting_pixels.h"
#include "capture/photon_pass.h"
#include "capture/query_pass.h"
#include "capture/record_error.h"
#include "capture/trace_columns.h"
#include "trace/folder.h"

namespace regather::capture {

/// The caustic map: photons that specular surfaces, and nothing else, have turned between light and store
/// (Jensen 2001, section 9.1: LS+D paths), gathered at every eye-visible surface. Not built for a scene
/// without need of it.
struct CausticConfig {
    std::uint32_t photons = 100'000, k = 60;
    float radius = std::numeric_limits<float>::infinity();  ///< [scene units]
    Filter filter = Filter::cone;
};

struct CaptureConfig {
    QueryConfig pixels;
    PhotonConfig photon;
    GatherConfig gather;
    CausticConfig caustic;
    /// What the photons of both maps are stored in. Packed ones are searched, seen and written where their
    /// records say that they are; rays, queries and paths of photons stay as they are.
    PhotonRecord record = PhotonRecord::whole;
    /// Irradiance is precomputed at every so many photons of the global map, and what would be gathered from
    /// them is read (baselines/precomputed_irradiance.h). 0: it is gathered.
    std::uint32_t precompute_every = 0;
    /// Photons search the hit points of so many pixels at a time, and light those that they reach
    /// (baselines/reverse_gather.h). 0: hit points search photons.
    std::uint32_t reverse_pixels = 0;
    Columns columns;
    std::set<std::string> keep;  ///< Parts that the scene has no need of (scenes/needs.h), kept all the same.
    std::optional<std::uint32_t>
        frame;  ///< Of the camera path, for trace.json; the scene's camera is where it looks from.
    /// fingerprint() of the scene, for trace.json; empty: left out there.
    std::string renderer;
    /// Order of the searches within a batch of pixels; empty: capture order. It changes the time, not a bit
    /// of the result.
    std::function<std::vector<std::uint32_t>(const Queries&)> order;
    /// Told after each step: stage, steps done, steps in all.
    std::function<void(std::string_view stage, std::uint64_t done, std::uint64_t total)> progress;
};

/// What an irradiance cache did.
struct IrradianceTally {
    std::uint64_t records = 0, octree_bytes = 0;
    std::uint64_t rays = 0, queries = 0;     ///< Gather rays and searches that records were made of.
    double scatter = 0, scatter_of_all = 0;  ///< gather_scatter() with the records, and without.
    WaitingPixels waiting;
    IrradianceUse use;
};

struct Captured {
    Image image;
    Layers layers;
    trace::TraceInfo info;
    OfBeside<std::optional<trace::TraceInfo>> beside;  ///< Of those that were written.
    double photon_seconds = 0, tree_seconds = 0, query_seconds = 0, gather_seconds = 0, write_seconds = 0;
    Nonfinite nonfinite;                        ///< What was left out of the image and the maps.
    std::optional<IrradianceTally> irradiance;  ///< Where there is an irradiance cache.
    std::optional<RecordError> record_error;    ///< Of packed photons: against the image from whole ones.
};

/// XXH3-64 over everything in the scene that light can see, in hexadecimal.
std::string checksum(const Scene& scene);

/// What a capture's trace.json says under "parameters": two captures with equal parameters have equal
/// columns.
trace::Json parameters(const Scene& scene, const CaptureConfig& config);

/// Whether a capture builds a caustic map: the scene needs one or is made to keep one, and its photons are
/// asked for. Without it, gather rays find what lights send by way of specular surfaces.
bool has_caustic_map(const Scene& scene, const CaptureConfig& config);

/// Whether the directions of gather rays are chosen by searches of the global map.
bool has_guide(const CaptureConfig& config);

/// Whether photons are searched at photons, for the irradiance there or for how far they reach.
bool has_precomputation(const CaptureConfig& config);

/// Whether diffuse points have their gathered light from records of irradiance: that is asked for, and there
/// are gather rays.
bool has_irradiance_cache(const CaptureConfig& config);

/// Whether a capture has that trace beside the gathers' own.
bool has(Beside trace, const Scene& scene, const CaptureConfig& config);

/// Where the columns go; null: nowhere.
struct TraceWriters {
    trace::TraceWriter* global = nullptr;
    OfBeside<trace::TraceWriter*> beside{};
};

/// Renders, and writes columns; the caller finishes the writers with Captured's info and beside when all else
/// that belongs to the capture is written. UsageError for a picture without pixels or of 2^32 queries or
/// more.
Captured capture(const Scene& scene, const CaptureConfig& config, const TraceWriters& writers = {});

}  // namespace regather::capture
