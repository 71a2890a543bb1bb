#include "capture/light/lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "capture/light/bsdf.h"
#include "scenes/tessellation.h"

namespace regather::capture {
namespace {

using trace::Vec3d;

constexpr std::size_t most_single_lights = 64;
constexpr double rounding = 0x1p-20;  // of float coordinates: a few times their own

double component_sum(Vec3 v) {
    return static_cast<double>(v.x) + v.y + v.z;
}

/// Rounded once: a point of a plane z = constant has that z to the last bit.
Vec3 spanned(Vec3 corner, Vec3 edge_u, double u, Vec3 edge_v, double v) {
    return to_float(Vec3d(corner) + Vec3d(edge_u) * u + Vec3d(edge_v) * v);
}

/// Where `at` falls in rising partial sums, at a step of more than 0.
std::size_t find_step(std::span<const double> cumulative, double at) {
    auto step = std::upper_bound(cumulative.begin(), cumulative.end(), at);
    if (step == cumulative.end())
        step = std::lower_bound(cumulative.begin(), cumulative.end(), cumulative.back());
    return static_cast<std::size_t>(step - cumulative.begin());
}

}  // namespace

LightSampler::LightSampler(const Scene& scene) : scene_(scene), lights_(scene.lights.size()) {
    Vec3d power;
    for (std::uint32_t l = 0; l < lights_.size(); ++l) {
        measure(l);
        if (!(lights_[l].bound.power > 0)) continue;
        order_.push_back(l);
        for (int c = 0; c < 3; ++c)
            power[c] += std::numbers::pi * scene.lights[l].radiance[c] / lights_[l].density;
    }
    total_power_ = to_float(power);

    const std::size_t lit = order_.size();
    divide(0, lit,
           lit <= most_single_lights ? 1 : static_cast<std::size_t>(std::sqrt(static_cast<double>(lit))));
    if (lit > 0) group_first_.push_back(lit);
    double sum = 0;
    for (const std::uint32_t l : order_) cumulative_power_.push_back(sum += lights_[l].bound.power);
}

/// Box, plane, area and power of a light.
void LightSampler::measure(std::uint32_t l) {
    const scenes::AreaLight& light = scene_.lights[l];
    Light& own = lights_[l];
    Bound& bound = own.bound;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    bound.low = {infinity, infinity, infinity};
    bound.high = {-infinity, -infinity, -infinity};
    const auto enclose = [&](Vec3d point) {
        for (int axis = 0; axis < 3; ++axis) {
            bound.low[axis] = std::min(bound.low[axis], point[axis]);
            bound.high[axis] = std::max(bound.high[axis], point[axis]);
        }
    };
    double area = 0;
    Vec3d normal;  // times the area
    const auto corner = [&](std::uint32_t triangle, std::size_t i) {
        return scene_.vertices[scene_.triangles[triangle][i]];
    };
    const std::uint32_t first = light.first_triangle, last = first + light.triangle_count;
    if (light.is_mesh()) {
        own.first_area = areas_.size();
        for (std::uint32_t t = first; t < last; ++t) {
            areas_.push_back(area += scenes::triangle_area(corner(t, 0), corner(t, 1), corner(t, 2)));
            for (std::size_t i = 0; i < 3; ++i) enclose(corner(t, i));
            const Vec3d a = corner(t, 0);
            normal += 0.5 * cross(Vec3d(corner(t, 1)) - a, Vec3d(corner(t, 2)) - a);
        }
    } else {
        for (const float u : {0.0f, 1.0f})
            for (const float v : {0.0f, 1.0f}) enclose(light.corner + light.edge_u * u + light.edge_v * v);
        normal = cross(Vec3d(light.edge_u), Vec3d(light.edge_v));
        area = length(normal);
    }
    if (!(area > 0)) return;

    own.density = 1 / area;
    bound.power = std::numbers::pi * area * component_sum(light.radiance);
    bound.radius = 0.5 * length(bound.high - bound.low);
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::fabs(bound.low[axis]), std::fabs(bound.high[axis])});
    // The areas of triangles that face the same way add up to the length of the sum of their normals.
    const double facing = length(normal);
    bound.flat = facing >= area * (1 - 1e-9);
    if (!bound.flat) return;
    normal = {normal.x / facing, normal.y / facing, normal.z / facing};
    bound.plane_normal = normal;
    bound.plane_offset = dot(normal, Vec3d(light.is_mesh() ? corner(first, 0) : light.corner));
    bound.plane_slack = largest * rounding;
    for (std::uint32_t t = first; t < last; ++t)
        for (std::size_t i = 0; i < 3; ++i)
            bound.plane_slack = std::max(
                bound.plane_slack,
                largest * rounding + std::fabs(dot(normal, Vec3d(corner(t, i))) - bound.plane_offset));
}

