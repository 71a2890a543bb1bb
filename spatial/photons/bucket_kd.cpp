#include "spatial/photons/bucket_kd.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "spatial/photons/photon_parts.h"
#include "trace/bounds.h"

namespace regather::spatial {
namespace {

constexpr std::size_t task_photons = 8192;
constexpr std::uint32_t most_levels =
    200;                  // below it every split is at the median, so that searches need no longer stack
constexpr int bins = 64;  // of a cell's side, where voxel_volume may split

struct Item {
    Vec3 position;
    std::uint32_t photon;
};

struct Cut {
    int axis;
    float position;
    std::size_t lower;  ///< Photons below; the first so many of the items.
};

struct Node {
    Cut cut{};
    std::unique_ptr<Node> child[2];
    std::span<const Item> photons;  ///< Of a leaf.
    std::size_t leaves = 1;
};

int longest(Vec3 side) {
    return side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
}

class Builder {
public:
    explicit Builder(const BucketKd::Config& config) : config_(config) {}

    std::unique_ptr<Node> build(std::span<Item> items, trace::Bounds3 cell, std::uint32_t level) const {
        auto node = std::make_unique<Node>();
        if (items.size() <= config_.leaf_photons) {
            // Cuts decide which photons lie here; in which order, the library's partitions do.
            std::sort(items.begin(), items.end(),
                      [](const Item& a, const Item& b) { return a.photon < b.photon; });
            node->photons = items;
            return node;
        }
        node->cut = cut(items, cell, level);
        const std::span<Item> low = items.first(node->cut.lower), high = items.subspan(node->cut.lower);
        trace::Bounds3 below = cell, above = cell;
        below.max[node->cut.axis] = above.min[node->cut.axis] = node->cut.position;
        const auto left = [&] { node->child[0] = build(low, below, level + 1); };
        const auto right = [&] { node->child[1] = build(high, above, level + 1); };
        if (items.size() > task_photons)
            tbb::parallel_invoke(left, right);
        else
            left(), right();
        node->leaves = node->child[0]->leaves + node->child[1]->leaves;
        return node;
    }

private:
    /// Orders the items by the cut. Both sides get at least one.
    Cut cut(std::span<Item> items, const trace::Bounds3& cell, std::uint32_t level) const {
        trace::Bounds3 box;
        for (const Item& item : items) box.include(item.position);
        const Vec3 side = box.extent();
        if (config_.rule == SplitRule::median || level >= most_levels || side[longest(side)] == 0)
            return at_median(items, longest(side));
        const std::pair<int, float> plane =
            config_.rule == SplitRule::midpoint ? middle(box, cell) : least_volume(items, box, cell);
        const int axis = plane.first;
        const float position = plane.second;
        // Photons on the plane may lie on either side: below, unless nothing lies above.
        auto bound = std::partition(items.begin(), items.end(),
                                    [&](const Item& i) { return i.position[axis] <= position; });
        if (bound == items.end())
            bound = std::partition(items.begin(), items.end(),
                                   [&](const Item& i) { return i.position[axis] < position; });
        return {axis, position, static_cast<std::size_t>(bound - items.begin())};
    }

    /// Full buckets below, as many as a heap of buckets would have there.
    Cut at_median(std::span<Item> items, int axis) const {
        const std::size_t leaves = (items.size() + config_.leaf_photons - 1) / config_.leaf_photons;
        const std::size_t lower = std::bit_ceil(leaves) / 2 * config_.leaf_photons;
        std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(lower), items.end(),
                         [axis](const Item& a, const Item& b) {
                             const float x = a.position[axis], y = b.position[axis];
                             return x < y || (x == y && a.photon < b.photon);
                         });
        return {axis, items[lower].position[axis], lower};
    }

