// spatial/photons/photon_buckets.h -- a kd-tree of photons for searching fast on this machine's CPU. Leaves
// are buckets of 16 photons as a structure of arrays; three binary levels are one inner node, whose eight
// children are known by the tight boxes of their photons, so that eight distances are one vector operation.
// Candidates are appended to a buffer and pruned by selection when it is full (after Garcia et al., "Fast k
// nearest neighbor search using GPU", 2008, who sort instead), not kept in a heap. Finds what
// spatial/photons/nearest.h finds, photon for photon. Written for AVX2, the baseline of the build: lanes of 8
// on every machine. Lengths in scene units.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "spatial/photons/nearest.h"
#include "trace/photon.h"

namespace regather::spatial {

class PhotonBuckets;

/// The best `capacity` photons of one search. Equal distances: the smaller node number wins. One search at a
/// time.
class Candidates {
public:
    /// `radius` may be infinite; a photon at exactly the radius is found.
    explicit Candidates(std::uint32_t capacity, float radius = std::numeric_limits<float>::infinity());

    std::uint32_t capacity() const { return capacity_; }
    std::size_t size() const { return count_; }
    Neighbor operator[](std::size_t i) const {  ///< In no particular, but repeatable, order.
        return {distance2_[i], node_[i]};
    }
    std::span<const float> distances2() const { return {distance2_.data(), count_}; }
    std::span<const std::uint32_t> nodes() const { return {node_.data(), count_}; }

private:
    friend void nearest(const PhotonBuckets&, Vec3, Candidates&);

    void clear();
    /// Keeps `capacity` of the appended or, with ties left to decide or `slack` allowed, a few more.
    void prune(std::size_t slack);
    void keep_within(float distance2);
    void select_exactly();
    void finish();

    std::uint32_t capacity_;
    float radius2_;
    std::size_t prune_from_;
    float bound2_ = 0;
    std::size_t count_ = 0;
    std::vector<float> distance2_;
    std::vector<std::uint32_t> node_;
};

class PhotonBuckets {
public:
    static constexpr std::uint32_t bucket_photons = 16, fan_out = 8;

    /// The i-th photon is node i of what a search finds: given the photons of a left-balanced tree in heap
    /// order, the numbers are those of spatial/photons/nearest.h. Copies what it needs. Splits at the longest
    /// side of the photons' box into full buckets; the last one alone may have room left. Parallel tasks; the
    /// tree depends on the input alone. Throws trace::DataError for a photon at NaN or infinity and for 2^31
    /// or more photons.
    explicit PhotonBuckets(std::span<const Photon> photons);

    std::uint32_t size() const { return size_; }
    std::size_t buckets() const { return leaves_.size(); }
    /// Which photons lie in a bucket, in the order of its lanes. The i-th bucket holds the photons of the
    /// i-th leaf of BucketKd by SplitRule::median with as many to a leaf (spatial/photons/bucket_kd.h).
    std::span<const std::uint32_t> bucket(std::size_t i) const {
        const std::size_t first = i * bucket_photons;
        return {leaves_[i].node, std::min<std::size_t>(bucket_photons, size_ - first)};
    }

private:
    friend void nearest(const PhotonBuckets&, Vec3, Candidates&);
    struct alignas(64) Leaf {
        float x[bucket_photons], y[bucket_photons], z[bucket_photons];  // NaN where there is no photon
        std::uint32_t node[bucket_photons];
    };
    struct alignas(64) Inner {
        float min[3][fan_out], max[3][fan_out];  // NaN where there is no child
    };
    void add_boxes();

    std::uint32_t size_ = 0;
    // Numbered level by level from the root, inner nodes and then leaves. The root's children are 1, 2, ...;
    // those of node i > 0 begin at 8 i + child_offset_: from the third level on there is a place for each
    // child that the level above could have. A tree of one leaf has no inner node.
    std::vector<Inner> inner_;
    std::vector<Leaf> leaves_;
    std::int64_t child_offset_ = 0;
};

/// Fills `found` with the nearest photons of `point`; nothing for a point that is not finite or an empty
/// tree. Any number of threads may search one tree, each with its own candidates. The pruning is exact in
/// floating point: subtraction, squaring and adding round monotonically, so no photon in a box can have a
/// smaller computed distance than the box.
void nearest(const PhotonBuckets& tree, Vec3 point, Candidates& found);

}  // namespace regather::spatial
