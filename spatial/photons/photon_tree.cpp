#include "spatial/photons/photon_tree.h"

#include "spatial/tree_walk.h"

namespace regather::spatial {
namespace {

std::vector<ElementRange> ranges_of(std::size_t inner, std::size_t leaves) {
    std::vector<ElementRange> ranges;
    if (inner > 0) ranges.push_back({trace::Region::nodes, 0, static_cast<std::uint32_t>(inner)});
    if (leaves > 0)
        ranges.push_back(
            {trace::Region::photons, static_cast<std::uint32_t>(inner), static_cast<std::uint32_t>(leaves)});
    return ranges;
}

}  // namespace

PhotonTree::PhotonTree(std::string name, std::vector<std::uint32_t> children,
                       std::vector<std::uint32_t> leaf_begin)
    : Structure(ranges_of(children.size() / 2, leaf_begin.size() - 1)),
      name_(std::move(name)),
      children_(std::move(children)),
      leaf_begin_(std::move(leaf_begin)),
      level_(end()) {
    // A child's number is above its parent's, or it is a leaf: one pass from the root.
    for (std::uint32_t i = 0; i < inner_nodes(); ++i)
        for (std::uint32_t c = 2 * i; c < 2 * i + 2; ++c) level_[children_[c]] = level_[i] + 1;
}

std::unique_ptr<WalkDecoder> PhotonTree::decoder() const {
    return std::make_unique<TreeWalkDecoder>(children_, leaves() == 0);
}

void PhotonTree::append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const {
    if (element < inner_nodes()) to.insert(to.end(), {children_[2 * element], children_[2 * element + 1]});
}

std::vector<std::uint32_t> PhotonTree::roots() const {
    if (end() == 0) return {};
    return {0};
}

std::uint32_t PhotonTree::records(std::uint32_t element) const {
    if (element < inner_nodes()) return 1;
    const std::uint32_t leaf = element - inner_nodes();
    return leaf_begin_[leaf + 1] - leaf_begin_[leaf];
}

bool PhotonTree::same_as(const Structure& other) const {
    const auto* const tree = dynamic_cast<const PhotonTree*>(&other);
    return tree && Structure::same_as(other) && children_ == tree->children_ &&
           leaf_begin_ == tree->leaf_begin_;
}

}  // namespace regather::spatial