    static std::pair<int, float> middle(const trace::Bounds3& box, const trace::Bounds3& cell) {
        // The longest side of the cell along which photons differ.
        Vec3 side = cell.extent();
        for (int axis = 0; axis < 3; ++axis)
            if (box.min[axis] == box.max[axis]) side[axis] = -1;
        const int axis = longest(side);
        const float half = cell.min[axis] + (cell.max[axis] - cell.min[axis]) * 0.5f;
        return {axis, std::clamp(half, box.min[axis], box.max[axis])};
    }

    std::pair<int, float> least_volume(std::span<const Item> items, const trace::Bounds3& box,
                                       const trace::Bounds3& cell) const {
        const Vec3 side = cell.extent();
        double best = std::numeric_limits<double>::infinity();
        std::pair<int, float> found{longest(box.extent()), 0};
        for (int axis = 0; axis < 3; ++axis) {
            const float from = box.min[axis], width = box.max[axis] - from;
            if (!(width > 0) || !std::isfinite(width)) continue;
            std::array<std::uint64_t, bins> count{};
            const auto plane = [&](int b) { return from + width * (static_cast<float>(b) / bins); };
            for (const Item& item : items) {
                const float x = item.position[axis];
                int b = std::clamp(static_cast<int>((x - from) / width * bins), 0, bins - 1);
                while (b > 0 && x <= plane(b)) --b;  // on a plane: below it, as the cut has it
                while (b + 1 < bins && x > plane(b + 1)) ++b;
                ++count[static_cast<std::size_t>(b)];
            }
            const double grown[2] = {side[(axis + 1) % 3] + 2.0 * config_.radius,
                                     side[(axis + 2) % 3] + 2.0 * config_.radius};
            std::uint64_t below = 0;
            for (int b = 1; b < bins; ++b) {
                below += count[static_cast<std::size_t>(b - 1)];
                const std::uint64_t above = items.size() - below;
                if (below == 0 || above == 0) continue;
                const double at = plane(b);
                const double cost =
                    grown[0] * grown[1] *
                    ((at - cell.min[axis] + 2.0 * config_.radius) * static_cast<double>(below) +
                     (cell.max[axis] - at + 2.0 * config_.radius) * static_cast<double>(above));
                if (cost < best) {
                    best = cost;
                    found = {axis, plane(b)};
                }
            }
        }
        if (best == std::numeric_limits<double>::infinity()) return middle(box, cell);
        return found;
    }

    BucketKd::Config config_;
};

}  // namespace

BucketKd::BucketKd(std::span<const Photon> photons, const Config& config, std::string name)
    : bounds_(config.bounds) {
    check_photons(photons);
    std::vector<Item> items(photons.size());
    trace::Bounds3 cell;
    for (std::size_t i = 0; i < photons.size(); ++i) {
        items[i] = {photons[i].position, static_cast<std::uint32_t>(i)};
        cell.include(photons[i].position);
    }
    std::unique_ptr<Node> root;
    if (!items.empty()) root = Builder(config).build(items, cell, 0);

    const std::size_t inner = root ? root->leaves - 1 : 0;
    std::vector<std::uint32_t> children(2 * inner), leaf_begin{0};
    const auto number = [&](const auto& self, const Node& node) -> std::uint32_t {
        if (!node.child[0]) {
            for (const Item& item : node.photons) {
                photon_at_.push_back(item.photon);
                positions_.push_back(item.position);
            }
            leaf_begin.push_back(static_cast<std::uint32_t>(photon_at_.size()));
            return static_cast<std::uint32_t>(inner + leaf_begin.size() - 2);
        }
        const std::size_t own = planes_.size();
        planes_.push_back({node.cut.position, static_cast<std::uint32_t>(node.cut.axis)});
        for (std::size_t c = 0; c < 2; ++c) children[2 * own + c] = self(self, *node.child[c]);
        return static_cast<std::uint32_t>(own);
    };
    photon_at_.reserve(items.size());
    positions_.reserve(items.size());
    if (root) number(number, *root);
    shape_ = std::make_shared<PhotonTree>(std::move(name), std::move(children), std::move(leaf_begin));
}

}  // namespace regather::spatial
