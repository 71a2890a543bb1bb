// scenes/coordinates.h -- points and directions of a scene file [m]. Points are read as doubles, and an
// origin near the scene is taken off before they become floats: a scene far from its own origin keeps its
// shape.
#pragma once
#include <array>
#include <string_view>

#include "scenes/keys.h"
#include "trace/vec.h"

namespace regather::scenes {

using trace::Vec3;

inline constexpr double most_metres = 1e6;       ///< Of lengths and of factors.
inline constexpr double most_coordinate = 1e12;  ///< Of points [m].

class Coordinates {
public:
    explicit Coordinates(std::array<double, 3> origin) : origin_(origin) {}

    /// Relative to the origin.
    Vec3 point(const Field& object, const Kind& kind, std::string_view key) const;
    Vec3 to_float(const std::array<double, 3>& p) const;
    const std::array<double, 3>& origin() const { return origin_; }

    static std::array<double, 3> absolute(const Field& object, const Kind& kind, std::string_view key);
    /// Refuses the vector of length 0.
    static Vec3 vector(const Field& object, const Kind& kind, std::string_view key);
    /// Above 0.
    static float positive(const Field& object, const Kind& kind, std::string_view key);
    static float not_negative(const Field& object, const Kind& kind, std::string_view key);
    /// 0 when the key is not there.
    static double degrees(const Field& object, const Kind& kind, std::string_view key);

private:
    std::array<double, 3> origin_;
};

}  // namespace regather::scenes
