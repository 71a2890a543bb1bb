// study/room.h -- scenes that are put together in memory, corner by corner in double precision, at any scale
// and place, with faults that no loader would let through.
#pragma once
#include <cstdint>

#include "scenes/scene.h"
#include "trace/vec.h"

namespace regather::study {

using trace::Vec3d;

/// p -> scale p + shift, rounded to float at the very end.
struct Placement {
    double scale = 1;
    Vec3d shift;
};

class Room {
public:
    explicit Room(const Placement& placement = {}) : placement_(placement) {}

    std::uint32_t diffuse(double albedo);  ///< A material's index.
    std::uint32_t add(const scenes::Material& material);
    void triangle(Vec3d a, Vec3d b, Vec3d c, std::uint32_t material);
    /// Faces along cross(u, v).
    void quad(Vec3d corner, Vec3d u, Vec3d v, std::uint32_t material);
    /// A rectangle that emits along cross(u, v) and reflects as `material` says.
    void light(Vec3d corner, Vec3d u, Vec3d v, double radiance, std::uint32_t material);
    /// Six walls that face inwards.
    void walls(Vec3d low, Vec3d high, std::uint32_t material);
    /// A solid block.
    void block(Vec3d low, Vec3d high, std::uint32_t material);
    void look(Vec3d from, Vec3d at, double fov_degrees);

    scenes::Scene scene;

private:
    trace::Vec3 point(Vec3d p) const;
    trace::Vec3 edge(Vec3d e) const;
    void box(Vec3d low, Vec3d high, std::uint32_t material, bool inwards);
    Placement placement_;
};

/// A box of 1 m with grey walls, a block of its own colour, a mirror, and a light of 0.3 m under the ceiling,
/// seen by the camera.
Room furnished_room(const Placement& placement = {}, double light_gap = 0.01);

/// A box of 1 m whose six walls have the albedo and emit a radiance of 1: everywhere it is 1 / (1 - albedo).
Room furnace(double albedo);

}  // namespace regather::study
