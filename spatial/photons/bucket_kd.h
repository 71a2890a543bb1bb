// spatial/photons/bucket_kd.h -- kd-trees with buckets of photons for leaves, by three rules of splitting: at
// the median, at the middle of the cell, or where a search is expected to visit least. Their search is
// spatial/photons/nearest.h's, with inner nodes that hold a plane and no photon. Lengths in scene units.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "spatial/photons/nearest.h"
#include "spatial/photons/photon_tree.h"
#include "trace/photon.h"

namespace regather::spatial {

enum class SplitRule : std::uint8_t {
    median,    ///< Along the longest side of the photons' box, into full buckets (Friedman, Bentley & Finkel
               ///< 1977).
    midpoint,  ///< The middle of the cell's longest side; moved to the nearest photon where one half would be
               ///< empty (sliding midpoint: Maneewongvatana & Mount 1999).
    voxel_volume,  ///< Least volume of the cells grown by a radius, each times its photons (Wald, Guenther &
                   ///< Slusallek 2004).
};

class BucketKd {
public:
    struct Config {
        SplitRule rule = SplitRule::median;
        std::uint32_t leaf_photons = 8;  ///< At most, 1 to 64.
        float radius = 0;                ///< That cells are grown by, for voxel_volume.
        /// A search passes a subtree over when its cell is too far (Friedman, Bentley & Finkel 1977's test,
        /// with the distances of Arya & Mount 1993); else when the plane before it is.
        bool bounds = false;
    };
    /// The i-th photon is node i of what a search finds; `name` is the shape's. Parallel tasks; the tree
    /// depends on the input alone. Throws trace::DataError for a photon at NaN or infinity and for 2^31 or
    /// more photons.
    BucketKd(std::span<const Photon> photons, const Config& config, std::string name = "bucket-kd");

    const PhotonTree& shape() const { return *shape_; }
    std::shared_ptr<const PhotonTree> share_shape() const { return shape_; }
    /// By place in the leaves: which photon lies there.
    std::span<const std::uint32_t> photon_at() const { return photon_at_; }
    /// What an inner node splits by; photons on the plane lie on either side.
    struct Plane {
        float position;
        std::uint32_t axis;
    };
    std::span<const Plane> planes() const { return planes_; }
    /// By place in the leaves.
    std::span<const Vec3> positions() const { return positions_; }
    std::uint32_t size() const { return static_cast<std::uint32_t>(photon_at_.size()); }
    bool bounds() const { return bounds_; }

private:
    std::shared_ptr<const PhotonTree> shape_;
    std::vector<Plane> planes_;  // by inner node
    std::vector<Vec3> positions_;
    std::vector<std::uint32_t> photon_at_;
    bool bounds_;
};

/// How far a point is from a cell, as far as the planes passed tell: squares by axis. Exact in floating
/// point as the plane's distance is: no photon of the cell has a smaller computed distance.
struct CellDistance {
    std::array<float, 3> squares;

    /// Of the part of the cell behind a plane at `delta`.
    CellDistance behind(std::uint32_t axis, float delta) const {
        CellDistance part = *this;
        part.squares[axis] = delta * delta;
        return part;
    }
    float squared() const { return squares[0] + squares[1] + squares[2]; }
};
/// How far it is from what lies behind the last plane.
struct PlaneDistance {
    float square;

    PlaneDistance behind(std::uint32_t, float delta) const { return {delta * delta}; }
    float squared() const { return square; }
};

/// nearest() with either distance.
template <class Distance, class Listener>
void nearest_by(const BucketKd& tree, Vec3 point, NearestSet& found, Listener& listener) {
    struct Pending {
        std::uint32_t element;
        Distance distance;
    };
    const PhotonTree& shape = tree.shape();
    const std::uint32_t inner = shape.inner_nodes();
    const std::uint32_t *const children = shape.children().data(), *const leaf_begin =
                                                                       shape.leaf_begin().data();
    std::array<Pending, 256> stack;  // a level takes one; the builder keeps trees below 255 levels
    std::size_t depth = 0;
    Pending at{};
    for (;;) {
        while (at.element < inner) {
            listener.visit(at.element);
            const auto plane = tree.planes()[at.element];
            const float delta = point[static_cast<int>(plane.axis)] - plane.position;
            const bool upper = delta > 0;
            listener.near(upper);
            stack[depth++] = {children[2 * std::size_t{at.element} + (upper ? 0 : 1)],
                              at.distance.behind(plane.axis, delta)};
            at.element = children[2 * std::size_t{at.element} + (upper ? 1 : 0)];
        }
        listener.visit(at.element);
        const std::uint32_t leaf = at.element - inner;
        for (std::uint32_t place = leaf_begin[leaf]; place < leaf_begin[leaf + 1]; ++place) {
            const Vec3 to_point = point - tree.positions()[place];
            const bool entered = found.offer(trace::dot(to_point, to_point), tree.photon_at()[place]);
            if constexpr (requires { listener.look(place, entered); })
                listener.look(tree.photon_at()[place], entered);
        }
        for (;;) {
            if (depth == 0) return;
            at = stack[--depth];
            const bool enter = at.distance.squared() <= found.bound2();
            listener.far(enter);
            if (enter) break;
        }
    }
}

/// Fills `found` with the nearest photons of `point`, as the search of a left-balanced tree does: exact,
/// equal distances by number.
template <class Listener = Unheard>
void nearest(const BucketKd& tree, Vec3 point, NearestSet& found, Listener&& listener = {}) {
    found.clear();
    if (tree.size() == 0 || !trace::is_finite(point)) return;
    if (tree.bounds())
        nearest_by<CellDistance>(tree, point, found, listener);
    else
        nearest_by<PlaneDistance>(tree, point, found, listener);
}

}  // namespace regather::spatial
