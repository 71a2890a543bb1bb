#include "capture/irradiance/occlusion_hessian.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace regather::capture {
namespace {

constexpr double most_anisotropy = 2;
constexpr double least_height = 1e-5;  // of an edge's line over the point, as a share of the farther corner

}  // namespace

// With p(t) = from + t e, e = to - from, the part is f(x) I(x) / 2, f = normal . (from x e) and I the
// integral of 1 / |p|^2 over t in [0, 1] (which is the angle over |from x e|). f is linear in the point x,
// its gradient g = normal x e; the gradient of I is the integral of 2 p / |p|^4, its second derivative that
// of 8 p p^T / |p|^6 - 2 / |p|^4. With p = h + s u, u along the edge and h at right angles to it, those are
// integrals of s^m / (h^2 + s^2)^n.
PlaneHessian edge_hessian(Vec3d from, Vec3d to) {
    const Vec3d edge = to - from;
    const double edge_length = trace::length(edge);
    if (!(edge_length > 0)) return {};
    const Vec3d along = edge * (1 / edge_length), normal_part = trace::cross(from, along);
    const double height = trace::length(normal_part);
    const double farther = std::sqrt(std::max(trace::dot(from, from), trace::dot(to, to)));
    if (!(height > least_height * farther)) return {};
    const double begin = trace::dot(from, along), end = trace::dot(to, along), height2 = height * height;
    const Vec3d off = from - along * begin;
    const double angle = std::atan2(trace::length(trace::cross(from, to)), trace::dot(from, to));
    const auto between = [&](auto&& antiderivative) {
        return antiderivative(end, height2 + end * end) - antiderivative(begin, height2 + begin * begin);
    };
    const double fourth =
        between([&](double s, double d2) { return s / d2; }) / (2 * height2) + angle / (2 * height * height2);
    const double fourth_s = between([](double, double d2) { return -1 / (2 * d2); });
    const double sixth = between([](double s, double d2) { return s / (d2 * d2); }) / (4 * height2) +
                         3 * fourth / (4 * height2);
    const double sixth_s = between([](double, double d2) { return -1 / (4 * d2 * d2); });
    const double sixth_ss = fourth - height2 * sixth;
    // In t: ds = edge_length dt.
    const double scale = 1 / edge_length;
    const Vec3d gradient = (off * fourth + along * fourth_s) * (2 * scale);
    const auto second = [&](int a, int b) {
        return scale * (8 * (off[a] * off[b] * sixth + (off[a] * along[b] + along[a] * off[b]) * sixth_s +
                             along[a] * along[b] * sixth_ss) -
                        (a == b ? 2 * fourth : 0));
    };
    const double f = normal_part.z * edge_length;
    const Vec3d g{-edge.y, edge.x, 0};
    const auto entry = [&](int a, int b) {
        return 0.5 * (g[a] * gradient[b] + gradient[a] * g[b] + f * second(a, b));
    };
    return {entry(0, 0), entry(0, 1), entry(1, 1)};
}

PlaneHessian occlusion_hessian(const HemisphereGrid& grid, const Frame& frame,
                               std::span<const Incoming> incoming, double far) {
    const std::uint32_t rows = grid.rows(), columns = grid.columns();
    struct Met {
        Vec3d place;  // in the frame, relative to the point
        double distance, light;
    };
    std::vector<Met> met;
    met.reserve(incoming.size());
    const Vec3d tangent = frame.tangent, bitangent = frame.bitangent, normal = frame.normal;
    for (const Incoming& sample : incoming) {
        const double distance = std::min(distance_of(sample), far);
        const Vec3d direction = sample.direction, light = radiance_of(sample);
        met.push_back(
            {Vec3d{dot(direction, tangent), dot(direction, bitangent), dot(direction, normal)} * distance,
             distance, light.x + light.y + light.z});
    }
    const auto at = [&](std::uint32_t j, std::uint32_t k) -> const Met& {
        return met[std::size_t{j} * columns + k % columns];
    };
    const auto farthest = [](const Met& a, const Met& b) -> const Met& {
        return b.distance > a.distance ? b : a;
    };
    PlaneHessian sum;
    // An edge with the light of the face that turns with it from x towards y, and of the other.
    const auto add = [&](const Met& from, const Met& to, double with, double other) {
        if (with != other) sum += edge_hessian(from.place, to.place) * (with - other);
    };
    // Of each quadrangle between rows j and j + 1 and columns k and k + 1: the triangle that has both its
    // corners in row j, and the one that has both in row j + 1.
    const auto inner = [&](std::uint32_t j, std::uint32_t k) {
        return farthest(farthest(at(j, k), at(j, k + 1)), at(j + 1, k)).light;
    };
    const auto outer = [&](std::uint32_t j, std::uint32_t k) {
        return farthest(farthest(at(j, k + 1), at(j + 1, k)), at(j + 1, k + 1)).light;
    };
    const Met* cap = &met[0];  // the face about the normal
    for (std::uint32_t k = 1; k < columns; ++k) cap = &farthest(*cap, at(0, k));
    for (std::uint32_t j = 0; j + 1 < rows; ++j)
        for (std::uint32_t k = 0; k < columns; ++k) {
            const double here = inner(j, k);
            add(at(j, k), at(j + 1, k), here, outer(j, k + columns - 1));
            add(at(j + 1, k), at(j, k + 1), here, outer(j, k));
            add(at(j, k), at(j, k + 1), j == 0 ? cap->light : outer(j - 1, k), here);
        }
    return sum;
}

PlaneEllipse ellipse_of(PlaneHessian hessian, double irradiance, double error, double longest) {
    const double mean = (hessian.xx + hessian.yy) / 2, half = (hessian.xx - hessian.yy) / 2;
    const double spread = std::sqrt(half * half + hessian.xy * hessian.xy);
    const double first = std::fabs(mean + spread), second = std::fabs(mean - spread);
    const auto radius = [&](double lambda) {
        const double relative = irradiance > 0 ? lambda / irradiance : 0;
        const double found = std::sqrt(std::sqrt(4 * error / (std::numbers::pi * relative)));
        return found < longest ? found : longest;  // also where there is no curvature, or no number
    };
    PlaneEllipse ellipse;
    ellipse.shorter = radius(std::max(first, second));
    ellipse.longer = std::min(radius(std::min(first, second)), most_anisotropy * ellipse.shorter);
    // (half + spread, xy) and (xy, spread - half) both point along mean + spread; the longer one is exact.
    double x = half + spread, y = hessian.xy;
    if (half < 0) {
        x = hessian.xy;
        y = spread - half;
    }
    const double norm = std::sqrt(x * x + y * y);
    if (!(norm > 0)) return ellipse;
    const bool along_first = first <= second;
    ellipse.x = (along_first ? x : -y) / norm;
    ellipse.y = (along_first ? y : x) / norm;
    return ellipse;
}

}  // namespace regather::capture
