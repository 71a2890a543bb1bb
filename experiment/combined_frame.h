// experiment/combined_frame.h -- the rays and the photon queries of one frame, each kind a trace, through one
// shared memory system in the order in which a renderer runs them, and apart.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/machines/machine.h"
#include "experiment/progress.h"
#include "reorder/ordering.h"
#include "results/frame_row.h"
#include "trace/json.h"

namespace regather::experiment {

struct CombinedFrame {
    /// In the order of their turns: eye, shadow, specular, gather rays, then what searches for photons.
    std::vector<std::filesystem::path> traces;
    std::vector<std::string> orderings;  ///< One for all traces, or one for each.
    std::vector<std::string> layouts;    ///< None: the default of each structure; else as orderings.
    std::vector<std::string> units;  ///< "pixel", "tile=N" (N pixels along an edge) or "frame"; each once.
    std::vector<cachesim::Machine> machines;
    std::uint64_t onchip_bytes = reorder::default_onchip_bytes;
};

struct FrameResult {
    std::vector<results::FrameRow> rows;
    std::string checksum;    ///< XXH3-64 over those of the traces in their order, in hexadecimal.
    trace::Json parameters;  ///< Of the traces, by part; with the renderer.
};

/// Unit by unit, machine by machine: all traces together, then each apart. A trace's queries run in its order
/// within a unit, together and apart. Traces whose structure and layout are the same share its memory; other
/// structures lie behind one another, each from a multiple of 4096 bytes on, together and apart. Throws
/// trace::UsageError for lists of other lengths, a unit that is none or there twice, two traces of one kind,
/// and as parse_orderings() and replay::make_layout(); trace::DataError for traces of more than one capture.
FrameResult run(const CombinedFrame& frame, const ProgressListener& progress);

/// A machine of one LRU cache, named as its spec: "131072:128:8".
cachesim::Machine machine_of(const cachesim::CacheConfig& cache);

}  // namespace regather::experiment
