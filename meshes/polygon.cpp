#include "meshes/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace regather::meshes {

namespace {

constexpr std::uint32_t gone = ~0u;

// Twice the area of a, b, c: above 0 when they turn left.
double cross(PlanPoint a, PlanPoint b, PlanPoint c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// 0, 1 or 2: the axis that the normal by Newell's rule is nearest to; `sign`: along or against it.
int main_axis(std::span<const Vec3> polygon, double& sign) {
    std::array<double, 3> normal{};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const Vec3 o = polygon[0];  // near: no cancellation
        const double ax = double{a.x} - o.x, ay = double{a.y} - o.y, az = double{a.z} - o.z;
        const double bx = double{b.x} - o.x, by = double{b.y} - o.y, bz = double{b.z} - o.z;
        normal[0] += ay * bz - az * by;
        normal[1] += az * bx - ax * bz;
        normal[2] += ax * by - ay * bx;
    }
    int axis = 2;
    for (const int other : {1, 0})
        if (std::abs(normal[static_cast<std::size_t>(other)]) >
            std::abs(normal[static_cast<std::size_t>(axis)]))
            axis = other;
    sign = normal[static_cast<std::size_t>(axis)] < 0 ? -1 : 1;
    return axis;
}

}  // namespace

double twice_area(std::span<const PlanPoint> polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const PlanPoint a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        sum += a.x * b.y - b.x * a.y;
    }
    return sum;
}

Triangulator::Result Triangulator::fill(std::span<const PlanPoint> polygon) {
    const double sign = twice_area(polygon) < 0 ? -1 : 1;
    points_.clear();
    for (const PlanPoint p : polygon) points_.push_back({sign * p.x, p.y});
    return fill_points();
}

Triangulator::Result Triangulator::fill(std::span<const Vec3> polygon) {
    triangles_.clear();
    if (polygon.size() == 3) {
        triangles_.push_back({0, 1, 2});
        return Result::whole;
    }
    double sign = 1;
    const int axis = main_axis(polygon, sign);
    points_.clear();
    for (const Vec3 p : polygon) points_.push_back({sign * p[(axis + 1) % 3], double{p[(axis + 2) % 3]}});
    return fill_points();
}

// The points run counter-clockwise.
Triangulator::Result Triangulator::fill_points() {
    triangles_.clear();
    if (points_.size() < 3) return Result::whole;
    if (is_convex()) {
        fan(0, points_.size());
        return Result::whole;
    }
    if (points_.size() > most_concave_corners) return Result::too_large;
    return clip() ? Result::whole : Result::crosses_itself;
}

// Strictly, and once round: all triangles of the fan turn left, too.
bool Triangulator::is_convex() const {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
        const PlanPoint a = points_[i], b = points_[(i + 1) % n], c = points_[(i + 2) % n];
        if (!(cross(a, b, c) > 0)) return false;
        if (i > 0 && i + 1 < n && !(cross(points_[0], a, b) > 0)) return false;
    }
    return true;
}

void Triangulator::fan(std::uint32_t first, std::size_t corners) {
    const bool all = corners == points_.size();
    std::uint32_t b = all ? (first + 1) % static_cast<std::uint32_t>(corners) : next_[first];
    for (std::size_t t = 0; t + 2 < corners; ++t) {
        const std::uint32_t c = all ? (b + 1) % static_cast<std::uint32_t>(corners) : next_[b];
        triangles_.push_back({first, b, c});
        b = c;
    }
}

double Triangulator::turn(std::uint32_t corner) const {
    return cross(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
}

// It turns left, and no other corner lies in its triangle. Only corners that do not turn left need be asked:
// of any that lie inside, the one nearest to the ear's tip is one of them.
bool Triangulator::is_ear(std::uint32_t corner) {
    const PlanPoint a = points_[previous_[corner]], b = points_[corner], c = points_[next_[corner]];
    if (!(cross(a, b, c) > 0)) return false;
    for (std::size_t i = 0; i < blockers_.size();) {
        if (next_[blockers_[i]] == gone || turn(blockers_[i]) > 0) {
            blockers_[i] = blockers_.back();
            blockers_.pop_back();
            continue;
        }
        const PlanPoint p = points_[blockers_[i++]];
        if (p == a || p == b || p == c) continue;
        if (cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0) return false;
    }
    return true;
}

void Triangulator::cut(std::uint32_t corner) {
    const std::uint32_t before = previous_[corner], after = next_[corner];
    triangles_.push_back({before, corner, after});
    next_[before] = after;
    previous_[after] = before;
    next_[corner] = gone;
    --left_;
}

// False when no ear is left before the end. A corner that is no ear becomes one only when a neighbour goes,
// or a corner in its triangle; the latter is found when all are asked again.
bool Triangulator::clip() {
    const auto n = static_cast<std::uint32_t>(points_.size());
    left_ = n;
    next_.resize(n);
    previous_.resize(n);
    blockers_.clear();
    for (std::uint32_t i = 0; i < n; ++i) {
        next_[i] = (i + 1) % n;
        previous_[i] = (i + n - 1) % n;
    }
    for (std::uint32_t i = 0; i < n; ++i)
        if (!(turn(i) > 0)) blockers_.push_back(i);
    const auto ask = [&](std::uint32_t corner) {
        if (next_[corner] == gone || !is_ear(corner)) return false;
        const std::uint32_t neighbours[]{previous_[corner], next_[corner]};
        const bool turned_left[]{turn(neighbours[0]) > 0, turn(neighbours[1]) > 0};
        cut(corner);
        for (const std::size_t i : {0, 1}) {
            candidates_.push_back(neighbours[i]);
            if (turned_left[i] && !(turn(neighbours[i]) > 0)) blockers_.push_back(neighbours[i]);
        }
        return true;
    };
    while (left_ > 3) {
        candidates_.clear();
        for (std::uint32_t i = 0; i < n; ++i)
            if (next_[i] != gone) candidates_.push_back(i);
        bool has_cut = false;
        for (std::size_t i = 0; i < candidates_.size() && left_ > 3; ++i) has_cut |= ask(candidates_[i]);
        if (has_cut) continue;
        // Spikes and corners that stand twice: a corner without an area goes.
        std::uint32_t some = gone, flat = gone;
        for (std::uint32_t i = 0; i < n && flat == gone; ++i) {
            if (next_[i] == gone) continue;
            some = i;
            if (turn(i) == 0) flat = i;
        }
        if (flat == gone) {
            fan(some, left_);
            return false;
        }
        cut(flat);
    }
    for (std::uint32_t i = 0; i < n; ++i)
        if (next_[i] != gone) {
            triangles_.push_back({i, next_[i], next_[next_[i]]});
            return turn(i) >= 0;
        }
    return true;
}

std::vector<Triangle> triangulate(std::span<const PlanPoint> polygon) {
    Triangulator triangulator;
    triangulator.fill(polygon);
    const double sign = twice_area(polygon) < 0 ? -1 : 1;
    std::vector<Triangle> triangles;
    for (const Triangle& t : triangulator.triangles())
        if (sign * cross(polygon[t[0]], polygon[t[1]], polygon[t[2]]) > 0) triangles.push_back(t);
    return triangles;
}

}  // namespace regather::meshes
