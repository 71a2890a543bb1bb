// trace/vec3d.h -- three doubles: positions and directions where floats would lose what is asked for, and
// sums of RGB. One operation an operator, summed in the order x, y, z.
#pragma once
#include <cmath>

#include "trace/vec.h"

namespace regather::trace {

struct Vec3d {
    double x = 0, y = 0, z = 0;

    constexpr Vec3d() = default;
    constexpr Vec3d(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    /// The same values; exact.
    constexpr Vec3d(Vec3 v) : x(v.x), y(v.y), z(v.z) {}

    double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    Vec3d& operator+=(Vec3d o) { return *this = {x + o.x, y + o.y, z + o.z}; }
    friend bool operator==(Vec3d, Vec3d) = default;
};

inline Vec3d operator+(Vec3d a, Vec3d b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3d operator-(Vec3d a, Vec3d b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3d operator-(Vec3d a) {
    return {-a.x, -a.y, -a.z};
}
inline Vec3d operator*(Vec3d a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline Vec3d operator*(double s, Vec3d a) {
    return a * s;
}
inline double dot(Vec3d a, Vec3d b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3d cross(Vec3d a, Vec3d b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3d a) {
    return std::sqrt(dot(a, a));
}
/// Each component rounded to the nearest float.
inline Vec3 to_float(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace regather::trace
