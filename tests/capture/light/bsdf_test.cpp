#include "capture/light/bsdf.h"

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
    constexpr int rows = 1000, columns = 300;
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
        const double theta = (i + 0.5) * (pi / 2 / rows);
        for (int j = 0; j < columns; ++j) {
            const double phi = (j + 0.5) * (2 * pi / columns);
            const Vec3 light{static_cast<float>(std::sin(theta) * std::cos(phi)),
                             static_cast<float>(std::sin(theta) * std::sin(phi)),
                             static_cast<float>(std::cos(theta))};
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
        for (const double angle : {0.5, 1.0, 1.4})
            EXPECT_LE(albedo(glossy(0, 0.6f, exponent), angle), 0.602) << exponent;
    }
}

TEST(Bsdf, FresnelHasItsTextbookValues) {
    EXPECT_NEAR(fresnel(1, 1.5f), 0.04, 1e-6);  // ((1.5 - 1) / (1.5 + 1))^2
    EXPECT_NEAR(fresnel(1, 1 / 1.5f), 0.04, 1e-6);
    EXPECT_NEAR(fresnel(std::cos(std::atan(1.5f)), 1.5f), 0.5 * std::pow((2.25 - 1) / (2.25 + 1), 2),
                1e-6);                      // Brewster
    EXPECT_EQ(fresnel(0.5f, 1 / 1.5f), 1);  // 60 degrees inside glass: critical is 41.8
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
    EXPECT_NEAR(z / samples, 2.0 / 3, 0.004);  // E[cos] = 2/3
    EXPECT_NEAR(z2 / samples, 0.5, 0.004);     // E[cos^2] = 1/2
}

/// The density of sample_direction over the hemisphere, by a rule that is fine around the lobe's peak; and
/// the share of samples that find a direction.
TEST(Bsdf, TheDensityOfDirectionsIntegratesToTheChanceOfFindingOne) {
    for (const double angle : {0.0, 0.5, 1.2, 1.5533})  // to 89 degrees
        for (const float exponent : {1.0f, 20.0f, 2000.0f}) {
            const Material material = glossy(0.2f, 0.6f, exponent);
            const Vec3 incoming{static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
            // Half vectors in polar coordinates with theta_h = (pi / 2) t^3; dw = 4 (in . h) dw_h.
            constexpr int rows = 400, columns = 200;
            double sum = 0;
            for (int i = 0; i < rows; ++i) {
                const double t = (i + 0.5) / rows, theta = pi / 2 * t * t * t,
                             d_theta = pi / 2 * 3 * t * t / rows;
                for (int j = 0; j < columns; ++j) {
                    const double phi = (j + 0.5) * (2 * pi / columns);
                    const double h[3] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                         std::cos(theta)};
                    const double along = h[0] * incoming.x + h[2] * incoming.z;
                    if (along <= 0) continue;
                    const Vec3 out{static_cast<float>(2 * along * h[0] - incoming.x),
                                   static_cast<float>(2 * along * h[1]),
                                   static_cast<float>(2 * along * h[2] - incoming.z)};
                    sum += scatter_pdf(material, {0, 0, 1}, incoming, out) * 4 * along * std::sin(theta) *
                           d_theta * (2 * pi / columns);
                }
            }
            constexpr int samples = 40000;
            int found = 0;
            for (int i = 0; i < samples; ++i) {
                Sampler sampler(4, Stream::eye, static_cast<std::uint64_t>(i));
                const double choice = sampler.fine_uniform();
                const float u = sampler.uniform(), v = sampler.uniform();
                Vec3 direction;
                found += sample_direction(material, {0, 0, 1}, incoming, choice, u, v, direction);
            }
            const double share = static_cast<double>(found) / samples,
                         error = std::sqrt(share * (1 - share) / samples);
            EXPECT_NEAR(sum, share, 4 * error + 2e-3) << angle << " " << exponent;
        }
}

