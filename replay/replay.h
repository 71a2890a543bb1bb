// replay/replay.h -- runs recorded walks in an order: walks -> elements -> bytes -> lines -> caches. Nothing
// is searched.
//
// All LRU caches of one line size come from one pass (cachesim/lru/lru_family.h), and of a walk's touches
// only the first of each line are simulated for an order: how deep the others lie does not depend on what ran
// before the walk, so they are counted once for all orders (count_revisits()).
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/lru/lru_family.h"
#include "replay/layout.h"
#include "replay/walk_store.h"

namespace regather::replay {

class FirstTouches;

using QueriesDone = std::function<void(std::uint64_t)>;

/// Misses by class: Hill, "Aspects of Cache Memory and Instruction Buffer Performance", 1987. First touches
/// of a line; others that a fully associative LRU cache of the same size misses, too; the rest.
struct MissClasses {
    std::uint64_t compulsory = 0, capacity = 0, conflict = 0;
    friend bool operator==(const MissClasses&, const MissClasses&) = default;
};

/// How far a count from a sample of the sets may lie from the truth.
struct SampleError {
    std::uint64_t sampled_sets = 0;
    double standard_error = 0;
    std::uint64_t low = 0, high = 0;  ///< 95 % confidence interval.
};

/// What went through one cache.
struct CacheTraffic {
    cachesim::CacheConfig config;
    std::uint64_t accesses = 0;       ///< Line accesses; an element on two lines makes two.
    std::uint64_t misses = 0;         ///< An estimate when there is a SampleError.
    std::uint64_t traffic_bytes = 0;  ///< misses x line_bytes: a replay only reads.
    std::optional<MissClasses> classes;
    std::optional<SampleError> error;
};

struct Replayed {
    std::uint64_t visited_nodes = 0;
    std::uint64_t raw_bytes = 0;       ///< Sum of what each visit reads.
    std::vector<CacheTraffic> caches;  ///< In the order asked for.
    double seconds = 0;
};

/// What a replay is to find.
struct ReplayConfig {
    std::vector<cachesim::CacheConfig> caches;
    bool classes = false;   ///< MissClasses for every cache that a family serves.
    bool together = false;  ///< A family for whatever one serves, also for a single cache: cheaper for each
                            ///< order, dearer in count_revisits().
};

/// The touches of lines that their walk touched before, counted for every cache of a family, by line size.
using Revisits = std::map<std::uint32_t, cachesim::FamilyCounts>;

/// Up to 32 ways, or all.
bool family_serves(const cachesim::CacheConfig& config);

/// For any order of the trace's queries and any of these caches. On all cores. Throws trace::DataError with
/// the query's number when a walk does not fit its tree.
Revisits count_revisits(const WalkStore& walks, const Layout& layout, const ReplayConfig& config,
                        const QueriesDone& progress = {});

/// Whether `revisits` are of these caches or more.
bool serve(const Revisits& revisits, const ReplayConfig& config);

/// Runs all queries in the order of `permutation` through each cache, as if it were alone. `revisits` are of
/// the same walks, layout, and of these caches or more. `progress` is told the queries done now and then. One
/// thread; several replays of one store can run at once. Throws as count_revisits().
Replayed replay(const WalkStore& walks, const Layout& layout, std::span<const std::uint32_t> permutation,
                const ReplayConfig& config, const Revisits& revisits, const QueriesDone& progress = {});

/// The same, but walks whose first touches are held are not decoded, where families serve all caches;
/// `first_touches` are of the same walks and layout.
Replayed replay(const WalkStore& walks, const Layout& layout, std::span<const std::uint32_t> permutation,
                const ReplayConfig& config, const Revisits& revisits, const FirstTouches& first_touches,
                const QueriesDone& progress = {});

/// The elements that any query visits, as a bitmap by their numbers. In parallel.
std::vector<bool> touched_elements(const WalkStore& walks);

/// Compulsory traffic: the different lines on which the touched elements lie, times the line size.
std::uint64_t compulsory_bytes(const std::vector<bool>& touched, const Layout& layout,
                               std::uint32_t line_bytes);

}  // namespace regather::replay
