#include "study/half_vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace regather::study {

using trace::Vec3;

HalfVectorLobe::HalfVectorLobe(float exponent, double degrees) : exponent_(exponent) {
    material_.kind = capture::MaterialKind::glossy;
    material_.diffuse = {};
    material_.specular = {1, 1, 1};
    material_.exponent = exponent;
    const double angle = degrees * std::numbers::pi / 180;
    incoming_ = {static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
}

HalfVectorLobe::Sample HalfVectorLobe::at(double u, double v) const {
    const double below_one = -std::expm1(std::log(u) / (exponent_ + 1));
    const double sine = std::sqrt(below_one * (2 - below_one)), phi = 2 * std::numbers::pi * v;
    const trace::Vec3d half{sine * std::cos(phi), sine * std::sin(phi), 1 - below_one};
    const double length2 =
        double{incoming_.x} * incoming_.x + double{incoming_.z} * incoming_.z;  // not 1: rounded to float
    const double along = (incoming_.x * half.x + incoming_.z * half.z) / std::sqrt(length2);
    const double unit = 1 / std::sqrt(length2);
    return {{2 * along * half.x - incoming_.x * unit, 2 * along * half.y,
             2 * along * half.z - incoming_.z * unit},
            along,
            std::pow(u, exponent_ / (exponent_ + 1))};
}

double HalfVectorLobe::least_u(double v) const {
    // The direction's height is i_x cos(phi) sin(2 t) + i_z cos(2 t) for a half vector at angle t: a cosine
    // of 2 t - delta.
    const double delta = std::atan2(incoming_.x * std::cos(2 * std::numbers::pi * v), double{incoming_.z});
    const double sine = std::sin(delta / 2 + std::numbers::pi / 4);
    return std::exp(0.5 * (exponent_ + 1) * std::log1p(-std::min(sine * sine, 1.0)));
}

std::pair<double, double> HalfVectorLobe::place_of(Vec3 direction) const {
    // Where both are almost along x, their sum there is what rounding has left of two numbers near 1: taken
    // from the others.
    const auto along_x = [](double x, double y2, double z) {
        return std::fabs(x) < 0.9 ? x : std::copysign(std::sqrt(1 - y2 - z * z), x);
    };
    const double y = direction.y, z = double{incoming_.z} + direction.z;
    const double x = along_x(incoming_.x, 0, incoming_.z) + along_x(direction.x, y * y, direction.z);
    const double sine2 = (x * x + y * y) / (x * x + y * y + z * z);
    const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
    return {std::exp(0.5 * (exponent_ + 1) * std::log1p(-std::min(sine2, 1.0))), turn < 0 ? turn + 1 : turn};
}

}  // namespace regather::study
