// trace/bounds.h -- axis-aligned boxes [scene units].
#pragma once
#include <limits>
#include <span>

#include "trace/vec.h"

namespace regather::trace {

/// Empty (min > max) until something is included.
struct Bounds3 {
    Vec3 min{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
             std::numeric_limits<float>::infinity()};
    Vec3 max{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
             -std::numeric_limits<float>::infinity()};

    bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    Vec3 extent() const { return empty() ? Vec3{} : max - min; }
    void include(Vec3 p) {
        for (int axis = 0; axis < 3; ++axis) {
            if (p[axis] < min[axis]) min[axis] = p[axis];
            if (p[axis] > max[axis]) max[axis] = p[axis];
        }
    }
    void include(const Bounds3& other) {
        if (other.empty()) return;
        include(other.min);
        include(other.max);
    }
    friend bool operator==(const Bounds3&, const Bounds3&) = default;
};

/// Of the finite points; NaN and infinite ones are left out.
inline Bounds3 bounds_of(std::span<const Vec3> points) {
    Bounds3 box;
    for (Vec3 p : points)
        if (is_finite(p)) box.include(p);
    return box;
}

}  // namespace regather::trace
