#include "imports/maps/free_space.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace regather::imports {

namespace {

// Where the line a + t (b - a) meets the triangle, 0 <= t <= 1 (T. Moeller & B. Trumbore, "Fast, Minimum
// Storage Ray/Triangle Intersection", 1997), in double precision.
std::optional<double> meeting(Vec3 a, Vec3 b, const std::array<Vec3, 3>& triangle) {
    struct D {
        double x, y, z;
    };
    const auto minus = [](Vec3 p, Vec3 q) {
        return D{double{p.x} - double{q.x}, double{p.y} - double{q.y}, double{p.z} - double{q.z}};
    };
    const auto dot_of = [](D p, D q) { return p.x * q.x + p.y * q.y + p.z * q.z; };
    const auto cross_of = [](D p, D q) {
        return D{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    };
    const D way = minus(b, a), e1 = minus(triangle[1], triangle[0]), e2 = minus(triangle[2], triangle[0]);
    const D p = cross_of(way, e2);
    const double determinant = dot_of(e1, p);
    if (determinant == 0) return std::nullopt;
    const D from = minus(a, triangle[0]);
    const double u = dot_of(from, p) / determinant;
    const D q = cross_of(from, e1);
    const double v = dot_of(way, q) / determinant, t = dot_of(e2, q) / determinant;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1)) return std::nullopt;
    return t;
}

constexpr std::size_t block_triangles = 32;

bool apart(const trace::Bounds3& a, const trace::Bounds3& b) {
    return a.max.x < b.min.x || b.max.x < a.min.x || a.max.y < b.min.y || b.max.y < a.min.y ||
           a.max.z < b.min.z || b.max.z < a.min.z;
}

}  // namespace

FreeSpace::FreeSpace(const Bsp& bsp, std::span<const std::array<Vec3, 3>> triangles)
    : bsp_(bsp), triangles_(triangles) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (i % block_triangles == 0) blocks_.emplace_back();
        blocks_.back().include(trace::bounds_of(triangles[i]));
    }
}

// Calls visit(index) for all triangles whose boxes meet that of the line, until it says true.
template <class Visit>
void FreeSpace::visit_near(Vec3 a, Vec3 b, Visit visit) const {
    const trace::Bounds3 line = trace::bounds_of(std::array{a, b});
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
        if (apart(blocks_[block], line)) continue;
        const std::size_t end = std::min((block + 1) * block_triangles, triangles_.size());
        for (std::size_t i = block * block_triangles; i < end; ++i)
            if (!apart(trace::bounds_of(triangles_[i]), line) && visit(i)) return;
    }
}

bool FreeSpace::in_solid(const BspLeaf& leaf, Vec3 point, float radius) const {
    if (leaf.cluster < 0) return true;
    for (std::uint32_t i = 0; i < leaf.brush_count; ++i) {
        const BspBrush& brush = bsp_.brushes[bsp_.leaf_brushes[leaf.first_brush + i]];
        if ((bsp_.textures[brush.texture].contents & BspTexture::solid) == 0 || brush.side_count == 0)
            continue;
        bool inside = true;
        for (std::uint32_t side = 0; side < brush.side_count && inside; ++side) {
            const BspPlane& plane = bsp_.planes[bsp_.side_planes[brush.first_side + side]];
            inside = dot(plane.normal, point) - plane.distance <= radius;
        }
        if (inside) return true;
    }
    return false;
}

bool FreeSpace::clear(Vec3 point, float radius) const {
    if (bsp_.leaves.empty()) return true;
    if (bsp_.nodes.empty()) return !in_solid(bsp_.leaves[0], point, radius);
    std::vector<std::int32_t> open{0};
    while (!open.empty()) {
        const std::int32_t at = open.back();
        open.pop_back();
        if (at < 0) {
            if (in_solid(bsp_.leaves[static_cast<std::size_t>(-(at + 1))], point, radius)) return false;
            continue;
        }
        const BspNode& node = bsp_.nodes[static_cast<std::size_t>(at)];
        const BspPlane& plane = bsp_.planes[node.plane];
        const float distance = dot(plane.normal, point) - plane.distance;
        if (distance >= -radius) open.push_back(node.children[0]);
        if (distance < radius) open.push_back(node.children[1]);
    }
    return true;
}

std::optional<std::size_t> FreeSpace::first_met(Vec3 a, Vec3 b) const {
    std::optional<std::size_t> first;
    double nearest = 2;
    visit_near(a, b, [&](std::size_t i) {
        const auto t = meeting(a, b, triangles_[i]);
        if (t && *t < nearest) first = i, nearest = *t;
        return false;
    });
    return first;
}

bool FreeSpace::crosses(Vec3 a, Vec3 b) const {
    bool found = false;
    visit_near(a, b, [&](std::size_t i) { return found = meeting(a, b, triangles_[i]).has_value(); });
    return found;
}

bool FreeSpace::clear(Vec3 a, Vec3 b, float radius) const {
    const float distance = length(b - a);
    const int steps = 1 + static_cast<int>(std::min(distance / (0.5f * radius), 1e6f));
    for (int i = 0; i <= steps; ++i)
        if (!clear(a + (b - a) * (static_cast<float>(i) / static_cast<float>(steps)), radius)) return false;
    const Vec3 level{b.y - a.y, a.x - b.x, 0};
    const Vec3 aside = length(level) > 0 ? level * (radius / length(level)) : Vec3{radius, 0, 0};
    const Vec3 above{0, 0, radius};
    for (const Vec3 offset : {Vec3{}, aside, -aside, above, -above})
        if (crosses(a + offset, b + offset)) return false;
    return true;
}

std::optional<float> FreeSpace::floor_below(Vec3 point, float reach) const {
    const Vec3 end{point.x, point.y, point.z - reach};
    const auto floor = first_met(point, end);
    if (!floor) return std::nullopt;
    return point.z - reach * static_cast<float>(*meeting(point, end, triangles_[*floor]));
}

}  // namespace regather::imports
