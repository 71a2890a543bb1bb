#include "capture/bsdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace regather::capture {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

float mean(Vec3 v) { return (v.x + v.y + v.z) / 3; }

}  // namespace

Frame::Frame(Vec3 n) : normal(n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
}

Vec3 cosine_hemisphere(float u, float v) {
    const float r = std::sqrt(u), phi = 2 * pi * v;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - u))};
}

float blinn_phong_norm(float e) {
    return static_cast<float>((e + 2.0) * (e + 4.0) / (8.0 * std::numbers::pi * (std::exp2(-0.5 * e) + e)));
}

Vec3 brdf(const Material& material, Vec3 normal, Vec3 to_light, Vec3 to_viewer) {
    if (is_specular(material) || !(dot(normal, to_light) > 0) || !(dot(normal, to_viewer) > 0)) return {};
    Vec3 value = material.diffuse * (1 / pi);
    if (material.kind == MaterialKind::glossy) {
        const Vec3 half = to_light + to_viewer;
        const float half_length = length(half);
        if (half_length > 0) {
            const float cosine = std::min(1.0f, std::max(0.0f, dot(normal, half) / half_length));
            value += material.specular * (blinn_phong_norm(material.exponent) * std::pow(cosine, material.exponent));
        }
    }
    return value;
}

float fresnel(float cos_incident, float eta) {
    const double c = cos_incident, e = eta;
    const double sin2 = (1 - c * c) / (e * e);
    if (sin2 >= 1) return 1;
    const double t = std::sqrt(1 - sin2);
    const double parallel = (e * c - t) / (e * c + t), perpendicular = (c - e * t) / (c + e * t);
    return static_cast<float>(0.5 * (parallel * parallel + perpendicular * perpendicular));
}

Vec3 reflect(Vec3 outgoing, Vec3 normal) { return normal * (2 * dot(normal, outgoing)) - outgoing; }

bool refract(Vec3 outgoing, Vec3 normal, float eta, Vec3& refracted) {
    const float cosine = dot(normal, outgoing);
    const float inverse = 1 / eta;
    const float cos2 = 1 - inverse * inverse * (1 - cosine * cosine);
    if (cos2 <= 0) return false;
    refracted = normalize(normal * (inverse * cosine - std::sqrt(cos2)) - outgoing * inverse);
    return true;
}

Scatter scatter(const Material& material, Vec3 normal, Vec3 incoming, Sampler& sampler) {
    const float diffuse = mean(material.diffuse);
    const float glossy = material.kind == MaterialKind::glossy ? mean(material.specular) : 0;
    const float choice = sampler.uniform(), u = sampler.uniform(), v = sampler.uniform();
    if (choice < diffuse) {
        return {false, Frame(normal).to_world(cosine_hemisphere(u, v)), material.diffuse * (1 / diffuse)};
    }
    if (choice < diffuse + glossy) {
        // Half vector with density (e + 1) / (2 pi) cos^e; that of the direction is smaller by 4 (incoming . half).
        const float e = material.exponent;
        const float cosine = std::pow(1 - u, 1 / (e + 1)), sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
        const Vec3 half = Frame(normal).to_world({sine * std::cos(2 * pi * v), sine * std::sin(2 * pi * v), cosine});
        const float along = dot(incoming, half);
        const Vec3 direction = reflect(incoming, half);
        const float out = dot(normal, direction);
        if (along <= 0 || out <= 0) return {};
        const float weight = blinn_phong_norm(e) * out * 4 * along * 2 * pi / (e + 1);
        return {false, normalize(direction), material.specular * (weight / glossy)};
    }
    return {};
}

}  // namespace regather::capture
