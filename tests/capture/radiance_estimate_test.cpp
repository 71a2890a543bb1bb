#include "capture/radiance_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "capture/sampler.h"
#include "spatial/photons/photon_kd.h"

namespace regather::capture {
namespace {

constexpr float photon_watts = 0.25f;  // exact in RGBE but for the half step
constexpr float decoded_watts = photon_watts * (1 + 1.0f / 256);

/// Photons evenly on a square of `edge` around the origin, coming straight down onto z = 0.
std::vector<trace::Photon> even_floor(std::size_t count, float edge, std::uint64_t seed,
                                      Vec3 normal = {0, 0, 1}) {
    std::vector<trace::Photon> photons(count);
    Sampler sampler(seed, Stream::photon, 0);
    for (trace::Photon& photon : photons) {
        photon.position = {(sampler.uniform() - 0.5f) * edge, (sampler.uniform() - 0.5f) * edge, 0};
        trace::encode_power({photon_watts, photon_watts, photon_watts}, photon.power);
        trace::encode_direction({0, 0, -1}, photon);
        trace::encode_normal(normal, photon);
    }
    return photons;
}

double mean_estimate(std::uint32_t k, float radius, Filter filter, int seeds) {
    const Material white{.name = "white", .diffuse = {1, 1, 1}};
    double sum = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const std::vector<trace::Photon> heap =
            spatial::left_balanced(even_floor(2000, 2, static_cast<std::uint64_t>(seed)));
        const spatial::PhotonKd tree(heap);
        spatial::NearestSet found(k, radius);
        spatial::nearest(tree, {0, 0, 0}, found);
        sum += static_cast<double>(
            reflected_radiance(tree, found, {&white, {0, 0, 1}, {0, 0, 1}}, filter, true).x);
    }
    return sum / seeds;
}

TEST(RadianceEstimate, OfEvenPhotonsIsTheirPowerOverTheAreaWhateverKRadiusAndFilter) {
    // 2000 photons on 4 m^2; a white floor sends irradiance / pi. A full set of k has relative standard
    // deviation 1 / sqrt(k - 2), a fixed radius 1 / sqrt(k): over 1000 maps at most 0.018 here, and 1.4 times
    // that under a filter; 4 sigma.
    const double truth = 2000.0 * decoded_watts / 4 / std::numbers::pi;
    for (const Filter filter : {Filter::none, Filter::cone, Filter::gaussian}) {
        EXPECT_NEAR(mean_estimate(5, std::numeric_limits<float>::infinity(), filter, 1000) / truth, 1, 0.08)
            << filter_names[static_cast<std::size_t>(filter)];
        EXPECT_NEAR(mean_estimate(40, std::numeric_limits<float>::infinity(), filter, 400) / truth, 1, 0.05);
        EXPECT_NEAR(mean_estimate(2000, 0.15f, filter, 400) / truth, 1, 0.05);
    }
}

TEST(RadianceEstimate, CountsTheFarthestPhotonOfAFullSetAsTheBoundOnly) {
    // Photons at distance 1 and 2: the disc of the second holds the first alone.
    const Material white{.name = "white", .diffuse = {1, 1, 1}};
    std::vector<trace::Photon> photons = even_floor(2, 1, 1);
    photons[0].position = {1, 0, 0};
    photons[1].position = {0, 2, 0};
    const std::vector<trace::Photon> heap = spatial::left_balanced(photons);
    const spatial::PhotonKd tree(heap);
    spatial::NearestSet found(2);
    spatial::nearest(tree, {0, 0, 0}, found);
    const double estimate = static_cast<double>(
        reflected_radiance(tree, found, {&white, {0, 0, 1}, {0, 0, 1}}, Filter::none, true).x);
    EXPECT_NEAR(estimate, decoded_watts / (4 * std::numbers::pi) / std::numbers::pi, 1e-6);
}

TEST(RadianceEstimate, DoesNotUsePhotonsOfSurfacesThatFaceElsewhereUnlessItIsTold) {
    const Material white{.name = "white", .diffuse = {1, 1, 1}};
    std::vector<trace::Photon> photons = even_floor(300, 1, 1);
    std::vector<trace::Photon> wall = even_floor(300, 1, 2, {1, 0, 0});
    photons.insert(photons.end(), wall.begin(), wall.end());
    const std::vector<trace::Photon> heap = spatial::left_balanced(photons),
                                     floor = spatial::left_balanced(even_floor(300, 1, 1));
    const auto estimate = [&](const std::vector<trace::Photon>& map, bool check) {
        spatial::NearestSet found(1000, 0.4f);
        spatial::nearest(spatial::PhotonKd(map), {0, 0, 0}, found);
        return static_cast<double>(reflected_radiance(spatial::PhotonKd(map), found,
                                                      {&white, {0, 0, 1}, {0, 0, 1}}, Filter::none, check)
                                       .x);
    };
    EXPECT_NEAR(estimate(heap, true), estimate(floor, true), 1e-4 * estimate(floor, true));
    EXPECT_GT(estimate(heap, false), 1.5 * estimate(heap, true));
}

/// The paper, section 6.2; a stored normal is within 2 degrees of the surface's.
TEST(RadianceEstimate, UsesPhotonsOfSurfacesThatFaceUpTo60DegreesElsewhere) {
    const Material white{.name = "white", .diffuse = {1, 1, 1}};
    const auto estimate = [&](double degrees, double around) {
        const double polar = degrees * std::numbers::pi / 180;
        const std::vector<trace::Photon> heap = spatial::left_balanced(even_floor(
            50, 1, 1,
            {static_cast<float>(std::sin(polar) * std::cos(around)),
             static_cast<float>(std::sin(polar) * std::sin(around)), static_cast<float>(std::cos(polar))}));
        spatial::NearestSet found(100, 0.4f);
        spatial::nearest(spatial::PhotonKd(heap), {0, 0, 0}, found);
        return reflected_radiance(spatial::PhotonKd(heap), found, {&white, {0, 0, 1}, {0, 0, 1}},
                                  Filter::none, true)
            .x;
    };
    const float whole = estimate(0, 0);
    ASSERT_GT(whole, 0);
    for (const double around : {0.1, 1.7, 3.3, 5.0}) {
        for (const double degrees : {30, 50, 57}) EXPECT_EQ(estimate(degrees, around), whole) << degrees;
        for (const double degrees : {63, 75, 89, 120}) EXPECT_EQ(estimate(degrees, around), 0) << degrees;
    }
}

TEST(RadianceEstimate, OfPhotonsThatDoNotTellTheirSurfaceUsesThem) {
    const Material white{.name = "white", .diffuse = {1, 1, 1}};
    std::vector<trace::Photon> photons = even_floor(100, 1, 1);
    for (trace::Photon& photon : photons) photon.flags = 0;
    const std::vector<trace::Photon> heap = spatial::left_balanced(photons);
    spatial::NearestSet found(50);
    spatial::nearest(spatial::PhotonKd(heap), {0, 0, 0}, found);
    EXPECT_GT(
        reflected_radiance(spatial::PhotonKd(heap), found, {&white, {0, 0, 1}, {0, 0, 1}}, Filter::none, true)
            .x,
        0);
}

TEST(RadianceEstimate, IsBlackWhereNothingIsFoundOrAllPhotonsLieAtThePoint) {
    const Material white{.name = "white", .diffuse = {1, 1, 1}};
    std::vector<trace::Photon> photons = even_floor(100, 1, 1);
    for (trace::Photon& photon : photons) photon.position = {};
    const std::vector<trace::Photon> heap = spatial::left_balanced(photons);
    for (const Vec3 point : {Vec3{0, 0, 0}, Vec3{9, 0, 0}}) {
        spatial::NearestSet found(50, 1);
        spatial::nearest(spatial::PhotonKd(heap), point, found);
        EXPECT_EQ(reflected_radiance(spatial::PhotonKd(heap), found, {&white, {0, 0, 1}, {0, 0, 1}},
                                     Filter::none, true),
                  Vec3{});
    }
}

}  // namespace
}  // namespace regather::capture
