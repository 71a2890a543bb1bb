#include "capture/sampling/gather_distribution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "capture/sampling/hemisphere_table.h"
#include "study/chi_squared.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

Material surface_of(float diffuse, float specular, float exponent) {
    Material material;
    material.kind = specular > 0 ? MaterialKind::glossy : MaterialKind::diffuse;
    material.diffuse = {diffuse, diffuse, diffuse};
    material.specular = {specular, specular, specular};
    material.exponent = exponent;
    return material;
}

trace::Photon photon_from(Vec3 position, Vec3 from, Vec3 power) {
    trace::Photon photon;
    photon.position = position;
    trace::encode_direction(-from, photon);
    trace::encode_power(power, photon.power);
    return photon;
}

/// Photons about (1, 2, 3) on a floor: most from low on the side of +x, some from above, a few from below it.
struct Witnesses {
    std::vector<trace::Photon> heap;
    std::vector<PhotonOrigin> origin;

    Witnesses() {
        std::vector<trace::Photon> photons;
        Sampler sampler(3, Stream::photon, 1);
        for (int i = 0; i < 400; ++i) {
            const Vec3 place{1 + 0.1f * sampler.uniform(), 2 + 0.1f * sampler.uniform(), 3};
            Vec3 from = cosine_hemisphere(sampler.uniform(), sampler.uniform());
            if (i % 4 != 0) from = normalize(Vec3{0.9f, 0.3f * sampler.uniform(), 0.2f});
            if (i % 25 == 0) from.z = -from.z;
            photons.push_back(photon_from(place, from, {1, 1, 0.5f}));
        }
        heap = spatial::left_balanced(photons);
        origin.assign(heap.size(), PhotonOrigin::surface);
    }
    /// What is seen: twice as bright towards -y as towards +y, and 6 more within 30 degrees of the normal.
    PhotonGuide guide() const {
        return {spatial::PhotonKd(heap), origin, true, [](Vec3, Vec3 direction) {
                    const float light =
                        (direction.y < 0 ? 2.0f : 1.0f) + (direction.z > 0.866f ? 6.0f : 0.0f);
                    return Vec3{light, light, light};
                }};
    }
};

/// Directions over the upper hemisphere in the cells of a table, and the solid angle that each stands for
/// [sr].
template <class F>
void over_cells(std::uint32_t rows, std::uint32_t columns, std::uint32_t fine, F&& f) {
    for (std::uint32_t cell = 0; cell < rows * columns; ++cell) {
        const auto up = [&](std::uint32_t row) { return std::sqrt(1 - static_cast<double>(row) / rows); };
        const double top = up(cell / columns), height = (top - up(cell / columns + 1)) / fine,
                     turn = 2 * std::numbers::pi / columns / fine;
        for (std::uint32_t i = 0; i < fine; ++i)
            for (std::uint32_t j = 0; j < fine; ++j) {
                const double z = top - (i + 0.5) * height, r = std::sqrt(1 - z * z),
                             phi = (cell % columns * fine + j + 0.5) * turn;
                f(cell,
                  Vec3{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                       static_cast<float>(z)},
                  height * turn);
            }
    }
}

struct Case {
    std::string spec;
    float diffuse, specular, exponent;
    Vec3 to_viewer;
};

class Samplers : public testing::TestWithParam<Case> {
protected:
    Samplers() {
        distribution_->look({{&material_, {0, 0, 1}, normalize(GetParam().to_viewer)}, {1.05f, 2.05f, 3}});
    }

    const Material material_ = surface_of(GetParam().diffuse, GetParam().specular, GetParam().exponent);
    const Witnesses witnesses_;
    const PhotonGuide guide_ = witnesses_.guide();
    const std::unique_ptr<GatherDistribution> distribution_ = parse_sampling(GetParam().spec).make(guide_);
};