/// Groups of at most `most` neighbours among order_[first, last): halves along the longest side of their
/// centres.
void LightSampler::divide(std::size_t first, std::size_t last, std::size_t most) {
    if (first == last) return;
    Bound all = lights_[order_[first]].bound;
    for (std::size_t i = first; i < last; ++i) {
        const Bound& bound = lights_[order_[i]].bound;
        for (int axis = 0; axis < 3; ++axis) {
            all.low[axis] = std::min(all.low[axis], bound.low[axis]);
            all.high[axis] = std::max(all.high[axis], bound.high[axis]);
        }
    }
    if (last - first <= most) {
        for (std::size_t i = first; i < last; ++i)
            lights_[order_[i]].group = static_cast<std::uint32_t>(groups_.size());
        if (last - first > 1) {
            all.power = 0;
            for (std::size_t i = first; i < last; ++i) all.power += lights_[order_[i]].bound.power;
            all.radius = 0.5 * length(all.high - all.low);
            all.flat = false;
        }
        group_first_.push_back(first);
        groups_.push_back(all);
        return;
    }
    const Vec3d size = all.high - all.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto centre = [&](std::uint32_t l) {
        return lights_[l].bound.low[axis] + lights_[l].bound.high[axis];
    };
    const std::size_t middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first),
                     order_.begin() + static_cast<std::ptrdiff_t>(middle),
                     order_.begin() + static_cast<std::ptrdiff_t>(last),
                     [&](std::uint32_t a, std::uint32_t b) {
                         return centre(a) != centre(b) ? centre(a) < centre(b) : a < b;
                     });
    divide(first, middle, most);
    divide(middle, last, most);
}

std::span<const std::uint32_t> LightSampler::members(std::size_t group) const {
    return std::span(order_).subspan(group_first_[group], group_first_[group + 1] - group_first_[group]);
}

Emission LightSampler::emit(Sampler& sampler) const {
    const std::size_t chosen =
        find_step(cumulative_power_, sampler.fine_uniform() * cumulative_power_.back());
    const std::uint32_t light = order_[chosen];
    const double u = sampler.fine_uniform(), v = sampler.fine_uniform();
    const float s = sampler.uniform(), t = sampler.uniform();
    const LightPoint from = sample_light(light, u, v);
    const double factor = cumulative_power_.back() / component_sum(from.radiance);
    const auto power = [&](float radiance) { return static_cast<float>(radiance * factor); };
    return {from.position,
            from.normal,
            Frame(from.normal).to_world(cosine_hemisphere(s, t)),
            {power(from.radiance.x), power(from.radiance.y), power(from.radiance.z)},
            light};
}

LightPoint LightSampler::sample_light(std::uint32_t l, double u, double v) const {
    const scenes::AreaLight& light = scene_.lights[l];
    LightPoint point{{}, {}, light.radiance, lights_[l].density, l};
    if (!light.is_mesh()) {
        point.position = spanned(light.corner, light.edge_u, u, light.edge_v, v);
        point.normal = light.normal();
        return point;
    }
    const std::span<const double> areas =
        std::span(areas_).subspan(lights_[l].first_area, light.triangle_count);
    const double at = u * areas.back();
    const std::size_t step = find_step(areas, at);
    const double before = step == 0 ? 0 : areas[step - 1];
    const double again = std::clamp((at - before) / (areas[step] - before), 0.0, 1.0);
    const auto& corners = scene_.triangles[light.first_triangle + step];
    const Vec3 a = scene_.vertices[corners[0]], b = scene_.vertices[corners[1]],
               c = scene_.vertices[corners[2]];
    const double root = std::sqrt(again);
    point.position = spanned(a, b - a, root * (1 - v), c - a, root * v);
    const Vec3d normal = cross(Vec3d(b) - a, Vec3d(c) - a);
    point.normal = to_float(normal * (1 / length(normal)));
    return point;
}

