#include "experiment/race.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "spatial/photons/nearest.h"
#include "spatial/photons/photon_buckets.h"
#include "trace/median.h"

namespace regather::experiment {
namespace {

using trace::Vec3;
using Clock = std::chrono::steady_clock;

constexpr std::size_t block_queries = 1024;  ///< A thread takes so many neighbours of the order at a time.

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What stands for the photons that a query found: the same in any sequence. Touching them is part of a
/// search.
struct Digest {
    std::uint64_t nodes = 0, count = 0;
};

struct LeftBalancedSearcher {
    spatial::PhotonKd tree;
    spatial::NearestSet found;
    Digest operator()(Vec3 point) {
        spatial::nearest(tree, point, found);
        Digest digest{0, found.size()};
        for (std::size_t i = 0; i < found.size(); ++i) digest.nodes += std::uint64_t{found[i].node} + 1;
        return digest;
    }
};

struct BucketedSearcher {
    const spatial::PhotonBuckets* tree;
    spatial::Candidates found;
    Digest operator()(Vec3 point) {
        spatial::nearest(*tree, point, found);
        Digest digest{0, found.size()};
        for (const std::uint32_t node : found.nodes()) digest.nodes += std::uint64_t{node} + 1;
        return digest;
    }
};

struct Run {
    std::span<const Vec3> position;  // in capture order
    std::span<const Vec3> gathered;  // in the order of the run, or empty
    std::span<const std::uint32_t> order;
    std::span<std::uint64_t> slots;  // by query: the sum of its nodes' numbers
    std::uint32_t threads;
};

struct SearchRun {
    double seconds;
    std::uint64_t found_photons;
};

template <class Searcher>
SearchRun search_all(const Searcher& prototype, const Run& run) {
    std::atomic<std::size_t> next = 0;
    std::atomic<std::uint64_t> found_photons = 0;
    const std::size_t queries = run.order.size();
    const auto work = [&] {
        Searcher searcher(prototype);
        std::uint64_t found = 0;
        for (std::size_t begin; (begin = next.fetch_add(block_queries)) < queries;) {
            for (std::size_t r = begin; r < std::min(queries, begin + block_queries); ++r) {
                const std::uint32_t query = run.order[r];
                const Digest digest = searcher(run.gathered.empty() ? run.position[query] : run.gathered[r]);
                run.slots[query] = digest.nodes;
                found += digest.count;
            }
        }
        found_photons += found;
    };
    const Clock::time_point start = Clock::now();
    {
        std::vector<std::jthread> others;
        for (std::uint32_t thread = 1; thread < run.threads; ++thread) others.emplace_back(work);
        work();
    }
    return {seconds_since(start), found_photons};
}

/// Every run must put into each query's slot what the first one did.
class Agreement {
public:
    explicit Agreement(std::size_t queries) : expected_(queries), slots_(queries) {}

    std::span<std::uint64_t> slots() {
        std::fill(slots_.begin(), slots_.end(), ~std::uint64_t{0});
        return slots_;
    }
    void check(const std::string& ordering, Structure structure) {
        if (first_.empty()) {
            expected_ = slots_;
            first_ = fmt::format("{} on {}", ordering, name(structure));
            return;
        }
        const auto differs = std::mismatch(slots_.begin(), slots_.end(), expected_.begin());
        if (differs.first != slots_.end())
            throw std::runtime_error(
                fmt::format("query {}: found other photons in the order {} on {} than {}",
                            differs.first - slots_.begin(), ordering, name(structure), first_));
    }

private:
    std::vector<std::uint64_t> expected_, slots_;
    std::string first_;
};

}  // namespace

std::string_view name(Structure structure) {
    return structure == Structure::left_balanced ? "left-balanced" : "bucketed";
}

std::optional<Structure> structure_named(std::string_view word) {
    for (const Structure structure : structures)
        if (name(structure) == word) return structure;
    return {};
}

Timing timing_of(std::vector<double> seconds) {
    const double middle = trace::median(seconds);
    const auto [min, max] = std::minmax_element(seconds.begin(), seconds.end());
    Timing timing{middle, *min, *max, 0};
    for (double& value : seconds) value = std::fabs(value - middle);
    timing.mad = trace::median(std::move(seconds));
    return timing;
}

Race race(std::span<const trace::Photon> heap, const reorder::Workload& work,
          std::span<const reorder::ParsedOrdering> orderings, std::size_t baseline, const RaceConfig& config,
          const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
    const std::size_t queries = work.position.size(), kinds = config.structures.size();
    const std::uint64_t total = std::uint64_t{queries} * kinds * orderings.size() * config.repeats;
    const std::uint32_t k = std::min(config.k, static_cast<std::uint32_t>(heap.size()));
    const bool needs_buckets = std::find(config.structures.begin(), config.structures.end(),
                                         Structure::bucketed) != config.structures.end();
    const spatial::PhotonBuckets buckets(needs_buckets ? heap : heap.first(0));
    const int cores = tbb::this_task_arena::max_concurrency();  // more workers than that TBB complains about
    tbb::task_arena arena(std::min(static_cast<int>(config.threads), cores));
    Agreement agreement(queries);
    std::vector<Vec3> gathered(config.gathered ? queries : 0);

    std::vector<std::vector<double>> order_seconds(orderings.size());
    std::vector<std::vector<double>> search_seconds(orderings.size() * kinds);  // [ordering][structure]
    Race result;
    std::uint64_t done = 0;
    for (std::size_t repeat = 0; repeat < config.repeats; ++repeat) {
        for (std::size_t turn = 0; turn < orderings.size(); ++turn) {
            const std::size_t i = (repeat + turn) % orderings.size();
            reorder::Ordered ordered;
            arena.execute([&] { ordered = reorder::order(*orderings[i].ordering, work); });
            Run run{work.position, {}, ordered.permutation, {}, config.threads};
            double seconds = ordered.seconds;
            if (i == baseline) {
                seconds = 0;
                if (config.gathered) run.gathered = work.position;
            } else if (config.gathered) {
                const Clock::time_point start = Clock::now();
                for (std::size_t r = 0; r < queries; ++r) gathered[r] = work.position[ordered.permutation[r]];
                seconds += seconds_since(start);
                run.gathered = gathered;
            }
            order_seconds[i].push_back(seconds);
            for (std::size_t s = 0; s < kinds; ++s) {
                run.slots = agreement.slots();
                const SearchRun searched =
                    config.structures[s] == Structure::bucketed
                        ? search_all(BucketedSearcher{&buckets, spatial::Candidates(k, config.radius)}, run)
                        : search_all(LeftBalancedSearcher{spatial::PhotonKd(heap),
                                                          spatial::NearestSet(k, config.radius)},
                                     run);
                agreement.check(orderings[i].spec.text, config.structures[s]);
                search_seconds[i * kinds + s].push_back(searched.seconds);
                result.found_photons = searched.found_photons;
                progress(done += queries, total);
            }
        }
    }

    for (std::size_t i = 0; i < orderings.size(); ++i) {
        for (std::size_t s = 0; s < kinds; ++s) {
            const std::vector<double>& search = search_seconds[i * kinds + s];
            std::vector<double> gain;
            for (std::size_t repeat = 0; repeat < config.repeats; ++repeat)
                gain.push_back(search_seconds[baseline * kinds + s][repeat] -
                               (search[repeat] + order_seconds[i][repeat]));
            result.standings.push_back({i, config.structures[s], timing_of(order_seconds[i]),
                                        timing_of(search),
                                        i == baseline ? 0 : trace::median(std::move(gain))});
        }
    }
    return result;
}

}  // namespace regather::experiment
