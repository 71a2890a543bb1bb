#include "scenes/coordinates.h"

namespace regather::scenes {

Vec3 Coordinates::to_float(const std::array<double, 3>& p) const {
    return {static_cast<float>(p[0] - origin_[0]), static_cast<float>(p[1] - origin_[1]),
            static_cast<float>(p[2] - origin_[2])};
}

Vec3 Coordinates::point(const Field& object, const Kind& kind, std::string_view key) const {
    return to_float(absolute(object, kind, key));
}

std::array<double, 3> Coordinates::absolute(const Field& object, const Kind& kind, std::string_view key) {
    return object[key].numbers(-most_coordinate, most_coordinate, expected(kind, key));
}

Vec3 Coordinates::vector(const Field& object, const Kind& kind, std::string_view key) {
    const std::string_view wanted = expected(kind, key);
    const Vec3 v = object[key].triple(-most_metres, most_metres, wanted);
    if (v == Vec3{}) object[key].fail("a vector of length 0", wanted);
    return v;
}

float Coordinates::positive(const Field& object, const Kind& kind, std::string_view key) {
    return static_cast<float>(object[key].number(0, most_metres, expected(kind, key), Field::Ends::open_low));
}

float Coordinates::not_negative(const Field& object, const Kind& kind, std::string_view key) {
    return static_cast<float>(object[key].number(0, most_metres, expected(kind, key)));
}

double Coordinates::degrees(const Field& object, const Kind& kind, std::string_view key) {
    return object.has(key) ? object[key].number(-360, 360, expected(kind, key)) : 0;
}

}  // namespace regather::scenes
