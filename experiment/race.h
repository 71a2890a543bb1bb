// experiment/race.h -- runs the real searches of a trace's queries on this machine, in several orderings
// and structures, and takes the time. A repeat runs every ordering once: it is made, then all structures are
// searched in it. So a drift of the machine's speed meets all alike; and each repeat begins with another
// ordering.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "reorder/catalogue.h"
#include "trace/photon.h"

namespace regather::experiment {

enum class Structure {
    left_balanced,
    bucketed
};  ///< spatial/photons/nearest.h, spatial/photons/photon_buckets.h
inline constexpr Structure structures[] = {Structure::left_balanced, Structure::bucketed};
std::string_view name(Structure structure);
std::optional<Structure> structure_named(std::string_view word);

/// Of repeated measurements [s]. The median of an even number is the mean of the middle two; mad is the
/// median absolute deviation from the median.
struct Timing {
    double median = 0, min = 0, max = 0, mad = 0;
};
Timing timing_of(std::vector<double> seconds);

struct RaceConfig {
    std::uint32_t k = 100;
    float radius = std::numeric_limits<float>::infinity();  ///< Of a search [scene units].
    std::uint32_t repeats = 11, threads = 1;                ///< At least 1. Threads make orderings, too.
    bool gathered = false;  ///< Copy the positions into the order first; its time is the ordering's.
    std::vector<Structure> structures;
};

/// One ordering on one structure.
struct Standing {
    std::size_t ordering;  ///< Index into the orderings that ran.
    Structure structure;
    Timing order;   ///< Keys, sort and, if asked for, the copy. 0 for the baseline, which needs none of them.
    Timing search;  ///< All queries.
    double net_gain = 0;  ///< [s] Median over the repeats of: baseline's search - (search + order).
};

struct Race {
    std::vector<Standing> standings;  ///< Ordering by ordering, structure by structure.
    std::uint64_t found_photons = 0;  ///< By all queries; the same in every run.
};

/// `heap`: photons of a left-balanced tree. The baseline is `orderings[baseline]`, which must be the capture
/// order. `progress` is told the queries searched of all. Throws std::runtime_error that names ordering and
/// query when two runs find other photons for the same query.
Race race(std::span<const trace::Photon> heap, const reorder::Workload& work,
          std::span<const reorder::ParsedOrdering> orderings, std::size_t baseline, const RaceConfig& config,
          const std::function<void(std::uint64_t done, std::uint64_t total)>& progress);

}  // namespace regather::experiment
