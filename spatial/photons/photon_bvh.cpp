#include "spatial/photons/photon_bvh.h"

namespace regather::spatial {
PhotonBvh::PhotonBvh(std::span<const Photon> photons, std::uint32_t leaf_photons, std::string name) {
    const BucketKd tree(photons, {.rule = SplitRule::median, .leaf_photons = leaf_photons});
    const PhotonTree& shape = tree.shape();
    const std::uint32_t inner = shape.inner_nodes();
    std::vector<trace::Bounds3> box(shape.end());
    for (std::uint32_t leaf = 0; leaf < shape.leaves(); ++leaf) {
        const std::uint32_t begin = shape.leaf_begin()[leaf], end = shape.leaf_begin()[leaf + 1];
        parts_.add(tree.photon_at().subspan(begin, end - begin), photons);
        for (std::uint32_t place = begin; place < end; ++place)
            box[inner + leaf].include(tree.positions()[place]);
    }
    Listed::Elements elements;
    elements.ranges.assign(shape.ranges().begin(), shape.ranges().end());
    elements.parent.resize(shape.end());
    nodes_.resize(inner);
    for (std::uint32_t i = inner; i-- > 0;)  // children stand behind their parents
        for (std::size_t c = 0; c < 2; ++c) {
            const std::uint32_t child = shape.children()[2 * std::size_t{i} + c];
            nodes_[i].child[c] = child;
            nodes_[i].box[c] = box[child];
            box[i].include(box[child]);
            elements.parent[child] = i;
        }
    elements.record_begin.assign(shape.leaf_begin().begin(), shape.leaf_begin().end());
    elements.node_bytes = node_bytes;
    structure_ = std::make_shared<Listed>(std::move(name), std::move(elements));
}

}  // namespace regather::spatial
