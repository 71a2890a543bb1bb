// spatial/rays/cast.h -- rays against the triangles of a RayBvh: the nearest hit, and whether there is one.
// One traversal serves the renderer, which passes UnheardCast and pays nothing, and whoever wants to know
// which nodes and triangles a ray visits.
//
// What is hit is decided by each triangle alone, in arithmetic that IEEE 754 prescribes to the last bit
// (Woop, Benthin, Wald: "Watertight Ray/Triangle Intersection", JCGT 2013): corners are sheared so that the
// ray runs along an axis, rounded to floats, and the signs of the edge functions of these floats are exact.
// So a ray through a shared edge or corner never passes between triangles. The boxes' test is wider than all
// rounding (Ize, "Robust BVH Ray Traversal", JCGT 2013, with an absolute margin that covers the shear, too),
// so the hierarchy and the order of the traversal have no say in what is hit: of equal distances the smaller
// triangle number wins. Lengths in scene units, distances in lengths of the ray's direction.
#pragma once
#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "spatial/rays/built_tree.h"
#include "spatial/rays/ray.h"
#include "spatial/rays/ray_bvh.h"
#include "trace/vec.h"

namespace regather::spatial {

/// Where a ray meets a triangle.
struct Meeting {
    static constexpr std::uint32_t nothing = 0xffffffffu;

    float distance = std::numeric_limits<float>::infinity();
    std::uint32_t triangle = nothing;
    double weights[3] = {0, 0, 0};  ///< Of the corners; none has another sign than `weight_sum`, their sum.
    double weight_sum = 0;

    bool found() const { return triangle != nothing; }
};

/// What a cast tells, in the order of its steps. Of the children that are entered one is gone to, the others
/// wait, the last one put aside first.
struct UnheardCast {
    void node(std::uint32_t) {}   ///< The boxes of a node's children are tested.
    void entered(unsigned) {}     ///< So many of them are entered by the ray. A listener may do without.
    void block(std::uint32_t) {}  ///< The triangles of a block are tested.
};

namespace cast_detail {

/// A ray, prepared for boxes and triangles.
class Prepared {
public:
    Prepared(const Ray& ray, const trace::Bounds3& bounds) {
        const trace::Vec3 o = ray.origin, d = ray.direction;
        const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
        along_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
        first_ = along_ == 2 ? 0 : along_ + 1;
        second_ = first_ == 2 ? 0 : first_ + 1;
        length_ = d[along_];
        origin_along_ = _mm256_set1_ps(o[along_]);
        origin_first_ = _mm256_set1_ps(o[first_]);
        origin_second_ = _mm256_set1_ps(o[second_]);
        shear_first_ = _mm256_set1_ps(d[first_] / d[along_]);
        shear_second_ = _mm256_set1_ps(d[second_] / d[along_]);

        // Boxes are widened by more than all rounding. With the farthest plane at `reach`, a sheared corner
        // is off by at most 5 x 2^-24 of the sum of two differences, 10 x 2^-24 x reach; entry and exit round
        // four times, and the distance twice: 6 x 2^-24 x reach. The rest is for origin and padding
        // themselves.
        float reach = 0, farthest_out = 0;
        for (int axis = 0; axis < 3; ++axis) {
            reach = std::max(
                {reach, std::fabs(bounds.min[axis] - o[axis]), std::fabs(bounds.max[axis] - o[axis])});
            farthest_out = std::max(farthest_out, std::fabs(o[axis]));
        }
        const float pad = reach * 0x1p-19f + farthest_out * 0x1p-22f;
        for (int axis = 0; axis < 3; ++axis) {
            const bool down = std::signbit(d[axis]);
            lower_is_near_[axis] = !down;
            near_origin_[axis] = _mm256_set1_ps(down ? o[axis] - pad : o[axis] + pad);
            far_origin_[axis] = _mm256_set1_ps(down ? o[axis] + pad : o[axis] - pad);
            inverse_[axis] = _mm256_set1_ps(1 / d[axis]);
        }
    }

