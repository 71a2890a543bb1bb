#include "imports/homes/wall.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>

namespace regather::imports {

namespace {

constexpr double least_cut = 0.1;  // [cm] Nearer cuts are one.
constexpr double least_share_cut =
    0.25;                               // Of the thickness: a door that only touches a wall does not cut it.
constexpr double parallel_sine = 0.01;  // Of the angle between what is as good as parallel.

PlanPoint operator+(PlanPoint a, PlanPoint b) {
    return {a.x + b.x, a.y + b.y};
}
PlanPoint operator-(PlanPoint a, PlanPoint b) {
    return {a.x - b.x, a.y - b.y};
}
PlanPoint operator*(PlanPoint a, double s) {
    return {a.x * s, a.y * s};
}
double dot(PlanPoint a, PlanPoint b) {
    return a.x * b.x + a.y * b.y;
}
double cross(PlanPoint a, PlanPoint b) {
    return a.x * b.y - a.y * b.x;
}
double length(PlanPoint a) {
    return std::hypot(a.x, a.y);
}

WallOutline straight(const HomeWall& wall) {
    const PlanPoint along = wall.end - wall.start;
    const double size = length(along);
    const PlanPoint unit = size > 0 ? along * (1 / size) : PlanPoint{1, 0};
    const PlanPoint to_left{unit.y * wall.thickness / 2, -unit.x * wall.thickness / 2};  // y is down
    return {{wall.start + to_left, wall.end + to_left}, {wall.start - to_left, wall.end - to_left}};
}

// The arc through start and end that turns by arc_extent, in chords of at most 10 degrees.
WallOutline curved(const HomeWall& wall) {
    const double extent =
        std::clamp(wall.arc_extent, -2 * std::numbers::pi + 0.01, 2 * std::numbers::pi - 0.01);
    const PlanPoint chord = wall.end - wall.start;
    const double half = length(chord) / 2, distance = half / std::tan(extent / 2);
    const PlanPoint unit = chord * (1 / (2 * half));
    const PlanPoint center = wall.start + chord * 0.5 + PlanPoint{-unit.y, unit.x} * distance;
    const double radius = half / std::abs(std::sin(extent / 2));
    const double first = std::atan2(wall.start.y - center.y, wall.start.x - center.x);
    const int chords = std::max(2, static_cast<int>(std::ceil(std::abs(extent) * 18 / std::numbers::pi)));
    const double outside =
        extent > 0 ? wall.thickness / 2 : -wall.thickness / 2;  // left is away from the centre
    WallOutline outline;
    for (int i = 0; i <= chords; ++i) {
        const double angle = first + extent * i / chords;
        const PlanPoint ray{std::cos(angle), std::sin(angle)};
        outline.left.push_back(center + ray * std::max(radius + outside, 0.0));
        outline.right.push_back(center + ray * std::max(radius - outside, 0.0));
    }
    return outline;
}

// Where the line a -> b meets c -> d, unless they are nearly parallel or meet farther than `limit` from b.
void meet(PlanPoint a, PlanPoint& b, PlanPoint c, PlanPoint d, double limit) {
    const PlanPoint u = b - a, v = d - c;
    const double sine = cross(u, v);
    if (std::abs(sine) <= 1e-3 * length(u) * length(v)) return;
    const PlanPoint point = a + u * (cross(c - a, v) / sine);
    if (length(point - b) <= limit) b = point;
}

// The part of a convex polygon where dot(normal, p) <= bound.
std::vector<PlanPoint> clipped(const std::vector<PlanPoint>& polygon, PlanPoint normal, double bound) {
    std::vector<PlanPoint> inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const PlanPoint a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = dot(normal, a) - bound, db = dot(normal, b) - bound;
        if (da <= 0) inside.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) inside.push_back(a + (b - a) * (da / (da - db)));
    }
    return inside;
}

// One straight piece of a wall as a grid of cells, cut along its length and its height at every hole's edges.
class Piece {
public:
    Piece(PlanPoint left_start, PlanPoint left_end, PlanPoint right_start, PlanPoint right_end)
        : left_{left_start, left_end}, right_{right_start, right_end} {
        origin_ = (left_start + right_start) * 0.5;
        const PlanPoint axis = (left_end + right_end) * 0.5 - origin_;
        size_ = length(axis);
        unit_ = size_ > 0 ? axis * (1 / size_) : PlanPoint{1, 0};
        low_ = std::max(along(left_[0]), along(right_[0]));
        high_ = std::min(along(left_[1]), along(right_[1]));
        if (low_ < high_) return;
        low_ = 0;  // mitred to a wedge
        high_ = size_;
    }

