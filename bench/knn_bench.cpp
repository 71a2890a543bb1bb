// bench/knn_bench.cpp -- the k nearest photons by our two trees and by two libraries, one thread. Photons:
// the scene `room`, 1 M; queries: its gathers at 45 x 45 pixels x 100 rays, in random and in Hilbert order,
// fetched through the permutation. Every run checks what it found against the left-balanced tree: our
// bucketed tree by node, the libraries, which add in another sequence, by the distance of the k-th.
#include <benchmark/benchmark.h>

// The libraries' headers are not clean under our warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#include <flann/flann.hpp>
#include <nanoflann.hpp>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "bench/room.h"
#include "spatial/photons/nearest.h"
#include "spatial/photons/photon_buckets.h"

namespace {

using namespace regather;

using bench::k;
constexpr std::array<const char*, 2> orderings{"random", "hilbert"};

/// What a search of each query found.
struct Answer {
    std::vector<float> farthest2;
    std::uint64_t nodes = 0;  ///< Sum of the node numbers.
    void add(float distance2) { farthest2.push_back(distance2); }
};

/// The queries of the room in each order, and what the left-balanced tree finds for them.
struct Course {
    std::array<std::vector<trace::Vec3>, orderings.size()> points;
    std::array<Answer, orderings.size()> answers;

    Course() {
        const spatial::PhotonKd tree(bench::room().heap);
        spatial::NearestSet found(k);
        for (std::size_t kind = 0; kind < orderings.size(); ++kind) {
            for (const std::uint32_t q : bench::room().permutation(orderings[kind])) {
                points[kind].push_back(bench::room().queries.position[q]);
                spatial::nearest(tree, points[kind].back(), found);
                answers[kind].add(found.disc_radius2());
                for (std::size_t i = 0; i < found.size(); ++i) answers[kind].nodes += found[i].node;
            }
        }
    }
};

const Course& course() {
    static const Course instance;
    return instance;
}

/// One search(point, answer) a query, in one of the orders.
template <class Search>
void race(benchmark::State& state, bool exact, Search&& search) {
    const auto kind = static_cast<std::size_t>(state.range(0));
    const std::vector<trace::Vec3>& points = course().points[kind];
    const Answer& expected = course().answers[kind];
    for (auto unused : state) {
        Answer answer;
        answer.farthest2.reserve(points.size());
        for (const trace::Vec3 point : points) search(point, answer);
        for (std::size_t q = 0; q < points.size(); ++q) {
            const float ours = expected.farthest2[q], theirs = answer.farthest2[q];
            if (exact ? theirs != ours : !(std::fabs(theirs - ours) <= 1e-5f * ours))
                state.SkipWithError("another farthest photon");
        }
        if (exact && answer.nodes != expected.nodes) state.SkipWithError("other photons");
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
    state.counters["a query"] =
        benchmark::Counter(static_cast<double>(points.size()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.SetLabel(orderings[kind]);
}

void left_balanced(benchmark::State& state) {
    const spatial::PhotonKd tree(bench::room().heap);
    spatial::NearestSet found(k);
    race(state, true, [&](trace::Vec3 point, Answer& answer) {
        spatial::nearest(tree, point, found);
        answer.add(found.disc_radius2());
        for (std::size_t i = 0; i < found.size(); ++i) answer.nodes += found[i].node;
    });
}

void bucketed(benchmark::State& state) {
    static const spatial::PhotonBuckets tree(bench::room().heap);
    spatial::Candidates found(k);
    race(state, true, [&](trace::Vec3 point, Answer& answer) {
        spatial::nearest(tree, point, found);
        answer.add(*std::max_element(found.distances2().begin(), found.distances2().end()));
        for (const std::uint32_t node : found.nodes()) answer.nodes += node;
    });
}

/// The photons as the libraries want them: three floats each.
const std::vector<trace::Vec3>& positions() {
    static const std::vector<trace::Vec3> all = [] {
        std::vector<trace::Vec3> list;
        for (const trace::Photon& photon : bench::room().heap) list.push_back(photon.position);
        return list;
    }();
    return all;
}

void flann_single(benchmark::State& state, int leaf) {
    std::vector<trace::Vec3> data = positions();
    flann::Index<flann::L2_3D<float>> index(flann::Matrix<float>(&data[0].x, data.size(), 3),
                                            flann::KDTreeSingleIndexParams(leaf));
    index.buildIndex();
    std::array<std::size_t, k> nodes;
    std::array<float, k> distances2;
    flann::Matrix<std::size_t> node_row(nodes.data(), 1, k);
    flann::Matrix<float> distance_row(distances2.data(), 1, k);
    const flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED, 0, true);
    race(state, false, [&](trace::Vec3 point, Answer& answer) {
        index.knnSearch(flann::Matrix<float>(&point.x, 1, 3), node_row, distance_row, k, exact);
        answer.add(distances2.back());
    });
}

struct Cloud {
    std::size_t kdtree_get_point_count() const { return positions().size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return (&positions()[i].x)[axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

void nanoflann_leaf_10(benchmark::State& state) {
    const Cloud cloud;
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3>;
    static std::optional<Tree> tree;
    if (!tree) tree.emplace(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10)).buildIndex();
    std::array<std::uint32_t, k> nodes;
    std::array<float, k> distances2;
    race(state, false, [&](trace::Vec3 point, Answer& answer) {
        tree->knnSearch(&point.x, k, nodes.data(), distances2.data());
        answer.add(distances2.back());
    });
}

#define KNN(...) __VA_ARGS__->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)
KNN(BENCHMARK(left_balanced));
KNN(BENCHMARK(bucketed));
KNN(BENCHMARK_CAPTURE(flann_single, leaf_10, 10));
KNN(BENCHMARK_CAPTURE(flann_single, leaf_32, 32));
KNN(BENCHMARK(nanoflann_leaf_10));

}  // namespace

BENCHMARK_MAIN();
