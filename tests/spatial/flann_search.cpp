#include "tests/spatial/flann_search.h"

// FLANN's headers are not clean under our warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#include <flann/algorithms/dist.h>

#include <flann/algorithms/kdtree_single_index.h>
#pragma GCC diagnostic pop

namespace regather::spatial {

struct FlannSearch::Index {
    std::vector<float> points;
    flann::KDTreeSingleIndex<flann::L2<float>> tree;

    explicit Index(std::vector<float> coordinates)
        : points(std::move(coordinates)),
          tree(flann::Matrix<float>(points.data(), points.size() / 3, 3),
               flann::KDTreeSingleIndexParams(10)) {
        tree.buildIndex();
    }
};

FlannSearch::FlannSearch(std::span<const trace::Photon> photons) {
    std::vector<float> points;
    for (const trace::Photon& photon : photons)
        for (int c = 0; c < 3; ++c) points.push_back(photon.position[c]);
    index_ = std::make_unique<Index>(std::move(points));
}
FlannSearch::~FlannSearch() = default;

std::vector<float> FlannSearch::nearest_distances2(trace::Vec3 point, std::uint32_t k) const {
    std::vector<std::vector<std::size_t>> indices;
    std::vector<std::vector<float>> distances;
    const flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED, 0, true);
    index_->tree.knnSearch(flann::Matrix<float>(&point.x, 1, 3), indices, distances, k, exact);
    return distances[0];
}

}  // namespace regather::spatial