/// E[g(direction) / pdf] is the integral of g: here of f cos, the albedo, where every sample is a ratio of
/// densities.
TEST(Bsdf, DirectionsAndTheirDensityGiveTheAlbedo) {
    for (const float exponent : {2.0f, 50.0f, 500.0f}) {
        const Material material = glossy(0.3f, 0.5f, exponent);
        const Vec3 incoming{std::sin(0.5f), 0, std::cos(0.5f)};
        double sum = 0, squares = 0;
        constexpr int samples = 200000;
        for (int i = 0; i < samples; ++i) {
            Sampler sampler(8, Stream::eye, static_cast<std::uint64_t>(i));
            const double choice = sampler.fine_uniform();
            const float u = sampler.uniform(), v = sampler.uniform();
            Vec3 direction;
            if (!sample_direction(material, {0, 0, 1}, incoming, choice, u, v, direction)) continue;
            const double weight = static_cast<double>(brdf(material, {0, 0, 1}, direction, incoming).x) *
                                  direction.z / scatter_pdf(material, {0, 0, 1}, incoming, direction);
            EXPECT_LT(weight, 4.4);
            sum += weight;
            squares += weight * weight;
        }
        const double mean = sum / samples, error = std::sqrt((squares / samples - mean * mean) / samples);
        EXPECT_NEAR(mean, albedo(material, 0.5), 4 * error + 1e-4) << exponent;
    }
}

/// Of a lobe of exponent 1e6 the half vector's sine^2 has mean 2 / (e + 3): its distribution survives the
/// rounding of floats.
TEST(Bsdf, ANarrowLobeKeepsItsShape) {
    for (const float exponent : {1e4f, 1e6f}) {
        const Material material = glossy(0, 0.9f, exponent);
        const Vec3 incoming{std::sin(0.7f), 0, std::cos(0.7f)}, normal{0, 0, 1};
        double sine2 = 0, weight = 0;
        constexpr int samples = 100000;
        for (int i = 0; i < samples; ++i) {
            Sampler sampler(6, Stream::eye, static_cast<std::uint64_t>(i));
            const double choice = sampler.fine_uniform();
            const float u = sampler.uniform(), v = sampler.uniform();
            Vec3 out;
            ASSERT_TRUE(sample_direction(material, normal, incoming, choice, u, v, out));
            ASSERT_NEAR(length(out), 1, 1e-6);
            const double x = static_cast<double>(incoming.x) + out.x, y = out.y,
                         z = static_cast<double>(incoming.z) + out.z;
            sine2 += (x * x + y * y) / (x * x + y * y + z * z);
            weight += static_cast<double>(brdf(material, normal, out, incoming).x) * out.z /
                      scatter_pdf(material, normal, incoming, out);
        }
        EXPECT_NEAR(sine2 / samples * (exponent + 3) / 2, 1,
                    4 / std::sqrt(samples));  // about exponential: deviation = mean
        EXPECT_NEAR(weight / samples, 0.9 * std::pow(std::cos(0.7), 2),
                    0.02);  // norm and Jacobian: 4 (in.h) cos 2 pi / (e + 1) norm
    }
}

/// n = z and the viewer overhead: the half vector's angle is half of the light's, theta. (n.h)^e = cos(theta
/// / 2)^e in long double.
TEST(Bsdf, ANarrowLobeHasItsValueOnItsFlank) {
    const Material material = glossy(0, 1, 1e6f);
    for (const double theta : {5e-4, 2e-3, 4e-3}) {
        const Vec3 light{static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta))};
        const long double half =
            std::atan2(static_cast<long double>(light.x), static_cast<long double>(light.z)) / 2;
        const double expected =
            blinn_phong_norm(1e6f) * static_cast<double>(std::exp(1e6L * std::log(std::cos(half))));
        EXPECT_NEAR(brdf(material, {0, 0, 1}, light, {0, 0, 1}).x, expected, 1e-5 * expected) << theta;
    }
}

