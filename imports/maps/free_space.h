// imports/maps/free_space.h -- where a camera can be in a map, and go: away from its solid brushes (found
// through the BSP tree) and from its triangles. Game units.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "imports/maps/bsp.h"
#include "trace/bounds.h"

namespace regather::imports {

/// Keeps references to both: they must live as long.
class FreeSpace {
public:
    FreeSpace(const Bsp& bsp, std::span<const std::array<Vec3, 3>> triangles);

    /// No solid brush and no leaf inside a wall is nearer than `radius`. Cautious: corners count as nearer
    /// than they are.
    bool clear(Vec3 point, float radius) const;
    /// All the way from a to b: clear at steps of half a radius, and no triangle across five parallel lines
    /// `radius` apart.
    bool clear(Vec3 a, Vec3 b, float radius) const;
    /// The triangle that is met first on the way from a to b, if any.
    std::optional<std::size_t> first_met(Vec3 a, Vec3 b) const;
    /// Height of the highest triangle below the point, none within `reach`.
    std::optional<float> floor_below(Vec3 point, float reach) const;

private:
    bool crosses(Vec3 a, Vec3 b) const;
    template <class Visit>
    void visit_near(Vec3 a, Vec3 b, Visit visit) const;
    bool in_solid(const BspLeaf& leaf, Vec3 point, float radius) const;

    const Bsp& bsp_;
    std::span<const std::array<Vec3, 3>> triangles_;
    std::vector<trace::Bounds3> blocks_;  // Of so many triangles one after the other: neighbours, mostly.
};

}  // namespace regather::imports
