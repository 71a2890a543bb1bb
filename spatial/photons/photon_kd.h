// spatial/photons/photon_kd.h -- the left-balanced kd-tree of photons (Bentley 1975; Jensen 2001,
// sections 5.2 and 6.3). The tree is an array in heap order and holds nothing but photons: each node is one,
// children of the i-th node (counted from 1) are the 2i-th and 2i+1-th. The split axis lies in the photon's
// flags.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "trace/photon.h"

namespace regather::spatial {

using trace::Photon;
using trace::Vec3;

/// A view of photons in heap order. Node numbers count from 0 everywhere outside of this folder's loops.
class PhotonKd {
public:
    PhotonKd() = default;
    /// `heap_order` as from left_balanced(); outlives the view. At most 2^31 - 1 photons.
    explicit PhotonKd(std::span<const Photon> heap_order) : nodes_(heap_order) {}

    std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
    std::span<const Photon> nodes() const { return nodes_; }
    static int axis(const Photon& photon) { return photon.flags & 3; }

private:
    std::span<const Photon> nodes_;
};

/// The photons in heap order with their split axes set: each node splits its photons along the longest side
/// of their bounding box (ties: x before y before z). Equal coordinates are ordered by place in the input, so
/// the result depends on nothing else. O(n log n) in parallel tasks. Throws trace::DataError for a photon at
/// NaN or infinity and for 2^31 or more photons.
std::vector<Photon> left_balanced(std::span<const Photon> photons);
/// And which of `photons` each of them was.
std::vector<Photon> left_balanced(std::span<const Photon> photons, std::vector<std::uint32_t>& from);

/// First node (by number) that breaks the order of a left-balanced kd-tree, or size() when none does. For
/// files that come from elsewhere: a search in a tree that is out of order would miss photons.
std::uint32_t first_disorder(const PhotonKd& tree);

}  // namespace regather::spatial
