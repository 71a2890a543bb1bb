// Photon maps without volume, extreme searches, and what the 20 bytes of a photon cost: against brute force
// in double.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "capture/radiance_estimate.h"
#include "capture/sampler.h"
#include "spatial/photons/nearest.h"
#include "study/case.h"
#include "trace/photon.h"

namespace regather::study {
namespace {

using trace::Photon, trace::Vec3;

enum class Form { point, line, plane };

/// On the plane z = 0 around (0.3, 0.4), travelling down; all powers equal, which is the worst for sums in
/// float.
std::vector<Photon> photons_in(Form form, std::size_t count) {
    std::vector<Photon> photons(count);
    capture::Sampler sampler(17, capture::Stream::photon, count);
    for (Photon& photon : photons) {
        const float x = sampler.uniform(), y = sampler.uniform();
        photon.position = {form == Form::point ? 0.3f : x, form == Form::plane ? y : 0.4f, 0};
        trace::encode_direction({0, 0, -1}, photon);
        trace::encode_normal({0, 0, 1}, photon);
        trace::encode_power(Vec3{1, 0.5f, 0.25f} * (1 / static_cast<float>(count)), photon.power);
    }
    return photons;
}

capture::Material grey() {
    capture::Material material;
    material.diffuse = {0.5f, 0.5f, 0.5f};
    return material;
}

struct Gather {
    std::uint32_t k;
    float radius = INFINITY;
};

Vec3 estimate(const std::vector<Photon>& heap, Vec3 point, Gather gather) {
    const spatial::PhotonKd tree(heap);
    spatial::NearestSet found(gather.k, gather.radius);
    spatial::nearest(tree, point, found);
    const capture::Material material = grey();
    return capture::reflected_radiance(tree, found, {&material, {0, 0, 1}, {0, 0, 1}}, capture::Filter::none,
                                       true);
}

/// Equation 2 in double over all photons, the disc's farthest photon left out as in
/// capture/radiance_estimate.h.
double brute_force(const std::vector<Photon>& photons, Vec3 point, Gather gather) {
    std::vector<std::pair<double, double>> by_distance;
    for (const Photon& photon : photons) {
        const double x = double{photon.position.x} - point.x, y = double{photon.position.y} - point.y,
                     z = double{photon.position.z} - point.z, distance2 = x * x + y * y + z * z;
        if (distance2 <= double{gather.radius} * gather.radius)
            by_distance.emplace_back(distance2, trace::decode_power(photon.power).x);
    }
    std::sort(by_distance.begin(), by_distance.end());
    const bool full = by_distance.size() >= gather.k;
    if (full) by_distance.resize(gather.k);
    if (by_distance.empty()) return 0;
    const double radius2 = full || !std::isfinite(gather.radius) ? by_distance.back().first
                                                                 : double{gather.radius} * gather.radius;
    if (full && by_distance.size() > 1) by_distance.pop_back();
    double sum = 0;
    for (const auto& [distance2, power] : by_distance) sum += power;
    return radius2 > 0 ? 0.5 / std::numbers::pi * sum / (std::numbers::pi * radius2) : 0;
}

std::size_t count_of(Effort effort) {
    return effort == Effort::quick ? 20'000 : 1'000'000;
}

Case gathered(std::string name, Form form, Vec3 point, Gather gather, double allowed, std::string reason) {
    return {std::move(name), "relative error of the radiance", std::move(reason), [=](Effort effort) {
                const std::vector<Photon> photons = photons_in(form, count_of(effort));
                Gather asked = gather;
                asked.k = std::min<std::uint32_t>(gather.k, static_cast<std::uint32_t>(photons.size()));
                const double truth = brute_force(photons, point, asked);
                const Vec3 found = estimate(spatial::left_balanced(photons), point, asked);
                return Reading{truth == 0 ? std::fabs(found.x) : std::fabs(found.x - truth) / truth, allowed};
            }};
}

/// Of the channels that are kept or of those that are lost, as a share of the largest one, over 200 binary
/// orders of magnitude.
Reading power_round_trip(Effort effort, bool lost) {
    capture::Sampler sampler(23, capture::Stream::photon, 1);
    double worst = 0;
    const int count = effort == Effort::quick ? 200'000 : 20'000'000;
    for (int i = 0; i < count; ++i) {
        const float scale = std::ldexp(1.0f, static_cast<int>(sampler.below(200)) - 100);
        const float r = sampler.uniform(), g = sampler.uniform(), b = sampler.uniform();
        const Vec3 power = Vec3{r, g, b * b * b} * scale;
        std::uint8_t bytes[4];
        trace::encode_power(power, bytes);
        const Vec3 back = trace::decode_power(bytes);
        const double largest = max_component(power);
        if (!(largest > 0)) continue;
        for (int c = 0; c < 3; ++c)
            if ((back[c] == 0) == lost)
                worst = std::max(worst, std::fabs(double{back[c]} - power[c]) / largest);
    }
    return {worst, lost ? 1 / 128.0 : 1 / 256.0};
}

/// Of the sum over many photons: truncation alone would lose 1/512 of the largest channel from each.
Reading power_bias(Effort effort) {
    capture::Sampler sampler(29, capture::Stream::photon, 2);
    double truth = 0, found = 0;
    const int count = effort == Effort::quick ? 200'000 : 20'000'000;
    for (int i = 0; i < count; ++i) {
        const float value = 0.5f + 0.5f * sampler.uniform();
        std::uint8_t bytes[4];
        trace::encode_power({value, value, value}, bytes);
        truth += value;
        found += trace::decode_power(bytes).x;
    }
    return {std::fabs(found - truth) / truth, 4.5 / 256 / std::sqrt(12.0 * count) + 1e-6};
}

Vec3 on_sphere(capture::Sampler& sampler) {
    const double z = 2 * sampler.fine_uniform() - 1, phi = 2 * std::numbers::pi * sampler.fine_uniform();
    const double r = std::sqrt(1 - z * z);
    return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
            static_cast<float>(z)};
}

double angle_between(Vec3 a, Vec3 b) {
    const double x = double{a.y} * b.z - double{a.z} * b.y, y = double{a.z} * b.x - double{a.x} * b.z,
                 z = double{a.x} * b.y - double{a.y} * b.x;
    return std::atan2(std::sqrt(x * x + y * y + z * z),
                      double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z);
}

template <class RoundTrip>
Reading worst_angle(Effort effort, std::uint64_t seed, double allowed, const RoundTrip& round_trip) {
    capture::Sampler sampler(seed, capture::Stream::photon, 3);
    double worst = 0;
    for (int i = 0; i < (effort == Effort::quick ? 200'000 : 5'000'000); ++i) {
        const Vec3 direction = on_sphere(sampler);
        worst = std::max(worst, angle_between(direction, round_trip(direction)));
    }
    for (const Vec3 axis :
         {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
        worst = std::max(worst, angle_between(axis, round_trip(axis)));
    return {worst, allowed};
}

}  // namespace

std::vector<Case> degenerate_map_cases() {
    constexpr std::uint32_t all = 0xffffffffu;
    const std::string sum = "a sum of k summands in float";
    return {
        gathered("all photons in one point, seen from it", Form::point, {0.3f, 0.4f, 0}, {100}, 0,
                 "no disc: 0, not infinite"),
        gathered("all photons in one point, seen from beside it", Form::point, {0.31f, 0.4f, 0}, {100}, 1e-5,
                 sum),
        gathered("all photons on a line, seen from it", Form::line, {0.5f, 0.4f, 0}, {100}, 1e-5, sum),
        gathered("all photons on a line, seen from beside it", Form::line, {0.5f, 0.41f, 0}, {100}, 1e-5,
                 sum),
        gathered("all photons in a plane", Form::plane, {0.5f, 0.5f, 0}, {100}, 1e-5, sum),
        gathered("radius zero", Form::plane, {0.5f, 0.5f, 0}, {100, 0}, 0, "no disc: 0, not infinite"),
        gathered("radius of 1e-30 m", Form::plane, {0.5f, 0.5f, 0}, {100, 1e-30f}, 0,
                 "its square is no float: as radius zero"),
        gathered("k = 1", Form::plane, {0.5f, 0.5f, 0}, {1}, 1e-5,
                 "one photon, and the square of its distance"),
        gathered("k = all photons of 1e6", Form::plane, {0.5f, 0.5f, 0}, {all}, 1e-5,
                 "no worse than a few photons"),
        {"power of a photon, RGBE, channels that are kept", "worst error / largest channel",
         "documented: 1/256", [](Effort effort) { return power_round_trip(effort, false); }},
        {"power of a photon, RGBE, channels that are lost", "worst error / largest channel",
         "documented: 1/128", [](Effort effort) { return power_round_trip(effort, true); }},
        {"power of a photon, RGBE, sum of many", "relative error of the sum",
         "middle of the interval: no bias; 4.5 sigma", power_bias},
        {"direction of a photon, round trip", "worst angle [rad]", "documented: 0.02",
         [](Effort effort) {
             return worst_angle(effort, 31, 0.02, [](Vec3 direction) {
                 Photon photon;
                 trace::encode_direction(direction, photon);
                 return trace::decode_direction(photon);
             });
         }},
        {"surface normal of a photon, round trip", "worst angle [rad]",
         "documented: 0.034, 3 sqrt(2) / 126 amid a face of the octahedron",
         [](Effort effort) {
             return worst_angle(effort, 37, 0.034, [](Vec3 direction) {
                 Photon photon;
                 trace::encode_normal(direction, photon);
                 return trace::decode_normal(photon);
             });
         }},
    };
}

}  // namespace regather::study