/// Power over squared distance, with the most that the cosines can be: height over the plane through the
/// distance.
double LightSampler::estimate(const Bound& bound, const View& view) {
    double distance2 = 0, above = 0, size = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double x = view.position_[axis], low = bound.low[axis] - x, high = bound.high[axis] - x;
        const double middle = 0.5 * (low + high), side = view.side_[axis];
        distance2 += middle * middle;
        above += std::max(side * low, side * high);
        size += std::fabs(side) *
                (std::fabs(x) + std::max(std::fabs(bound.low[axis]), std::fabs(bound.high[axis])));
    }
    const double slack = size * rounding;
    if (above < -slack) return 0;
    const double nearest = std::sqrt(distance2) - bound.radius;  // or nearer than 0: anywhere
    double cosines = 1;
    if (size > 0 && nearest > 0) cosines = std::min(1.0, std::max(above, slack) / nearest);
    if (bound.flat) {
        const double x_size =
            std::fabs(view.position_[0]) + std::fabs(view.position_[1]) + std::fabs(view.position_[2]);
        const double height = dot(bound.plane_normal, view.position_) - bound.plane_offset;
        const double plane_slack = bound.plane_slack + x_size * rounding;
        if (height < -plane_slack) return 0;
        if (nearest > 0) cosines *= std::min(1.0, std::max(height, plane_slack) / nearest);
    }
    return bound.power * cosines / std::max(distance2, bound.radius * bound.radius);
}

void LightSampler::look(Vec3 position, Vec3 side, View& view) const {
    view.position_ = position;
    view.side_ = side;
    view.cumulative_.resize(groups_.size());
    view.total_ = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g)
        view.cumulative_[g] = view.total_ += estimate(groups_[g], view);
}

double LightSampler::share(const View& view, std::uint32_t light) const {
    const Bound& bound = lights_[light].bound;
    if (view.dark() || !(bound.power > 0)) return 0;
    const std::size_t group = lights_[light].group;
    const double of_group = view.cumulative_[group] - (group == 0 ? 0 : view.cumulative_[group - 1]);
    if (!(of_group > 0)) return 0;
    const std::span<const std::uint32_t> all = members(group);
    if (all.size() == 1) return of_group / view.total_;
    double total = 0;
    for (const std::uint32_t l : all) total += estimate(lights_[l].bound, view);
    return total > 0 ? of_group / view.total_ * (estimate(bound, view) / total) : 0;
}

bool LightSampler::sample(const View& view, double choice, double u, double v, LightPoint& point) const {
    if (view.dark()) return false;
    const double at = choice * view.total_;
    const std::size_t group = find_step(view.cumulative_, at);
    const double before = group == 0 ? 0 : view.cumulative_[group - 1],
                 of_group = view.cumulative_[group] - before;
    const std::span<const std::uint32_t> all = members(group);
    std::uint32_t light = all.front();
    double chance = of_group / view.total_;
    if (all.size() > 1) {
        double total = 0;
        for (const std::uint32_t l : all) total += estimate(lights_[l].bound, view);
        if (!(total > 0)) return false;
        const double inside = std::clamp((at - before) / of_group, 0.0, 1.0) * total;
        double sum = 0, taken = 0;
        for (const std::uint32_t l : all) {
            const double part = estimate(lights_[l].bound, view);
            if (!(part > 0)) continue;
            light = l;
            taken = part;
            if ((sum += part) > inside) break;
        }
        chance *= taken / total;
    }
    point = sample_light(light, u, v);
    point.pdf *= chance;
    return true;
}

}  // namespace regather::capture
