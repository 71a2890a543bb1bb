#include "imports/homes/polygon.h"

#include <algorithm>
#include <numeric>

namespace regather::imports {

namespace {

double cross(PlanPoint a, PlanPoint b, PlanPoint c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
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

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const PlanPoint> polygon) {
    const double sign = twice_area(polygon) < 0 ? -1 : 1;
    std::vector<std::uint32_t> left(polygon.size());
    std::iota(left.begin(), left.end(), 0u);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    const auto corner = [&](std::size_t i) { return polygon[left[i % left.size()]]; };

    const auto is_ear = [&](std::size_t i) {
        const PlanPoint a = corner(i + left.size() - 1), b = corner(i), c = corner(i + 1);
        if (sign * cross(a, b, c) <= 0) return false;
        return std::none_of(left.begin(), left.end(), [&](std::uint32_t other) {
            const PlanPoint p = polygon[other];
            if (p == a || p == b || p == c) return false;
            return sign * cross(a, b, p) >= 0 && sign * cross(b, c, p) >= 0 && sign * cross(c, a, p) >= 0;
        });
    };
    const auto cut = [&](std::size_t i) {
        const std::size_t n = left.size();
        triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    };
    while (left.size() >= 3) {
        std::size_t flat = left.size(), ear = left.size();
        for (std::size_t i = 0; i < left.size() && flat == left.size() && ear == left.size(); ++i) {
            if (cross(corner(i + left.size() - 1), corner(i), corner(i + 1)) == 0)
                flat = i;
            else if (is_ear(i))
                ear = i;
        }
        if (flat < left.size())
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(flat));
        else if (ear < left.size())
            cut(ear);
        else
            break;  // crosses itself
    }
    return triangles;
}

}  // namespace regather::imports
