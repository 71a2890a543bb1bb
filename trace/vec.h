// trace/vec.h -- three numbers: positions and directions [scene units, metres by convention] and RGB triples.
// One operation an operator, summed in the order x, y, z.
#pragma once
#include <cmath>
#include <concepts>
#include <type_traits>

namespace regather::trace {

template <std::floating_point T>
struct Vector3 {
    T x = 0, y = 0, z = 0;

    /// The same values as doubles; exact.
    constexpr operator Vector3<double>() const requires std::same_as<T, float> { return {x, y, z}; }

    T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    Vector3& operator+=(Vector3 o) { return *this = *this + o; }
    friend bool operator==(const Vector3&, const Vector3&) = default;

    friend constexpr Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vector3 operator-(Vector3 a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vector3 operator*(Vector3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vector3 operator*(T s, Vector3 a) { return a * s; }
    /// By component.
    friend constexpr Vector3 operator*(Vector3 a, Vector3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
};

using Vec3 = Vector3<float>;
using Vec3d = Vector3<double>;  ///< Where floats would lose what is asked for, and for sums of RGB.
static_assert(sizeof(Vec3) == 12 && std::is_trivially_copyable_v<Vec3>);

template <class T>
T dot(Vector3<T> a, Vector3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vector3<T> cross(Vector3<T> a, Vector3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(Vector3<T> a) {
    return std::sqrt(dot(a, a));
}
template <class T>
Vector3<T> normalize(Vector3<T> a) {
    return a * (T{1} / length(a));
}
template <class T>
bool is_finite(Vector3<T> a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
template <class T>
T max_component(Vector3<T> a) {
    return std::fmax(a.x, std::fmax(a.y, a.z));
}
/// Each component rounded to the nearest float.
inline Vec3 to_float(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace regather::trace
