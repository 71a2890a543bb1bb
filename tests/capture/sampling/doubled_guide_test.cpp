// The doubled sphere, and the two strategies whose lobes are on it.
#include "capture/sampling/doubled_guide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "capture/reference/moments.h"

namespace regather::capture {
namespace {

constexpr double degree = std::numbers::pi / 180;

Vec3 above(double degrees, double turn) {
    const double phi = 2 * std::numbers::pi * turn;
    return {static_cast<float>(std::sin(degrees * degree) * std::cos(phi)),
            static_cast<float>(std::sin(degrees * degree) * std::sin(phi)),
            static_cast<float>(std::cos(degrees * degree))};
}

TEST(DoubledSphere, AnglesAreTwiceTheAngle) {
    for (const double degrees : {0.0, 0.01, 10.0, 44.9, 45.1, 80.0, 89.99})
        for (const double turn : {0.1, 0.4, 0.85}) {
            const Vec3 direction = above(degrees, turn);
            const Vec3d place = doubled(direction);
            EXPECT_NEAR(std::atan2(std::hypot(place.x, place.y), place.z), 2 * degrees * degree, 2e-7);
            EXPECT_NEAR(length(place), 1, 1e-15);
            EXPECT_NEAR(place.x * direction.y, place.y * direction.x, 1e-7) << "the same turn";
            EXPECT_GE(place.x * direction.x, 0);
            const Vec3 back = halved(place);
            EXPECT_NEAR(length(back - direction), 0, degrees > 89 ? 1e-3 : 3e-7) << degrees;
            EXPECT_NEAR(back.z / direction.z, 1, degrees > 89 ? 1e-2 : 1e-5);
        }
    EXPECT_EQ(doubled({0.6f, 0, -0.8f}), (Vec3d{0, 0, -1}));
    EXPECT_EQ(halved({0, 0, -1}).z, 0);
    EXPECT_EQ(halved({0, 0, 1}), (Vec3{0, 0, 1}));
}

// 1 - z of the sphere is twice sin^2 of the angle, so that even there is as the cosine here.
TEST(DoubledSphere, EvenPointsAreTheCosines) {
    for (const auto& [u, v] : {std::pair{0.1f, 0.2f}, {0.5f, 0.7f}, {0.97f, 0.95f}})
        EXPECT_NEAR(length(halved(about({0, 0, 1}, 2 * u, v)) - cosine_hemisphere(u, v)), 0, 1e-6) << u;
}

Material grey() {
    Material material;
    material.diffuse = {0.5f, 0.5f, 0.5f};
    return material;
}

/// Photons at one place, of where they came from.
struct Photons {
    std::vector<trace::Photon> heap;
    std::vector<PhotonOrigin> origin;

