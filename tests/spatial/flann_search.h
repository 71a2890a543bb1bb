// tests/spatial/flann_search.h -- the k nearest photons by FLANN's exact kd-tree, whose headers take long to
// compile.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trace/photon.h"

namespace regather::spatial {

class FlannSearch {
public:
    explicit FlannSearch(std::span<const trace::Photon> photons);
    ~FlannSearch();

    /// Squared distances, ascending.
    std::vector<float> nearest_distances2(trace::Vec3 point, std::uint32_t k) const;

private:
    struct Index;
    std::unique_ptr<Index> index_;
};

}  // namespace regather::spatial
