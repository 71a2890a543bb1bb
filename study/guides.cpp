// Strategies of gather rays where the photons that guide them say nothing, or only one thing: finite, and
// without bias.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "capture/reference/moments.h"
#include "capture/sampling/gather_distribution.h"
#include "study/case.h"

namespace regather::study {
namespace {

using capture::Sampler, trace::Vec3;

/// Where photon i of a point came from, about the normal, and its power.
struct GuidingPhoton {
    Vec3 from{};
    float power = 0;
};
struct Situation {
    std::string_view name;
    std::uint32_t photons;
    GuidingPhoton (*photon)(std::uint32_t i, Sampler& sampler);
};

Vec3 anywhere(Sampler& sampler) {
    const float u = sampler.uniform(), v = sampler.uniform();
    return capture::cosine_hemisphere(u, v);
}

constexpr Situation situations[] = {
    {"nothing found", 0, nullptr},
    {"one photon", 1,
     [](std::uint32_t, Sampler&) {
         return GuidingPhoton{{0.6f, 0, 0.8f}, 1};
     }},
    {"no power", 300,
     [](std::uint32_t, Sampler& sampler) {
         return GuidingPhoton{anywhere(sampler), 0};
     }},
    {"all from one direction", 300,
     [](std::uint32_t, Sampler&) {
         return GuidingPhoton{{0.36f, 0.48f, 0.8f}, 1};
     }},
    {"all from the horizon", 300,
     [](std::uint32_t, Sampler&) {
         return GuidingPhoton{{-1, 0, 0}, 1};
     }},
    {"all from below", 300,
     [](std::uint32_t, Sampler& sampler) {
         return GuidingPhoton{-anywhere(sampler), 1};
     }},
    {"powers over 24 decades", 300,
     [](std::uint32_t i, Sampler& sampler) {
         return GuidingPhoton{anywhere(sampler), std::pow(10.0f, static_cast<float>(i % 25) - 12)};
     }},
};

/// The mean over the sampled directions of what surfaces that reflect as the cosine would have: 1, whoever
/// draws. Where a direction is not drawn it counts as 0.
Case unbiased(const std::string& spec, const Situation& situation, float exponent, double degrees) {
    return {
        fmt::format("{}, {}{}", spec, situation.name,
                    exponent > 0 ? fmt::format(", exponent {:g} at {:g} degrees", exponent, degrees) : ""),
        "mean of cos / pi over the density, less 1", "4.5 sigma of the samples, and 1e-3",
        [=, &situation](Effort effort) {
            std::vector<trace::Photon> photons(situation.photons);
            for (std::uint32_t i = 0; i < situation.photons; ++i) {
                Sampler sampler(3, capture::Stream::photon, i);
                const GuidingPhoton given = situation.photon(i, sampler);
                photons[i].position = {1e-3f * static_cast<float>(i), 0, 0};
                trace::encode_direction(-given.from, photons[i]);
                trace::encode_power({given.power, given.power, given.power}, photons[i].power);
            }
            const std::vector<trace::Photon> heap = spatial::left_balanced(photons);
            const std::vector<capture::PhotonOrigin> origin(heap.size(), capture::PhotonOrigin::surface);
            const capture::PhotonGuide guide{spatial::PhotonKd(heap), origin, true,
                                             [](Vec3, Vec3) { return Vec3{}; }};
            capture::Material surface;
            surface.diffuse = {0.3f, 0.3f, 0.3f};
            if (exponent > 0) {
                surface.kind = capture::MaterialKind::glossy;
                surface.specular = {0.4f, 0.4f, 0.4f};
                surface.exponent = exponent;
            }
            const double angle = degrees * std::numbers::pi / 180;
            const Vec3 viewer{static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
            const auto distribution = capture::parse_sampling(spec).make(guide);
            distribution->look({{&surface, {0, 0, 1}, viewer}, {0, 0, 0}, {0, 0, 0}});
            const std::uint32_t samples = effort == Effort::quick ? 20'000 : 1'000'000;
            capture::MomentsOf<1> mean;
            for (std::uint32_t i = 0; i < samples; ++i) {
                Sampler sampler(7, capture::Stream::gather, 1, i);
                const float u = sampler.uniform(), v = sampler.uniform();
                capture::GatherSample found;
                double value = 0;
                if (distribution->sample({u, v}, sampler, found)) {
                    if (!trace::is_finite(found.direction) || !std::isfinite(found.density) ||
                        !(found.divisor > 0))
                        return Reading{std::numeric_limits<double>::infinity(), 1e-3};
                    value = std::max(0.0, double{found.direction.z}) / std::numbers::pi / found.divisor;
                }
                mean.add({value}, std::uint64_t{i} + 1);
            }
            return sampled(std::fabs(mean.mean[0] - 1), 1e-3, std::sqrt(mean.variance(0, samples)), 0.15);
        }};
}

}  // namespace

std::vector<Case> guide_cases() {
    std::vector<Case> cases;
    for (const std::string& spec :
         {std::string("incident"), std::string("lobes"), std::string("lobes:lobes=16,shrink=0,floor=5"),
          std::string("footprints"), std::string("footprints:neighbours=1,floor=5")})
        for (const Situation& situation : situations) cases.push_back(unbiased(spec, situation, 0, 0));
    for (const std::string& spec : {std::string("combined"), std::string("mis"), std::string("oracle")})
        for (const float exponent : {1.0f, 1e6f})
            for (const double degrees : {0.0, 89.999})
                for (const std::size_t which : {0, 3})
                    cases.push_back(unbiased(spec, situations[which], exponent, degrees));
    return cases;
}

}  // namespace regather::study
