// study/room.h -- scenes that are put together in memory, corner by corner in double precision, at any scale
// and place, with faults that no loader would let through.
#pragma once
#include <array>
#include <cstdint>

#include "scenes/scene.h"

namespace regather::study {

using Double3 = std::array<double, 3>;

/// p -> scale p + shift, rounded to float at the very end.
struct Placement {
    double scale = 1;
    Double3 shift{};
};

class Room {
public:
    explicit Room(const Placement& placement = {}) : placement_(placement) {}

    std::uint32_t diffuse(double albedo);  ///< A material's index.
    std::uint32_t add(const scenes::Material& material);
    void triangle(const Double3& a, const Double3& b, const Double3& c, std::uint32_t material);
    /// Faces along cross(u, v).
    void quad(const Double3& corner, const Double3& u, const Double3& v, std::uint32_t material);
    /// A rectangle that emits along cross(u, v) and reflects as `material` says.
    void light(const Double3& corner, const Double3& u, const Double3& v, double radiance,
               std::uint32_t material);
    /// Six walls that face inwards.
    void walls(const Double3& low, const Double3& high, std::uint32_t material);
    /// A solid block.
    void block(const Double3& low, const Double3& high, std::uint32_t material);
    void look(const Double3& from, const Double3& at, double fov_degrees);

    scenes::Scene scene;

private:
    trace::Vec3 point(const Double3& p) const;
    trace::Vec3 edge(const Double3& e) const;
    void box(const Double3& low, const Double3& high, std::uint32_t material, bool inwards);
    Placement placement_;
};

/// A box of 1 m with grey walls, a block of its own colour, a mirror, and a light of 0.3 m under the ceiling,
/// seen by the camera.
Room furnished_room(const Placement& placement = {}, double light_gap = 0.01);

/// A box of 1 m whose six walls have the albedo and emit a radiance of 1: everywhere it is 1 / (1 - albedo).
Room furnace(double albedo);

}  // namespace regather::study