// Of the samples, those that are none are the rest of the integral.
TEST_P(Samplers, SamplesFallAsTheDensitySays) {
    constexpr std::uint32_t samples = 200'000, rows = 8, columns = 32, fine = 24;
    std::vector<double> found(rows * columns + 1), expected(rows * columns + 1);
    double sum = 0;
    over_cells(rows, columns, fine, [&](std::uint32_t cell, Vec3 direction, double solid_angle) {
        const double share = distribution_->pdf(direction) * solid_angle;
        expected[cell] += samples * share;
        sum += share;
    });
    EXPECT_LE(sum, 1 + 1e-3);
    expected.back() = std::max(0.0, samples * (1 - sum));
    const HemisphereTable cells(rows, columns);
    for (std::uint32_t i = 0; i < samples; ++i) {
        Sampler sampler(11, Stream::gather, 5, i);
        GatherSample sample;
        const Strata::Point place{sampler.uniform(), sampler.uniform()};
        if (!distribution_->sample(place, sampler, sample)) {
            ++found.back();
            continue;
        }
        EXPECT_GT(sample.density, 0);
        EXPECT_NEAR(dot(sample.direction, sample.direction), 1, 1e-5);
        ++found[cells.cell_of(sample.direction)];
    }
    EXPECT_GT(study::chi_squared_p(found, expected), 1e-5);
}

TEST_P(Samplers, ASamplesDensityIsThatOfItsDirection) {
    for (std::uint32_t i = 0; i < 2000; ++i) {
        Sampler sampler(12, Stream::gather, 5, i);
        GatherSample sample;
        const Strata::Point place{sampler.uniform(), sampler.uniform()};
        if (!distribution_->sample(place, sampler, sample)) continue;
        EXPECT_NEAR(distribution_->pdf(sample.direction) / sample.density, 1, 1e-3) << i;
    }
}

// The integral of cos / pi over the hemisphere is 1, whoever draws. Four deviations of the mean.
TEST_P(Samplers, WhatIsDividedByTheDivisorHasTheIntegralAsItsMean) {
    if (GetParam().spec == "brdf" && GetParam().specular > 0) return;  // draws nothing in some directions
    constexpr std::uint32_t samples = 100'000;
    double sum = 0, sum2 = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        Sampler sampler(13, Stream::gather, 5, i);
        GatherSample sample;
        const Strata::Point place{sampler.uniform(), sampler.uniform()};
        if (!distribution_->sample(place, sampler, sample)) continue;
        const double value =
            std::max(0.0, static_cast<double>(sample.direction.z)) / std::numbers::pi / sample.divisor;
        sum += value;
        sum2 += value * value;
    }
    const double mean = sum / samples,
                 deviation = std::sqrt(std::max(0.0, sum2 / samples - mean * mean) / samples);
    EXPECT_NEAR(mean, 1, 4 * deviation + 1e-5);
    EXPECT_LT(deviation, 0.02);
}

INSTANTIATE_TEST_SUITE_P(
    Each, Samplers,
    testing::Values(Case{"uniform", 0.5f, 0, 1, {0, 0, 1}}, Case{"cosine", 0.5f, 0.3f, 8, {1, 0, 1}},
                    Case{"brdf", 0.5f, 0, 1, {1, 0, 1}}, Case{"brdf", 0.2f, 0.5f, 8, {1, 1, 1}},
                    Case{"incident", 0.5f, 0, 1, {1, 0, 1}},
                    Case{"incident:rows=2,columns=4,floor=10,smooth=0", 0.5f, 0, 1, {1, 0, 1}},
                    Case{"lobes", 0.5f, 0, 1, {1, 0, 1}},
                    Case{"lobes:lobes=7,shrink=0,floor=5", 0.2f, 0.5f, 20, {-1, 0, 1}},
                    Case{"footprints:k=60,neighbours=50", 0.5f, 0, 1, {1, 0, 1}},
                    Case{"footprints:k=100,neighbours=90,floor=30", 0.2f, 0.5f, 20, {-1, 0, 1}},
                    Case{"mis:brdf=30", 0.2f, 0.5f, 20, {-1, 0, 1}},
                    Case{"mis:brdf=60,heuristic=power", 0.2f, 0.5f, 20, {1, 0, 1}},
                    Case{"combined:rows=8,columns=16", 0.2f, 0.5f, 20, {-1, 0, 1}},
                    Case{"oracle:probes=2", 0.2f, 0.5f, 20, {-1, 0, 1}},
                    Case{"oracle:rows=16,columns=8", 0.5f, 0, 1, {0, 0, 1}}));

Vec3 towards(float x, float y, float z) {
    return normalize(Vec3{x, y, z});
}

/// The density over the cosine's.
double factor(const GatherDistribution& distribution, Vec3 direction) {
    return distribution.pdf(direction) * std::numbers::pi / static_cast<double>(direction.z);
}

