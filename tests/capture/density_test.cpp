// The k nearest photons as an estimate of density, where the density is known: what it is off by on average
// goes with k / n and with the density's curvature, and its scatter with the root of k (Mack & Rosenblatt
// 1979).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "capture/radiance_estimate.h"
#include "capture/reference/moments.h"
#include "capture/sampler.h"

namespace regather::capture {
namespace {

constexpr double curvature = 60;  // the density is 1 + curvature x^2

/// The integral of the density from 0 to x.
double below(double x) {
    return x + curvature / 3 * x * x * x;
}

/// The x below which the share u of the photons between -half_width and half_width lies.
double place_of(double u, double half_width) {
    const double t = (2 * u - 1) * below(half_width);
    double x = t < 0 ? -half_width : half_width;  // by Newton, from beyond the root
    for (int i = 0; i < 20; ++i) x -= (below(x) - t) / (1 + curvature * x * x);
    return x;
}

struct Estimates {
    double bias, deviation, bias_error;  ///< Relative to the density at x = 0.
};

/// `photons` a square metre at x = 0, on a strip along y; estimates along its middle, too far from each other
/// to share photons.
Estimates estimates(double photons, std::uint32_t k, double half_width, std::uint64_t seed) {
    const Material white{.name = "white", .diffuse = {1, 1, 1}};
    const int queries = 500;
    const double radius = std::sqrt(k / (std::numbers::pi * photons)), length = (queries + 2) * 2.4 * radius;
    std::vector<trace::Photon> map(static_cast<std::size_t>(photons * 2 * below(half_width) * length));
    Sampler sampler(seed, Stream::photon, 0);
    for (trace::Photon& photon : map) {
        photon.position = {static_cast<float>(place_of(static_cast<double>(sampler.uniform()), half_width)),
                           static_cast<float>(length * static_cast<double>(sampler.uniform())), 0};
        trace::encode_power({1, 1, 1}, photon.power);
        trace::encode_direction({0, 0, -1}, photon);
        trace::encode_normal({0, 0, 1}, photon);
    }
    const std::vector<trace::Photon> heap = spatial::left_balanced(map);
    const spatial::PhotonKd tree(heap);
    const double truth =
        photons * static_cast<double>(trace::decode_power(heap[0].power).x) / std::numbers::pi;
    MomentsOf<1> all;
    for (int q = 0; q < queries; ++q) {
        spatial::NearestSet found(k, std::numeric_limits<float>::infinity());
        spatial::nearest(tree, {0, static_cast<float>((q + 1.5) * 2.4 * radius), 0}, found);
        all.add({static_cast<double>(
                     reflected_radiance(tree, found, {&white, {0, 0, 1}, {0, 0, 1}}, Filter::none, true).x) /
                 truth},
                static_cast<std::uint64_t>(q) + 1);
    }
    const double error = std::sqrt(all.variance(0, queries));
    return {all.mean[0] - 1, error * std::sqrt(double{queries}), error};
}

/// The mean of 1 + c x^2 over a disc of radius R is 1 + c R^2 / 4, and k = n pi R^2 of that.
double bias_of_disc(double photons, double k) {
    const double even = k / (std::numbers::pi * photons);
    const double square = (std::sqrt(1 + curvature * even) - 1) / (curvature / 2);
    return curvature * square / 4;
}

TEST(Density, IsOffByTheShareOfThePhotonsThatAreAsked) {
    // At twice the k the bias is twice as much, at twice the photons half: to first order curvature k / (4 pi
    // n).
    const Estimates base = estimates(4000, 60, 0.2, 1), more = estimates(4000, 120, 0.2, 2),
                    finer = estimates(8000, 120, 0.2, 3);
    for (const auto& [found, photons, k] :
         {std::tuple{base, 4000, 60}, std::tuple{more, 4000, 120}, std::tuple{finer, 8000, 120}}) {
        EXPECT_LT(4 * found.bias_error, 0.03);
        EXPECT_NEAR(found.bias, bias_of_disc(photons, k), 4 * found.bias_error) << photons << " " << k;
        EXPECT_NEAR(found.bias / (curvature * k / (4 * std::numbers::pi * photons)), 1, 0.35)
            << photons << " " << k;
    }
    EXPECT_GT(more.bias, base.bias + 5 * std::hypot(base.bias_error, more.bias_error));
    EXPECT_LT(finer.bias, more.bias - 5 * std::hypot(finer.bias_error, more.bias_error));
}

TEST(Density, ScattersWithTheRootOfK) {
    // Even: 1 / sqrt(k - 2). The deviation of 500 estimates is known to 1 / sqrt(1000).
    for (const auto& [k, photons] : {std::pair{18u, 20'000}, {66u, 50'000}, {258u, 100'000}}) {
        const double expected = 1 / std::sqrt(k - 2.0);
        EXPECT_NEAR(estimates(photons, k, 0.06, k).deviation / expected, 1, 4 / std::sqrt(1000.0)) << k;
    }
}

}  // namespace
}  // namespace regather::capture
