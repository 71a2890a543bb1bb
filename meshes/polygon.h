// meshes/polygon.h -- triangles of polygons by ear clipping (Meisters, "Polygons Have Ears", 1975). Every
// corner is used, those on a straight edge too, so that polygons that share corners stay joined: n corners
// give n - 2 triangles.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "meshes/surface.h"

namespace regather::meshes {

struct PlanPoint {
    double x = 0, y = 0;
    friend bool operator==(PlanPoint, PlanPoint) = default;
};

/// Twice the area, positive when the corners run counter-clockwise with y up (clockwise on a plan, where y is
/// down).
double twice_area(std::span<const PlanPoint> polygon);

/// A polygon with more corners than this that is not convex is refused: ear clipping takes the square of
/// their number.
inline constexpr std::size_t most_concave_corners = 1u << 15;

/// Fills one polygon after another; keeps its memory between them.
class Triangulator {
public:
    enum class Result {
        whole,           ///< A simple polygon: covered exactly, each triangle running as the polygon does.
        crosses_itself,  ///< Or has no area: triangles with all of its edges, but they overlap.
        too_large        ///< Not convex, with more than most_concave_corners: no triangles.
    };
    Result fill(std::span<const PlanPoint> polygon);
    /// In the plane of its normal by Newell's rule (Tampieri, "Newell's Method for the Plane Equation of a
    /// Polygon", Graphics Gems III, 1992), seen along the axis that the normal is nearest to.
    Result fill(std::span<const Vec3> polygon);

    std::span<const Triangle> triangles() const {
        return triangles_;
    }  ///< Of the last: indices of its corners.

private:
    Result fill_points();
    bool is_convex() const;
    void fan(std::uint32_t first, std::size_t corners);
    bool clip();
    bool is_ear(std::uint32_t corner);
    double turn(std::uint32_t corner) const;
    void cut(std::uint32_t corner);

    std::vector<PlanPoint> points_;
    std::vector<std::uint32_t> next_, previous_, blockers_, candidates_;
    std::vector<Triangle> triangles_;
    std::size_t left_ = 0;
};

/// Indices into the polygon, every triangle running as the polygon does and with an area. A simple polygon is
/// covered exactly; one that crosses itself gives some triangles, and ends.
std::vector<Triangle> triangulate(std::span<const PlanPoint> polygon);

}  // namespace regather::meshes