// Cells of the upper quarter of sin^2 see 7 and 8, the others 1 and 2: 3.75 in the mean.
TEST(OracleSampling, GoesWhereLightIs) {
    const Witnesses witnesses;
    const PhotonGuide guide = witnesses.guide();
    const Material white = surface_of(0.5f, 0, 1);
    const auto distribution = parse_sampling("oracle:floor=20").make(guide);
    distribution->look({{&white, {0, 0, 1}, {0, 0, 1}}, {1.05f, 2.05f, 3}, {1.05f, 2.05f, 3}});
    const double mean = (7 + 8 + 3 * (1 + 2)) / 8.0;
    EXPECT_NEAR(factor(*distribution, towards(0.1f, 0.2f, 1)), 0.8 * 7 / mean + 0.2, 1e-4);
    EXPECT_NEAR(factor(*distribution, towards(0.2f, -0.1f, 1)), 0.8 * 8 / mean + 0.2, 1e-4);
    EXPECT_NEAR(factor(*distribution, towards(-0.5f, 0.8f, 0.2f)), 0.8 * 1 / mean + 0.2, 1e-4);
    EXPECT_NEAR(factor(*distribution, towards(0.5f, -0.8f, 0.2f)), 0.8 * 2 / mean + 0.2, 1e-4);
}

// The table's second row holds the edge at 40 degrees in none of its cells alone: the root of the mean
// square.
TEST(OracleSampling, ACellOfTwoLightsHasTheRootOfTheirMeanSquare) {
    const Witnesses witnesses;
    PhotonGuide guide = witnesses.guide();
    guide.seen = [](Vec3, Vec3 direction) {  // in the only row: 3 in the half of sin^2 below 1/2, else 1
        const float light = direction.z * direction.z > 0.5f ? 3.0f : 1.0f;
        return direction.x > 0 ? Vec3{light, light, light} : Vec3{};
    };
    const Material white = surface_of(0.5f, 0, 1);
    const auto distribution = parse_sampling("oracle:rows=1,columns=4,floor=1,probes=8").make(guide);
    distribution->look({{&white, {0, 0, 1}, {0, 0, 1}}, {}, {}});
    // Two of four cells, both alike; what they share is 99 %.
    EXPECT_NEAR(factor(*distribution, towards(0.3f, 0.4f, 1)), 0.99 * 2 + 0.01, 1e-4);
    EXPECT_NEAR(factor(*distribution, towards(-0.3f, 0.4f, 1)), 0.01, 1e-4);
    guide.seen = [](Vec3, Vec3 direction) {
        const float light = direction.x < 0 ? 2.0f : direction.z * direction.z > 0.5f ? 3.0f : 1.0f;
        return Vec3{light, light, light};
    };
    distribution->look({{&white, {0, 0, 1}, {0, 0, 1}}, {}, {}});
    const double mixed = std::sqrt((9 + 1) / 2.0);
    EXPECT_NEAR(factor(*distribution, towards(0.3f, 0.4f, 1)), 0.99 * mixed / ((mixed + 2) / 2) + 0.01, 1e-4);
}

/// Photons from everywhere alike, with powers between 1 and 3.
Witnesses even_witnesses() {
    Witnesses even;
    std::vector<trace::Photon> photons;
    Sampler sampler(8, Stream::photon, 1);
    for (int i = 0; i < 400; ++i) {
        const float power = 1 + 2 * sampler.uniform(), x = sampler.uniform(), y = sampler.uniform(),
                    u = sampler.uniform(), v = sampler.uniform();
        photons.push_back(
            photon_from({1 + 0.1f * x, 2 + 0.1f * y, 3}, cosine_hemisphere(u, v), {power, power, power}));
    }
    even.heap = spatial::left_balanced(photons);
    return even;
}

double root_mean_square_from_cosine(const std::string& spec, const Witnesses& witnesses) {
    const PhotonGuide guide = witnesses.guide();
    const Material white = surface_of(0.5f, 0, 1);
    const auto distribution = parse_sampling(spec).make(guide);
    distribution->look({{&white, {0, 0, 1}, {0, 0, 1}}, {1.05f, 2.05f, 3}, {}});
    double sum = 0;
    const HemisphereTable cells(4, 16);
    for (std::uint32_t cell = 0; cell < 64; ++cell) {
        const double off = factor(*distribution, cells.middle_of(cell)) - 1;
        sum += off * off / 64;
    }
    return std::sqrt(sum);
}

