// spatial/photons/nearest.h -- the k nearest photons of a point: near child first, far child if it can still
// help (Jensen 2001, section 6.3.1), with the exact running bound of a max-heap. One search serves the
// renderer, which passes Unheard and pays nothing, and the recorder of walks (spatial/walk.h), which listens.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "spatial/photons/photon_kd.h"

namespace regather::spatial {

struct Neighbor {
    float distance2;     ///< Squared distance [scene units^2].
    std::uint32_t node;  ///< Heap position, from 0.
};

/// The best `capacity` photons met so far within a radius. Equal distances: the smaller node number wins, so
/// the result does not depend on the order in which photons are offered.
class NearestSet {
public:
    /// `radius` in scene units, may be infinite; a photon at exactly the radius is found.
    explicit NearestSet(std::uint32_t capacity, float radius = std::numeric_limits<float>::infinity())
        : capacity_(capacity), radius2_(radius * radius) {
        keys_.reserve(capacity);
    }

    void clear() {
        keys_.clear();
        bound_ = key(radius2_, std::numeric_limits<std::uint32_t>::max());
        if (capacity_ == 0) bound_ = 0;
    }
    /// Nothing farther than this can be found any more; -1 when nothing can.
    float bound2() const { return capacity_ == 0 ? -1.0f : distance_of(bound_); }
    /// Whether it is among the best so far.
    bool offer(float distance2, std::uint32_t node) {
        const std::uint64_t candidate = key(distance2, node);
        if (candidate >= bound_) return false;
        if (keys_.size() < capacity_) {
            keys_.push_back(candidate);
            if (keys_.size() == capacity_) {
                std::make_heap(keys_.begin(), keys_.end());
                bound_ = keys_.front();
            }
            return true;
        }
        replace_farthest(candidate);
        bound_ = keys_.front();
        return true;
    }

    std::uint32_t capacity() const { return capacity_; }
    std::size_t size() const { return keys_.size(); }
    bool full() const { return keys_.size() == capacity_; }
    Neighbor operator[](
        std::size_t i) const {  ///< The farthest first when full(), then in some, repeatable, order.
        return {distance_of(keys_[i]), static_cast<std::uint32_t>(keys_[i])};
    }
    std::vector<Neighbor> nearest_first() const {
        std::vector<std::uint64_t> sorted(keys_);
        std::sort(sorted.begin(), sorted.end());
        std::vector<Neighbor> list;
        list.reserve(sorted.size());
        for (std::uint64_t k : sorted) list.push_back({distance_of(k), static_cast<std::uint32_t>(k)});
        return list;
    }
    /// Squared radius of the disc that the found photons stand for: the farthest photon's when the set is
    /// full, else the search radius', or the farthest one's where that is infinite. 0 when nothing was found.
    float disc_radius2() const {
        if (keys_.empty()) return 0;
        if (!full() && std::isfinite(radius2_)) return radius2_;
        return distance_of(full() ? keys_.front() : *std::max_element(keys_.begin(), keys_.end()));
    }

private:
    // Squared distances are not negative, so their bit patterns sort as they do: one integer holds (distance,
    // node).
    static std::uint64_t key(float distance2, std::uint32_t node) {
        return std::uint64_t{std::bit_cast<std::uint32_t>(distance2)} << 32 | node;
    }
    static float distance_of(std::uint64_t k) {
        return std::bit_cast<float>(static_cast<std::uint32_t>(k >> 32));
    }

    void replace_farthest(std::uint64_t candidate) {
        const std::size_t n = keys_.size();
        std::size_t hole = 0;
        for (std::size_t child = 1; child < n; child = 2 * hole + 1) {
            child += (child + 1 < n && keys_[child + 1] > keys_[child]) ? 1 : 0;
            if (keys_[child] <= candidate) break;
            keys_[hole] = keys_[child];
            hole = child;
        }
        keys_[hole] = candidate;
    }

    std::uint32_t capacity_;
    float radius2_;
    std::uint64_t bound_ = 0;
    std::vector<std::uint64_t> keys_;
};

/// What a search tells: each node it enters, and its two decisions at each node that has a child. A listener
/// that has look(photon, entered) is told each photon whose distance is taken, too, as NearestSet numbers it,
/// and whether it was among the best so far.
struct Unheard {
    void visit(std::uint32_t) {}  ///< A node number, from 0; pre-order.
    void near(bool) {}            ///< After visit: is the upper (second) child the nearer one?
    void far(bool) {}             ///< When the near subtree is done: is the far child entered?
};

/// Fills `found`, a NearestSet or another that has clear(), offer() and bound2(), with the nearest photons of
/// `point`; nothing for a point that is not finite or an empty tree. The pruning is exact in floating point:
/// subtraction, squaring and adding round monotonically, so no photon behind a split plane can have a smaller
/// computed distance than the plane.
template <class Found, class Listener = Unheard>
void nearest(const PhotonKd& tree, Vec3 point, Found& found, Listener&& listener = {}) {
    struct Pending {
        std::uint32_t slot;
        float plane_distance2;
    };
    Pending stack[32];
    found.clear();
    const std::uint32_t count = tree.size();
    if (count == 0 || !trace::is_finite(point)) return;
    const Photon* const heap = tree.nodes().data() - 1;  // slots count from 1

    int depth = 0;
    std::uint32_t slot = 1;
    for (;;) {
        for (;;) {
            const Photon& photon = heap[slot];
            listener.visit(slot - 1);
            const Vec3 to_point = point - photon.position;
            const bool entered = found.offer(trace::dot(to_point, to_point), slot - 1);
            if constexpr (requires { listener.look(slot, entered); }) listener.look(slot - 1, entered);
            const std::uint32_t children = 2 * slot;
            if (children > count) break;
            __builtin_prefetch(heap + children);
            const float delta = to_point[PhotonKd::axis(photon)];
            const bool upper = delta > 0;
            listener.near(upper);
            const std::uint32_t near_child = children + upper;
            stack[depth++] = {near_child ^ 1u, delta * delta};
            if (near_child > count) break;
            slot = near_child;
        }
        for (;;) {
            if (depth == 0) return;
            const Pending pending = stack[--depth];
            const bool enter = pending.slot <= count && pending.plane_distance2 <= found.bound2();
            listener.far(enter);
            if (enter) {
                slot = pending.slot;
                break;
            }
        }
    }
}

}  // namespace regather::spatial