    Photons(std::span<const Vec3> from, std::span<const float> power) {
        std::vector<trace::Photon> photons(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) {
            photons[i].position = {0.001f * static_cast<float>(i), 0, 0};
            trace::encode_direction(-from[i], photons[i]);
            const float third = power[i % power.size()];
            trace::encode_power({third, third, third}, photons[i].power);
        }
        heap = spatial::left_balanced(photons);
        origin.assign(heap.size(), PhotonOrigin::surface);
    }
    PhotonGuide guide() const {
        return {spatial::PhotonKd(heap), origin, true, [](Vec3, Vec3 direction) {
                    return Vec3{direction.x * direction.x, 0, 0};
                }};
    }
};

/// On the doubled sphere [1/sr]: uniform is 1 / (4 pi).
double density_there(const GatherDistribution& distribution, Vec3 direction) {
    return distribution.pdf(direction) / (4 * double{direction.z});
}

struct Looking {
    Looking(const std::string& spec, const Photons& photons)
        : guide(photons.guide()), distribution(parse_sampling(spec).make(guide)) {
        distribution->look({{&surface, {0, 0, 1}, {0, 0, 1}}, {0, 0, 0}, {}});
    }
    Material surface = grey();
    PhotonGuide guide;
    std::unique_ptr<GatherDistribution> distribution;
};

/// exp(kappa cos) normalised over the sphere, by sinh rather than by expm1.
double von_mises_fisher(double kappa, double cosine) {
    return kappa / (4 * std::numbers::pi * std::sinh(kappa)) * std::exp(kappa * cosine);
}

// Three quarters from a lobe at 20 degrees from the normal, a quarter from one at 60: 40 and 120 on the
// sphere.
TEST(LobeSampling, FindsTheLobesThatPhotonsCameFrom) {
    const Vec3 high = above(20, 0.1), low = above(60, 0.6);
    constexpr double of_high = 30, of_low = 12;
    std::vector<Vec3> from;
    Sampler sampler(5, Stream::photon, 1);
    for (int i = 0; i < 4000; ++i) {
        // A von Mises-Fisher lobe by its distribution function, w = 1 + log(u + (1 - u) exp(-2 kappa)) /
        // kappa.
        const double kappa = i % 4 == 0 ? of_low : of_high, u = sampler.fine_uniform(),
                     below = -std::log(u + (1 - u) * std::exp(-2 * kappa)) / kappa;
        const Vec3d place = about(to_float(doubled(i % 4 == 0 ? low : high)), below, sampler.fine_uniform());
        from.push_back(halved(place));
    }
    const Photons photons(from, std::vector<float>{1});
    const Looking at("lobes:lobes=2,k=4000,floor=1,iterations=30,shrink=0", photons);
    for (const Vec3 direction : {high, low, above(25, 0.15), above(50, 0.62), above(5, 0.3)}) {
        const Vec3d place = doubled(direction);
        const double expected = 0.75 * von_mises_fisher(of_high, dot(place, doubled(high))) +
                                0.25 * von_mises_fisher(of_low, dot(place, doubled(low)));
        EXPECT_NEAR(density_there(*at.distribution, direction),
                    0.99 * expected + 0.01 / (4 * std::numbers::pi), 0.12 * expected)
            << direction.x << " " << direction.y;
    }
}

TEST(LobeSampling, APhotonsPowerIsItsWeight) {
    const std::vector<Vec3> from{above(10, 0), above(50, 0.5)};
    const Photons photons(from, std::vector<float>{3, 1});
    const Looking at("lobes:lobes=2,k=2,floor=1,shrink=0", photons);
    // Two lobes of equal width would be 3 : 1; the mean cosine of few photons is drawn towards none.
    EXPECT_GT(density_there(*at.distribution, from[0]), 3 * density_there(*at.distribution, from[1]));
}

/// The mean square of the density's relative difference from the cosine's, at even points.
double unevenness(const GatherDistribution& distribution) {
    double sum = 0;
    for (int row = 0; row < 40; ++row)
        for (int column = 0; column < 40; ++column) {
            const Vec3 d = cosine_hemisphere((static_cast<float>(row) + 0.5f) / 40,
                                             (static_cast<float>(column) + 0.5f) / 40);
            const double off = density_there(distribution, d) * 4 * std::numbers::pi - 1;
            sum += off * off / 1600;
        }
    return sum;
}

// Evenly lit, what 400 photons show of lobes is chance.
TEST(LobeSampling, WhatChanceExplainsIsNoLight) {
    double raw = 0, shrunk = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        std::vector<Vec3> from;
        Sampler sampler(seed, Stream::photon, 1);
        for (int i = 0; i < 400; ++i) {
            const float u = sampler.uniform(), v = sampler.uniform();
            from.push_back(cosine_hemisphere(u, v));
        }
        const Photons photons(from, std::vector<float>{1});
        const Looking all("lobes:floor=1,shrink=0", photons), less("lobes:floor=1", photons);
        raw += unevenness(*all.distribution) / 8;
        shrunk += unevenness(*less.distribution) / 8;
    }
    EXPECT_GT(raw, 0.01);
    EXPECT_LT(shrunk, 0.01) << "of a variance of a few hundredths";
}

// On the sphere: the pole, 60 degrees from it, and 120 on the other side. Of the first two each is the
// other's nearest, at a chord of 1: a quarter of the sphere. The third's is the first, at a chord of sqrt(3):
// three quarters. A photon's direction is kept to a degree.
TEST(FootprintSampling, FootprintsReachTheirNeighboursAndOverlap) {
    const std::vector<Vec3> from{above(0, 0), above(30, 0), above(60, 0.5)};
    const Photons photons(from, std::vector<float>{2, 1, 1});
    const Looking at("footprints:k=3,neighbours=1,floor=20", photons);
    const auto expected = [](double a, double b, double c) {
        return 0.2 + 0.8 * (0.5 * a / 0.25 + 0.25 * b / 0.25 + 0.25 * c / 0.75);
    };
    const auto found = [&](double degrees, double turn) {
        return density_there(*at.distribution, above(degrees, turn)) * 4 * std::numbers::pi;
    };
    EXPECT_NEAR(found(2, 0.5), expected(1, 0, 1), 0.08);
    EXPECT_NEAR(found(2, 0), expected(1, 1, 0), 0.08);
    EXPECT_NEAR(found(28, 0), expected(1, 1, 0), 0.08);
    EXPECT_NEAR(found(32, 0), expected(0, 1, 0), 0.08);
    EXPECT_NEAR(found(75, 0.5), expected(0, 0, 1), 0.08);
    EXPECT_NEAR(found(80, 0), expected(0, 0, 0) + 0.8 * 0.25 / 0.75, 0.08) << "beyond the lower pole";
    const Looking wide("footprints:k=3,neighbours=3,floor=20", photons);
    EXPECT_NEAR(unevenness(*wide.distribution), 0, 1e-9) << "with too few neighbours, all of the sphere";
}

TEST(FootprintSampling, PhotonsFromOneDirectionLeaveAFootprint) {
    const std::vector<Vec3> from(50, above(40, 0.3));
    const Photons photons(from, std::vector<float>{1});
    const Looking at("footprints:k=50,neighbours=5,floor=10", photons);
    EXPECT_NEAR(density_there(*at.distribution, above(40, 0.3)) * 4 * std::numbers::pi, 0.1 + 0.9 * 1024, 1);
    EXPECT_NEAR(density_there(*at.distribution, above(44, 0.3)) * 4 * std::numbers::pi, 0.1, 1e-6);
}

// 144 strata estimate the mean of a smooth function with far less variance than as many points anywhere.
TEST(DoubledGuides, StrataStayStrata) {
    std::vector<Vec3> from;
    Sampler photon_sampler(8, Stream::photon, 1);
    for (int i = 0; i < 400; ++i) {
        const float u = photon_sampler.uniform(), v = photon_sampler.uniform();
        from.push_back(i % 3 == 0 ? cosine_hemisphere(u, v)
                                  : halved(about(to_float(doubled(above(50, 0.2))), 0.1 * u, v)));
    }
    const Photons photons(from, std::vector<float>{1});
    // A disc or a lobe lies across others, so strata of it are not strata of directions throughout.
    for (const auto& [spec, gain] : {std::pair{"lobes", 3.0},
                                     {"lobes:lobes=2,iterations=2", 3.0},
                                     {"footprints:k=400", 1.6},
                                     {"incident", 3.0}}) {
        const Looking at(spec, photons);
        const Strata strata(144);
        MomentsOf<2> means;
        for (std::uint64_t run = 1; run <= 100; ++run) {
            double stratified = 0, anywhere = 0;
            for (std::uint32_t i = 0; i < 144; ++i) {
                Sampler sampler(run, Stream::gather, 2, i);
                GatherSample sample;
                ASSERT_TRUE(at.distribution->sample(strata.sample(i, sampler), sampler, sample));
                stratified += double{sample.direction.x} / 144;
                const float u = sampler.uniform(), v = sampler.uniform();
                ASSERT_TRUE(at.distribution->sample({u, v}, sampler, sample));
                anywhere += double{sample.direction.x} / 144;
            }
            means.add({stratified, anywhere}, run);
        }
        EXPECT_LT(means.variance(0, 100), means.variance(1, 100) / gain) << spec;
        EXPECT_NEAR(means.mean[0], means.mean[1], 5 * std::sqrt(means.variance(1, 100))) << spec;
    }
}

// Midpoints of even cells of the sphere; cells of the tables are whole numbers of them. Discs, which end
// between, need finer cells.
TEST(DoubledGuides, EveryDensityIntegratesToOne) {
    std::vector<Vec3> from;
    Sampler sampler(9, Stream::photon, 1);
    for (int i = 0; i < 60; ++i) {
        const float u = sampler.uniform(), v = sampler.uniform();
        from.push_back(i % 2 == 0 ? cosine_hemisphere(u, v) : above(30 + 20 * u, 0.3 + 0.1 * v));
    }
    const Photons photons(from, std::vector<float>{1, 2.5f});
    for (const char* const spec : {"cosine", "brdf", "incident", "combined:rows=8", "oracle:probes=1", "mis",
                                   "lobes", "lobes:lobes=16,shrink=0,floor=1", "footprints:neighbours=30",
                                   "footprints:neighbours=45,floor=1"}) {
        const Looking at(spec, photons);
        const bool discs = std::string(spec).starts_with("footprints");
        const int rows = discs ? 512 : 128, columns = rows;
        double sum = 0;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                sum +=
                    density_there(*at.distribution,
                                  halved(about({0, 0, 1}, 2 * (row + 0.5) / rows, (column + 0.5) / columns)));
            }
        EXPECT_NEAR(sum * 4 * std::numbers::pi / (rows * columns), 1, 1e-4) << spec;
    }
}

}  // namespace
}  // namespace regather::capture