// 400 photons over 64 cells are 6.25 a cell: 40 % off by chance, and by their powers a little more.
TEST(IncidentSampling, WhatChanceExplainsIsNoLight) {
    const Witnesses even = even_witnesses();
    const double raw = root_mean_square_from_cosine("incident:smooth=0,shrink=0,floor=1", even);
    EXPECT_NEAR(raw, 0.42, 0.06);
    EXPECT_LT(root_mean_square_from_cosine("incident:smooth=0,floor=1", even), raw / 3);
    // Smoothing leaves 5/16 of the squares in the two inner rows, 7/16 in the others.
    EXPECT_NEAR(root_mean_square_from_cosine("incident:shrink=0,floor=1", even) / raw, std::sqrt(0.375),
                0.12);
    EXPECT_LT(root_mean_square_from_cosine("incident:floor=1", even), raw / 4);
    // A direction that is there stays.
    const Witnesses uneven;
    EXPECT_NEAR(root_mean_square_from_cosine("incident:floor=1", uneven) /
                    root_mean_square_from_cosine("incident:shrink=0,floor=1", uneven),
                1, 0.03);
}

// Three quarters of the photons come from a tenth of a turn at the horizon.
TEST(IncidentSampling, GoesWherePhotonsCameFrom) {
    const Witnesses witnesses;
    const PhotonGuide guide = witnesses.guide();
    const auto distribution = parse_sampling("incident:floor=20,smooth=0").make(guide);
    const Material white = surface_of(0.5f, 0, 1);
    distribution->look({{&white, {0, 0, 1}, {0, 0, 1}}, {1.05f, 2.05f, 3}});
    int low = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        Sampler sampler(4, Stream::gather, 1, i);
        GatherSample sample;
        ASSERT_TRUE(distribution->sample({sampler.uniform(), sampler.uniform()}, sampler, sample));
        low += sample.direction.x > 0.7f && sample.direction.y > 0;
    }
    EXPECT_GT(low, 500);
    EXPECT_LT(low, 800);
}

TEST(IncidentSampling, PhotonsOfLightsAndOfTheCausticMapAreNoWitnesses) {
    Witnesses witnesses;
    const Material white = surface_of(0.5f, 0, 1);
    for (const auto& [origin, apart] : {std::pair{PhotonOrigin::light, true},
                                        {PhotonOrigin::light, false},
                                        {PhotonOrigin::specular, true}}) {
        witnesses.origin.assign(witnesses.heap.size(), origin);
        PhotonGuide guide = witnesses.guide();
        guide.caustics_apart = apart;
        const auto distribution = parse_sampling("incident").make(guide);
        distribution->look({{&white, {0, 0, 1}, {0, 0, 1}}, {1.05f, 2.05f, 3}});
        const Vec3 low = normalize(Vec3{0.9f, 0.1f, 0.2f});
        EXPECT_NEAR(distribution->pdf(low), low.z / std::numbers::pi, 1e-6) << "the cosine alone";
        guide.caustics_apart = false;
        if (origin == PhotonOrigin::light) continue;
        distribution->look({{&white, {0, 0, 1}, {0, 0, 1}}, {1.05f, 2.05f, 3}});
        EXPECT_GT(distribution->pdf(low), 3 * low.z / std::numbers::pi);
    }
}

TEST(Sampling, SpecsThatCannotBeAreRefused) {
    const PhotonGuide none;
    EXPECT_THROW(parse_sampling("cosin"), trace::UsageError);
    EXPECT_THROW(parse_sampling("cosine:k=3"), trace::UsageError);
    for (const char* const spec : {"incident:rows=65",
                                   "incident:columns=5",
                                   "incident:floor=0",
                                   "incident:floor=101",
                                   "incident:smooth=2",
                                   "incident:shrink=2",
                                   "combined:k=0",
                                   "oracle:probes=0",
                                   "oracle:floor=0",
                                   "oracle:brdf=2",
                                   "mis:brdf=0",
                                   "lobes:lobes=0",
                                   "lobes:lobes=17",
                                   "lobes:iterations=0",
                                   "lobes:k=0",
                                   "lobes:floor=0",
                                   "lobes:shrink=2",
                                   "footprints:k=0",
                                   "footprints:neighbours=0",
                                   "footprints:floor=101"})
        EXPECT_THROW(parse_sampling(spec).make(none), trace::UsageError) << spec;
    EXPECT_EQ(parse_sampling("brdf").text, default_sampling);
    EXPECT_EQ(parse_sampling("incident:rows=2").text,
              "incident:rows=2,columns=16,k=400,floor=10,smooth=1,shrink=1");
}

}  // namespace
}  // namespace regather::capture