    bool usable() const { return size_ > 0; }

    void extrude(double bottom_cm, double top_start, double top_end, std::span<const WallHole> holes,
                 WallSurfaces& out) {
        std::vector<double> s{low_, high_}, z{0, std::max(top_start, top_end)};
        std::vector<std::array<double, 4>> cuts;  // from, to along the wall; from, to in height
        for (const WallHole& hole : holes)
            if (const auto span = crossing(hole)) {
                const std::array<double, 4> cut{(*span)[0], (*span)[1], std::max(hole.low, 0.0),
                                                std::min(hole.high, z[1])};
                if (cut[3] - cut[2] < least_cut) continue;
                cuts.push_back(cut);
            }
        for (const auto& cut : cuts) {
            s.insert(s.end(), {cut[0], cut[1]});
            z.insert(z.end(), {cut[2], cut[3]});
        }
        merge(s);
        merge(z);
        const std::size_t cells = s.size() - 1, layers = z.size() - 1;
        std::vector<char> solid(cells * layers, 1);
        for (std::size_t i = 0; i < cells; ++i)
            for (std::size_t k = 0; k < layers; ++k)
                for (const auto& cut : cuts) {
                    const double at = (s[i] + s[i + 1]) / 2, up = (z[k] + z[k + 1]) / 2;
                    if (at > cut[0] && at < cut[1] && up > cut[2] && up < cut[3]) solid[i * layers + k] = 0;
                }
        const auto is_solid = [&](std::size_t i, std::size_t k) {
            return i < cells && k < layers && solid[i * layers + k] != 0;
        };
        const auto place = [&](bool left, std::size_t i, std::size_t k) {
            const double share = std::clamp((s[i] - low_) / (high_ - low_), 0.0, 1.0);
            const double top = top_start + (top_end - top_start) * share;
            return in_metres(on_side(left ? left_ : right_, s, i), bottom_cm + std::min(z[k], top));
        };
        const auto quad = [&](Surface& surface, Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
            const auto first = static_cast<std::uint32_t>(surface.vertices.size());
            surface.vertices.insert(surface.vertices.end(), {a, b, c, d});
            surface.normals.resize(surface.vertices.size());
            surface.triangles.push_back({first, first + 1, first + 2});
            surface.triangles.push_back({first, first + 2, first + 3});
        };
        for (std::size_t i = 0; i < cells; ++i)
            for (std::size_t k = 0; k < layers; ++k) {
                if (!is_solid(i, k)) continue;
                const std::size_t j = i + 1, h = k + 1;
                const auto l = [&](std::size_t a, std::size_t b) { return place(true, a, b); };
                const auto r = [&](std::size_t a, std::size_t b) { return place(false, a, b); };
                quad(out.left, l(j, k), l(i, k), l(i, h), l(j, h));
                quad(out.right, r(i, k), r(j, k), r(j, h), r(i, h));
                if (!is_solid(i, h))
                    quad(h == layers ? out.top : out.left, r(i, h), r(j, h), l(j, h), l(i, h));
                if (k == 0 || !is_solid(i, k - 1)) quad(out.left, l(i, k), l(j, k), r(j, k), r(i, k));
                if (i == 0 || !is_solid(i - 1, k)) quad(out.left, l(i, k), r(i, k), r(i, h), l(i, h));
                if (!is_solid(j, k)) quad(out.left, r(j, k), l(j, k), l(j, h), r(j, h));
            }
    }

private:
    double along(PlanPoint p) const { return dot(p - origin_, unit_); }

    // From where to where the footprint crosses the wall; a hole that reaches an end takes all of the end.
    std::optional<std::array<double, 2>> crossing(const WallHole& hole) const {
        const PlanPoint edge = hole.footprint[1] - hole.footprint[0];
        const bool along_it = hole.touch && std::abs(cross(edge, unit_)) <= parallel_sine * length(edge);
        const std::array<PlanPoint, 4>& footprint = along_it ? *hole.touch : hole.footprint;
        std::vector<PlanPoint> polygon(footprint.begin(), footprint.end());
        const PlanPoint across{-unit_.y, unit_.x};
        const double middle = dot(across, origin_), half = std::abs(dot(across, left_[0]) - middle);
        polygon = clipped(polygon, across, middle + half);
        polygon = clipped(polygon, across * -1, half - middle);
        polygon = clipped(polygon, unit_, dot(unit_, origin_) + high_);
        polygon = clipped(polygon, unit_ * -1, -(dot(unit_, origin_) + low_));
        if (polygon.size() < 3) return {};
        double from = high_, to = low_, near = middle + half, far = middle - half;
        for (const PlanPoint p : polygon) {
            from = std::min(from, along(p));
            to = std::max(to, along(p));
            near = std::min(near, dot(across, p));
            far = std::max(far, dot(across, p));
        }
        const double least_depth = along_it ? least_cut : least_share_cut * 2 * half;
        if (to - from < least_cut || far - near < least_depth) return {};
        return std::array<double, 2>{from - low_ < least_cut ? low_ : from,
                                     high_ - to < least_cut ? high_ : to};
    }