    /// A bit for each child whose box has a part of the ray from `nearest` to `farthest`, and where the ray
    /// enters it. An axis along which the ray does not move gives infinities; where 0 meets one of them, it
    /// excludes nothing, as minimum and maximum keep their second operand.
    unsigned enter(const RayBvh::Node& node, float nearest, float farthest, float* entry) const {
        __m256 in = _mm256_set1_ps(nearest), out = _mm256_set1_ps(farthest);
        for (int axis = 0; axis < 3; ++axis) {
            const __m256 near_plane = _mm256_load_ps(node.planes[axis][!lower_is_near_[axis]]),
                         far_plane = _mm256_load_ps(node.planes[axis][lower_is_near_[axis]]);
            in = _mm256_max_ps(_mm256_mul_ps(_mm256_sub_ps(near_plane, near_origin_[axis]), inverse_[axis]),
                               in);
            out = _mm256_min_ps(_mm256_mul_ps(_mm256_sub_ps(far_plane, far_origin_[axis]), inverse_[axis]),
                                out);
        }
        _mm256_store_ps(entry, in);
        return unsigned(_mm256_movemask_ps(_mm256_cmp_ps(in, out, _CMP_LE_OQ)));
    }

    /// Calls found(distance, lane, weights, sum) for each triangle of the block that the ray's line meets, in
    /// the sequence of the lanes, until it returns true, and returns whether it did.
    template <class Found>
    bool meet(const RayBvh::Block& block, Found&& found) const {
        alignas(32) float along[3][8], first[3][8], second[3][8];
        __m256 f[3], s[3], a[3];
        for (int corner = 0; corner < 3; ++corner) {
            a[corner] = _mm256_sub_ps(_mm256_load_ps(block.corners[along_][corner]), origin_along_);
            f[corner] =
                _mm256_fnmadd_ps(shear_first_, a[corner],
                                 _mm256_sub_ps(_mm256_load_ps(block.corners[first_][corner]), origin_first_));
            s[corner] = _mm256_fnmadd_ps(
                shear_second_, a[corner],
                _mm256_sub_ps(_mm256_load_ps(block.corners[second_][corner]), origin_second_));
        }
        // A rounded product is never on the other side of another one, so a sign that is not 0 is exact.
        const __m256 u = _mm256_sub_ps(_mm256_mul_ps(f[1], s[2]), _mm256_mul_ps(s[1], f[2])),
                     v = _mm256_sub_ps(_mm256_mul_ps(f[2], s[0]), _mm256_mul_ps(s[2], f[0])),
                     w = _mm256_sub_ps(_mm256_mul_ps(f[0], s[1]), _mm256_mul_ps(s[0], f[1]));
        const __m256 zero = _mm256_setzero_ps();
        const __m256 least = _mm256_min_ps(u, _mm256_min_ps(v, w)),
                     most = _mm256_max_ps(u, _mm256_max_ps(v, w));
        const __m256 outside =
            _mm256_and_ps(_mm256_cmp_ps(least, zero, _CMP_LT_OQ), _mm256_cmp_ps(most, zero, _CMP_GT_OQ));
        unsigned candidates = ~unsigned(_mm256_movemask_ps(outside)) & ((1u << block.count) - 1);
        if (candidates == 0) return false;
        for (int corner = 0; corner < 3; ++corner) {
            _mm256_store_ps(along[corner], a[corner]);
            _mm256_store_ps(first[corner], f[corner]);
            _mm256_store_ps(second[corner], s[corner]);
        }
        for (; candidates != 0; candidates &= candidates - 1) {
            const auto lane = unsigned(std::countr_zero(candidates));
            // Products of floats are doubles, so signs are exact here also where floats gave 0.
            const auto edge = [&](int p, int q) {
                return double(first[p][lane]) * double(second[q][lane]) -
                       double(second[p][lane]) * double(first[q][lane]);
            };
            const double weights[3] = {edge(1, 2), edge(2, 0), edge(0, 1)};
            const double sum = weights[0] + weights[1] + weights[2];
            const bool up = weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0,
                       down = weights[0] <= 0 && weights[1] <= 0 && weights[2] <= 0;
            if (!(up || down)) continue;
            // Not a number when all weights are 0: the triangle is edge-on.
            const double distance =
                (weights[0] * double(along[0][lane]) + weights[1] * double(along[1][lane]) +
                 weights[2] * double(along[2][lane])) /
                (sum * length_);
            if (found(float(distance), lane, weights, sum)) return true;
        }
        return false;
    }

private:
    __m256 near_origin_[3], far_origin_[3], inverse_[3];
    __m256 origin_along_, origin_first_, origin_second_, shear_first_, shear_second_;
    double length_;
    int along_, first_, second_;
    bool lower_is_near_[3];
};

// Each node on the way down leaves at most width - 1 children behind.
constexpr std::size_t stack_size = (RayBvh::width - 1) * BuiltTree::max_depth + 1;

template <class Listener>
void tell_entered(Listener& listener, unsigned children) {
    if constexpr (requires { listener.entered(children); })
        listener.entered(static_cast<unsigned>(std::popcount(children)));
}

}  // namespace cast_detail

/// The nearest triangle that the ray meets; of several at the same distance the one with the smallest number.
template <class Listener = UnheardCast>
Meeting closest(const RayBvh& bvh, const Ray& ray, Listener&& listener = {}) {
    Meeting best;
    best.distance = ray.farthest;
    if (bvh.empty()) return best;
    const cast_detail::Prepared prepared(ray, bvh.bounds());
    const RayBvh::Node* const nodes = bvh.nodes().data();
    const RayBvh::Block* const blocks = bvh.blocks().data();

    // Entry distances are not negative, so their bit patterns sort as they do: (distance, child).
    std::uint64_t stack[cast_detail::stack_size];
    std::size_t height = 0;
    std::uint32_t at = bvh.root();
    for (;;) {
        if (at & RayBvh::leaf_bit) {
            const std::uint32_t number = at & ~RayBvh::leaf_bit;
            const RayBvh::Block& block = blocks[number];
            listener.block(number);
            prepared.meet(block, [&](float distance, unsigned lane, const double* weights, double sum) {
                const std::uint32_t triangle = block.triangles[lane];
                if (distance > ray.nearest &&
                    (distance < best.distance || (distance == best.distance && triangle < best.triangle)))
                    best = {distance, triangle, {weights[0], weights[1], weights[2]}, sum};
                return false;
            });
        } else {
            alignas(32) float entry[RayBvh::width];
            const RayBvh::Node& node = nodes[at];
            listener.node(at);
            unsigned entered = prepared.enter(node, ray.nearest, best.distance, entry);
            cast_detail::tell_entered(listener, entered);
            // The farthest first, so that the nearest lies on top.
            for (const std::size_t floor = height; entered != 0; entered &= entered - 1) {
                const auto i = unsigned(std::countr_zero(entered));
                const std::uint64_t key =
                    std::uint64_t{std::bit_cast<std::uint32_t>(entry[i])} << 32 | node.children[i];
                std::size_t place = height++;
                for (; place > floor && stack[place - 1] < key; --place) stack[place] = stack[place - 1];
                stack[place] = key;
            }
        }
        do {
            if (height == 0) return best;
            --height;
        } while (std::bit_cast<float>(std::uint32_t(stack[height] >> 32)) > best.distance);
        at = std::uint32_t(stack[height]);
    }
}

/// Does the ray meet any triangle?
template <class Listener = UnheardCast>
bool occluded(const RayBvh& bvh, const Ray& ray, Listener&& listener = {}) {
    if (bvh.empty()) return false;
    const cast_detail::Prepared prepared(ray, bvh.bounds());
    const RayBvh::Node* const nodes = bvh.nodes().data();
    const RayBvh::Block* const blocks = bvh.blocks().data();
    std::uint32_t stack[cast_detail::stack_size];
    std::size_t height = 0;
    stack[height++] = bvh.root();
    while (height > 0) {
        const std::uint32_t at = stack[--height];
        if (at & RayBvh::leaf_bit) {
            const std::uint32_t number = at & ~RayBvh::leaf_bit;
            listener.block(number);
            if (prepared.meet(blocks[number], [&](float distance, unsigned, const double*, double) {
                    return distance > ray.nearest && distance <= ray.farthest;
                }))
                return true;
        } else {
            alignas(32) float entry[RayBvh::width];
            listener.node(at);
            unsigned entered = prepared.enter(nodes[at], ray.nearest, ray.farthest, entry);
            cast_detail::tell_entered(listener, entered);
            for (; entered != 0; entered &= entered - 1)
                stack[height++] = nodes[at].children[std::countr_zero(entered)];
        }
    }
    return false;
}

}  // namespace regather::spatial
