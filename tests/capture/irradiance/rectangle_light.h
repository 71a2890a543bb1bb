// tests/capture/irradiance/rectangle_light.h -- the irradiance of a plane under a polygon, in closed form
// (Lambert 1760), and hemispheres of samples of it.
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "capture/irradiance/irradiance_estimate.h"
#include "capture/sampler.h"

namespace regather::capture {

inline constexpr Vec3 upwards{0, 0, 1};
inline constexpr float unmet = INFINITY;  ///< The distance where nothing is met.

/// What a convex polygon of radiance 1, all of it above the horizon, sends to a point with this normal.
inline double lambert(std::span<const Vec3d> corners, Vec3d point, Vec3d normal) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = trace::normalize(corners[i] - point),
                    b = trace::normalize(corners[(i + 1) % corners.size()] - point);
        sum += std::acos(trace::dot(a, b)) * trace::dot(trace::normalize(trace::cross(a, b)), normal);
    }
    return std::fabs(sum) / 2;
}

/// Edges at right angles.
struct Rectangle {
    Vec3d corner, u, v;
    std::array<Vec3d, 4> corners() const { return {corner, corner + u, corner + u + v, corner + v}; }
    /// How far along the direction it lies.
    std::optional<double> met(Vec3d from, Vec3d direction) const {
        const Vec3d normal = trace::cross(u, v);
        const double distance = trace::dot(corner - from, normal) / trace::dot(direction, normal);
        if (!(distance > 0)) return {};
        const Vec3d at = from + direction * distance - corner;
        const double x = trace::dot(at, u) / trace::dot(u, u), y = trace::dot(at, v) / trace::dot(v, v);
        if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return {};
        return distance;
    }
};

/// One random sample of each cell; `seen`: what is met in a direction.
template <class Seen>
std::vector<Incoming> hemisphere(const HemisphereGrid& grid, const Frame& frame, Seen&& seen,
                                 std::uint64_t seed = 1) {
    std::vector<Incoming> all;
    for (std::uint32_t cell = 0; cell < grid.cells(); ++cell) {
        Sampler sampler(seed, Stream::gather, cell);
        const float u = sampler.uniform(), v = sampler.uniform();
        Incoming sample;
        sample.direction = frame.to_world(grid.direction(cell, u, v));
        seen(sample);
        all.push_back(sample);
    }
    return all;
}

/// What a rectangle of this radiance shows; nothing is behind it.
inline auto light_of(const Rectangle& rectangle, Vec3 from, Vec3 radiance) {
    return [=](Incoming& sample) {
        const std::optional<double> distance = rectangle.met(from, sample.direction);
        if (!distance) return;
        sample.distance = static_cast<float>(*distance);
        sample.radiance = radiance;
    };
}

/// The derivative of `value` along `step`, by central differences.
inline double slope(const std::function<double(Vec3d)>& value, Vec3d step) {
    return (value(step) - value(-step)) / (2 * trace::length(step));
}

}  // namespace regather::capture
