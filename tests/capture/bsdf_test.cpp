#include "capture/bsdf.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

namespace regather::capture {
namespace {

constexpr double pi = std::numbers::pi;

Material glossy(float diffuse, float specular, float exponent) {
    Material material;
    material.kind = MaterialKind::glossy;
    material.diffuse = {diffuse, diffuse, diffuse};
    material.specular = {specular, specular, specular};
    material.exponent = exponent;
    return material;
}

/// Integral of f cos over the hemisphere by a fine midpoint rule.
double albedo(const Material& material, double angle) {
    const Vec3 viewer{static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
    constexpr int rows = 1500, columns = 600;
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
        const double theta = (i + 0.5) * (pi / 2 / rows);
        for (int j = 0; j < columns; ++j) {
            const double phi = (j + 0.5) * (2 * pi / columns);
            const Vec3 light{static_cast<float>(std::sin(theta) * std::cos(phi)),
                             static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
            sum += brdf(material, {0, 0, 1}, light, viewer).x * std::cos(theta) * std::sin(theta);
        }
    }
    return sum * (pi / 2 / rows) * (2 * pi / columns);
}

TEST(Bsdf, LambertReflectsItsAlbedo) {
    Material material;
    material.diffuse = {0.7f, 0.7f, 0.7f};
    EXPECT_NEAR(albedo(material, 0.3), 0.7, 1e-4);
}

TEST(Bsdf, BlinnPhongIsNormalisedAtNormalIncidenceAndNeverReflectsMore) {
    for (const float exponent : {1.0f, 10.0f, 100.0f, 1000.0f}) {
        EXPECT_NEAR(albedo(glossy(0, 0.6f, exponent), 0), 0.6, 2e-3) << exponent;
        for (const double angle : {0.5, 1.0, 1.4}) EXPECT_LE(albedo(glossy(0, 0.6f, exponent), angle), 0.602) << exponent;
    }
}

TEST(Bsdf, FresnelHasItsTextbookValues) {
    EXPECT_NEAR(fresnel(1, 1.5f), 0.04, 1e-6);                               // ((1.5 - 1) / (1.5 + 1))^2
    EXPECT_NEAR(fresnel(1, 1 / 1.5f), 0.04, 1e-6);
    EXPECT_NEAR(fresnel(std::cos(std::atan(1.5f)), 1.5f), 0.5 * std::pow((2.25 - 1) / (2.25 + 1), 2), 1e-6);  // Brewster
    EXPECT_EQ(fresnel(0.5f, 1 / 1.5f), 1);                                   // 60 degrees inside glass: critical is 41.8
    EXPECT_NEAR(fresnel(1e-4f, 1.5f), 1, 1e-3);
}

TEST(Bsdf, RefractionObeysSnell) {
    const float angle = 0.6f;
    const Vec3 out{std::sin(angle), 0, std::cos(angle)};
    Vec3 through;
    ASSERT_TRUE(refract(out, {0, 0, 1}, 1.5f, through));
    EXPECT_NEAR(-through.x * 1.5f, out.x, 1e-6);
    EXPECT_LT(through.z, 0);
    EXPECT_FALSE(refract({std::sin(1.0f), 0, std::cos(1.0f)}, {0, 0, 1}, 1 / 1.5f, through));
}

TEST(Bsdf, FramesAreOrthonormal) {
    ASSERT_TRUE(rc::check([] {
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-100, 101)); };
        const Vec3 v{coordinate(), coordinate(), coordinate()};
        RC_PRE(dot(v, v) > 0);
        const Frame frame(normalize(v));
        RC_ASSERT(std::fabs(dot(frame.tangent, frame.normal)) < 1e-5f);
        RC_ASSERT(std::fabs(dot(frame.bitangent, frame.normal)) < 1e-5f);
        RC_ASSERT(length(cross(frame.tangent, frame.bitangent) - frame.normal) < 1e-4f);
    }));
}

/// Mean weight of the scattered power: the directional albedo.
TEST(Bsdf, ScatteredPowerIsTheDirectionalAlbedo) {
    for (const float exponent : {2.0f, 50.0f}) {
        const Material material = glossy(0.3f, 0.5f, exponent);
        const double angle = 0.5;
        const Vec3 incoming{static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
        double sum = 0, squares = 0;
        constexpr int samples = 400000;
        for (int i = 0; i < samples; ++i) {
            Sampler sampler(3, Stream::photon, static_cast<std::uint64_t>(i));
            const Scatter next = scatter(material, {0, 0, 1}, incoming, sampler);
            const double weight = next.absorbed ? 0 : next.weight.x;
            sum += weight;
            squares += weight * weight;
        }
        const double mean = sum / samples, error = std::sqrt((squares / samples - mean * mean) / samples);
        EXPECT_NEAR(mean, albedo(material, angle), 4 * error) << exponent;
    }
}

TEST(Bsdf, CosineSamplesHaveTheMomentsOfTheCosine) {
    double z = 0, z2 = 0;
    constexpr int samples = 100000;
    for (int i = 0; i < samples; ++i) {
        Sampler sampler(1, Stream::gather, static_cast<std::uint64_t>(i));
        const float u = sampler.uniform();
        const Vec3 d = cosine_hemisphere(u, sampler.uniform());
        z += d.z;
        z2 += d.z * d.z;
    }
    EXPECT_NEAR(z / samples, 2.0 / 3, 0.004);   // E[cos] = 2/3
    EXPECT_NEAR(z2 / samples, 0.5, 0.004);      // E[cos^2] = 1/2
}

}  // namespace
}  // namespace regather::capture