    PlanPoint on_side(const std::array<PlanPoint, 2>& side, const std::vector<double>& s,
                      std::size_t i) const {
        if (i == 0) return side[0];
        if (i + 1 == s.size()) return side[1];
        return side[0] + unit_ * (s[i] - along(side[0]));
    }

    // Sorted, with cuts that are nearly the same made one; the ends stay.
    static void merge(std::vector<double>& cuts) {
        std::sort(cuts.begin(), cuts.end());
        const double last = cuts.back();
        std::vector<double> kept{cuts.front()};
        for (const double cut : cuts)
            if (cut - kept.back() > least_cut / 2 && last - cut > least_cut / 2) kept.push_back(cut);
        kept.push_back(last);
        cuts = std::move(kept);
    }

    std::array<PlanPoint, 2> left_, right_;
    PlanPoint origin_, unit_;
    double size_ = 0, low_ = 0, high_ = 0;
};

}  // namespace

Vec3 in_metres(PlanPoint p, double elevation) {
    return {static_cast<float>(p.x / 100), static_cast<float>(-p.y / 100),
            static_cast<float>(elevation / 100)};
}

std::vector<WallOutline> wall_outlines(std::span<const HomeWall> walls) {
    std::vector<WallOutline> plain;
    std::map<std::string_view, std::size_t> by_id;
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const bool arc =
            std::abs(walls[w].arc_extent) > 1e-3 && length(walls[w].end - walls[w].start) > least_cut;
        plain.push_back(arc ? curved(walls[w]) : straight(walls[w]));
        by_id.emplace(walls[w].id, w);
    }
    std::vector<WallOutline> joined = plain;
    for (std::size_t w = 0; w < walls.size(); ++w) {
        for (const bool at_start : {true, false}) {
            const auto found = by_id.find(at_start ? walls[w].at_start : walls[w].at_end);
            if (found == by_id.end() || found->second == w) continue;
            const HomeWall& other = walls[found->second];
            const WallOutline& next = plain[found->second];
            const bool other_at_start = other.at_start == walls[w].id;
            if (!other_at_start && other.at_end != walls[w].id) continue;  // the join must be known to both
            // Two walls that meet start to start or end to end have their left and right hands exchanged.
            const bool same_hand = at_start != other_at_start;
            const double limit = 2 * std::max(walls[w].thickness, other.thickness);
            for (const bool left : {true, false}) {
                const std::vector<PlanPoint>& mine = left ? plain[w].left : plain[w].right;
                const std::vector<PlanPoint>& its = left == same_hand ? next.left : next.right;
                const std::size_t n = mine.size(), m = its.size();
                PlanPoint end = at_start ? mine[0] : mine[n - 1];
                meet(at_start ? mine[1] : mine[n - 2], end, other_at_start ? its[0] : its[m - 2],
                     other_at_start ? its[1] : its[m - 1], limit);
                std::vector<PlanPoint>& result = left ? joined[w].left : joined[w].right;
                (at_start ? result.front() : result.back()) = end;
            }
        }
    }
    return joined;
}

WallSurfaces extrude(const HomeWall& wall, const WallOutline& outline, double elevation,
                     std::span<const WallHole> holes) {
    WallSurfaces surfaces;
    const std::size_t pieces = outline.left.size() - 1;
    const auto top = [&](std::size_t i) {
        return wall.height +
               (wall.height_at_end - wall.height) * static_cast<double>(i) / static_cast<double>(pieces);
    };
    for (std::size_t i = 0; i < pieces; ++i) {
        Piece piece(outline.left[i], outline.left[i + 1], outline.right[i], outline.right[i + 1]);
        if (piece.usable()) piece.extrude(elevation, top(i), top(i + 1), holes, surfaces);
    }
    for (Surface* surface : {&surfaces.left, &surfaces.right, &surfaces.top}) drop_degenerate(*surface);
    return surfaces;
}

}  // namespace regather::imports
