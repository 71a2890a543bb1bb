#include "capture/light/bsdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace regather::capture {
namespace {

float mean(Vec3 v) {
    return (v.x + v.y + v.z) / 3;
}
float specular_share(const Material& material) {
    return material.kind == MaterialKind::glossy ? mean(material.specular) : 0;
}

struct Wide {
    explicit Wide(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
    Wide(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    double x, y, z;
};
double dot(Wide a, Wide b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Wide operator*(Wide a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
Wide operator+(Wide a, Wide b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Wide operator-(Wide a, Wide b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec3 unit(Wide a) {
    const Wide scaled = a * (1 / std::sqrt(dot(a, a)));
    return {static_cast<float>(scaled.x), static_cast<float>(scaled.y), static_cast<float>(scaled.z)};
}

/// Between the two directions.
struct Half {
    double power;  ///< (n.h)^exponent
    double
        length;  ///< Of the sum of the two directions: twice the cosine between either and their half vector.
};
Half half_between(Vec3 normal, Vec3 a, Vec3 b, float exponent) {
    const Wide n(normal), h = Wide(a) + Wide(b);
    const double h2 = dot(h, h);
    const Wide across{n.y * h.z - n.z * h.y, n.z * h.x - n.x * h.z, n.x * h.y - n.y * h.x};
    const double sine2 = dot(across, across) / (h2 * dot(n, n));
    // cos^e = exp(e / 2 log(1 - sin^2)) <= exp(-e / 2 sin^2): below the smallest float beyond 104.
    const double e = exponent;
    if (!(0.5 * e * sine2 < 104) || sine2 >= 1) return {0, std::sqrt(h2)};
    return {std::exp(0.5 * e * std::log1p(-sine2)), std::sqrt(h2)};
}

bool both_above(Vec3 normal, Vec3 a, Vec3 b) {
    return trace::dot(normal, a) > 0 && trace::dot(normal, b) > 0;
}

double pdf_of(const Material& material, Vec3 normal, Vec3 outgoing, Half half) {
    const double diffuse = mean(material.diffuse), glossy = specular_share(material);
    if (!(diffuse + glossy > 0)) return 0;
    double density = diffuse * trace::dot(normal, outgoing);
    // Half vector with density (e + 1) / (2 pi) cos^e; that of the direction is smaller by 4 (incoming .
    // half).
    if (glossy > 0) density += glossy * 0.25 * (material.exponent + 1.0) * half.power / half.length;
    return density / ((diffuse + glossy) * std::numbers::pi);
}

Vec3 value_of(const Material& material, Half half) {
    Vec3 value = material.diffuse * (1 / std::numbers::pi_v<float>);
    if (half.power > 0)
        value += material.specular * static_cast<float>(blinn_phong_norm(material.exponent) * half.power);
    return value;
}

Half half_of(const Material& material, Vec3 normal, Vec3 a, Vec3 b) {
    return material.kind == MaterialKind::glossy ? half_between(normal, a, b, material.exponent) : Half{0, 1};
}

}  // namespace

Frame::Frame(Vec3 n) : normal(n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
}

Vec3 cosine_hemisphere(float u, float v) {
    const float r = std::sqrt(u), phi = 2 * std::numbers::pi_v<float> * v;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - u))};
}

float blinn_phong_norm(float e) {
    return static_cast<float>((e + 2.0) * (e + 4.0) / (8.0 * std::numbers::pi * (std::exp2(-0.5 * e) + e)));
}

Vec3 brdf(const Material& material, Vec3 normal, Vec3 to_light, Vec3 to_viewer) {
    if (is_specular(material) || !both_above(normal, to_light, to_viewer)) return {};
    return value_of(material, half_of(material, normal, to_light, to_viewer));
}

float fresnel(float cos_incident, float eta) {
    const double c = std::clamp(static_cast<double>(cos_incident), 0.0, 1.0), e = eta;
    const double scaled2 = (e - 1) * (e + 1) + c * c;  // e^2 cos^2 of the refracted angle
    if (scaled2 <= 0) return 1;
    const double t = std::sqrt(scaled2);
    const double parallel = (e * e * c - t) / (e * e * c + t), perpendicular = (c - t) / (c + t);
    return static_cast<float>(0.5 * (parallel * parallel + perpendicular * perpendicular));
}

Vec3 reflect(Vec3 outgoing, Vec3 normal) {
    const Wide n(normal), o(outgoing);
    return unit(n * (2 * dot(n, o) / dot(n, n)) - o);
}

bool refract(Vec3 outgoing, Vec3 normal, float eta, Vec3& refracted) {
    const Wide n(normal), o(outgoing);
    const double e = eta, cosine = dot(n, o);
    const double scaled2 = (e - 1) * (e + 1) + cosine * cosine;
    if (!(scaled2 > 0)) return false;
    refracted = unit(n * (cosine - std::sqrt(scaled2)) - o);
    return true;
}

float scatter_pdf(const Material& material, Vec3 normal, Vec3 incoming, Vec3 outgoing) {
    if (is_specular(material) || !both_above(normal, incoming, outgoing)) return 0;
    return static_cast<float>(
        std::min(pdf_of(material, normal, outgoing, half_of(material, normal, incoming, outgoing)), 0x1p127));
}

bool sample_direction(const Material& material, Vec3 normal, Vec3 incoming, double choice, float u, float v,
                      Vec3& direction) {
    if (is_specular(material)) return false;
    const float diffuse = mean(material.diffuse), glossy = specular_share(material);
    if (!(diffuse + glossy > 0)) return false;
    const Frame frame(normal);
    if (choice * (diffuse + glossy) < diffuse || !(glossy > 0)) {
        direction = frame.to_world(cosine_hemisphere(u, v));
    } else {
        const double below_one =
            -std::expm1(std::log1p(-static_cast<double>(u)) / (material.exponent + 1.0));  // 1 - cos
        const double sine = std::sqrt(below_one * (2 - below_one)), phi = 2 * std::numbers::pi * v;
        const Wide half = Wide(frame.tangent) * (sine * std::cos(phi)) +
                          Wide(frame.bitangent) * (sine * std::sin(phi)) + Wide(normal) * (1 - below_one);
        const double along = dot(Wide(incoming), half);
        if (!(along > 0)) return false;
        direction = unit(half * (2 * along / dot(half, half)) - Wide(incoming));
    }
    return both_above(normal, incoming, direction);
}

Scatter scatter(const Material& material, Vec3 normal, Vec3 incoming, Sampler& sampler) {
    const float glossy = specular_share(material), albedo = mean(material.diffuse) + glossy;
    // A multiple of 2^-24 would miss an albedo of 0.9999 by enough to be seen after 10,000 bounces.
    const double choice = sampler.fine_uniform();
    const float u = sampler.uniform(), v = sampler.uniform();
    Vec3 direction;
    if (!(choice < albedo) || !sample_direction(material, normal, incoming, choice / albedo, u, v, direction))
        return {};
    if (!(glossy > 0)) return {false, direction, material.diffuse * (1 / albedo)};
    const Half half = half_of(material, normal, incoming, direction);
    const double density = pdf_of(material, normal, direction, half) * albedo;
    if (!(density > 0)) return {};
    return {false, direction,
            value_of(material, half) * static_cast<float>(trace::dot(normal, direction) / density)};
}

}  // namespace regather::capture
