// experiment/experiment.h -- an experiment file: a scene, how to capture it, and the structures x layouts x
// orderings x parameters x caches to replay. Format: docs/experiments.md.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cachesim/cache.h"
#include "experiment/measurement.h"
#include "experiment/traces/capture_options.h"
#include "reorder/catalogue.h"

namespace regather::experiment {

/// One ordering with all its parameters, and the caches it is replayed through.
struct Trial {
    reorder::ParsedOrdering ordering;
    std::vector<cachesim::CacheConfig> caches;
    std::string library_digest;  ///< Of a user's shared library, else empty.
};

/// What the captured queries are searched in, and how it lies in memory when its walks are replayed.
struct Searched {
    std::string structure;             ///< All parameters; a spec of spatial/photons/structures.h again.
    std::vector<std::string> layouts;  ///< Likewise, of replay/layouts/catalogue.h; at least one.
};

struct Experiment {
    std::string scene;
    CaptureOptions capture;
    std::vector<Searched> searched;  ///< Multiplied out as the trials; at least one.
    std::vector<Trial> trials;  ///< Lists of parameter values are multiplied out, keys in alphabetical order,
                                ///< the last fastest.
    std::uint64_t onchip_bytes = reorder::default_onchip_bytes;
    Method method;
};

/// Throws trace::DataError (file, key, found, expected); bad orderings and caches included.
Experiment load_experiment(const std::filesystem::path& path);

/// What any of the trials' orderings looks at.
reorder::Reads reads(const Experiment& experiment);

}  // namespace regather::experiment