TEST(Bsdf, LambertScattersItsAlbedoByChannel) {
    Material material;
    material.diffuse = {0.9f, 0.3f, 0.6f};
    double red = 0, green = 0;
    constexpr int samples = 20000;
    for (int i = 0; i < samples; ++i) {
        Sampler sampler(2, Stream::photon, static_cast<std::uint64_t>(i));
        const Scatter next = scatter(material, {0, 0, 1}, {0, 0, 1}, sampler);
        if (next.absorbed) continue;
        red += next.weight.x;
        green += next.weight.y;
    }
    const double error = std::sqrt(0.6 * 0.4 / samples);  // of the share that is not absorbed
    EXPECT_NEAR(red / samples, 0.9, 4 * error * 1.5);
    EXPECT_NEAR(green / samples, 0.3, 4 * error * 0.5);
}

TEST(Bsdf, NothingIsInfiniteForAnyUnitVectors) {
    const Vec3 normal = normalize(Vec3{0.3f, -0.5f, 0.7f});
    const Frame frame(normal);
    for (const float exponent : {1.0f, 1e3f, 1e6f})
        for (const double elevation : {1e-30, 1e-7, 1.7e-5, 0.5, 1.5707})
            for (const double other : {1e-30, 1e-7, 1.7e-5, 0.5, 1.5707})
                for (int turn = 0; turn < 8; ++turn) {
                    const auto at = [&](double e, double phi) {
                        return frame.to_world({static_cast<float>(std::cos(e) * std::cos(phi)),
                                               static_cast<float>(std::cos(e) * std::sin(phi)),
                                               static_cast<float>(std::sin(e))});
                    };
                    const Vec3 in = at(elevation, 0), out = at(other, turn * pi / 4);
                    const Material material = glossy(0.5f, 0.5f, exponent);
                    EXPECT_TRUE(is_finite(brdf(material, normal, out, in)));
                    EXPECT_TRUE(std::isfinite(scatter_pdf(material, normal, in, out)));
                    EXPECT_FLOAT_EQ(brdf(material, normal, out, in).x,
                                    brdf(material, normal, in, out).x);  // reciprocity
                    for (const float eta : {1.0001f, 1 / 1.0001f, 5.0f, 0.2f}) {
                        const float share = fresnel(dot(normal, in), eta);
                        EXPECT_GE(share, 0);
                        EXPECT_LE(share, 1);
                        Vec3 through;
                        if (dot(normal, in) > 0 && refract(in, normal, eta, through)) {
                            EXPECT_NEAR(length(through), 1, 1e-6);
                            EXPECT_LT(dot(normal, through), 1e-6f);
                        }
                    }
                    Sampler sampler(1, Stream::eye, static_cast<std::uint64_t>(turn));
                    const Scatter next = scatter(material, normal, in, sampler);
                    EXPECT_TRUE(is_finite(next.weight) && is_finite(next.direction));
                    EXPECT_LT(next.weight.x, 4.4f);
                }
}

/// Against the same formulas in long double, at 89.999 degrees and for indices near 1.
TEST(Bsdf, FresnelAtGrazingAnglesAgreesWithLongDouble) {
    for (const float eta : {1.0001f, 1.5f, 5.0f, 1 / 1.5f})
        for (const float cosine : {1.0f, 0.9f, 0.1f, 1.7453e-5f}) {
            const long double c = cosine, e = eta, sine = std::sqrt(1 - c * c), inner = sine / e;
            long double expected = 1;
            if (inner < 1) {
                const long double t = std::sqrt(1 - inner * inner), a = (e * c - t) / (e * c + t),
                                  b = (c - e * t) / (c + e * t);
                expected = (a * a + b * b) / 2;
            }
            EXPECT_NEAR(fresnel(cosine, eta), static_cast<double>(expected),
                        1e-6 * static_cast<double>(expected) + 1e-12);
        }
}

}  // namespace
}  // namespace regather::capture
