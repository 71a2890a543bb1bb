// capture/sampling/gather_distribution.h -- how the directions of a shaded point's gather rays are chosen
// (the paper, section 7), and the one table of strategies.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "capture/light/bsdf.h"
#include "capture/sampling/operations.h"
#include "capture/sampling/photon_guide.h"
#include "capture/sampling/strata.h"
#include "trace/parameters.h"

namespace regather::capture {

/// Of a material that is diffuse or glossy, and not black.
struct ShadedPoint {
    GatherPoint surface{};
    Vec3 position{};  ///< [scene units]
    Vec3 origin{};    ///< Of rays that leave it [scene units].
};

struct GatherSample {
    Vec3 direction;      ///< Unit length, pointing away.
    double density = 0;  ///< [1/sr] With which it was drawn, by whichever technique, above 0.
    /// [1/sr] What the light of this direction is divided by: the density, unless techniques are weighted by
    /// another heuristic than balance.
    double divisor = 0;
    /// The density is cos / pi, so that a diffuse surface weighs each ray by its albedo, without rounding.
    bool is_cosine = false;
};

/// A density over the directions at one point after the other. One for each thread.
class GatherDistribution {
public:
    virtual ~GatherDistribution() = default;
    /// What follows is of this point, which outlives it.
    virtual void look(const ShadedPoint& point) = 0;
    /// A direction by a point of the unit square and what further numbers it takes. False: none, which counts
    /// as no light.
    virtual bool sample(Strata::Point place, Sampler& sampler, GatherSample& found) const = 0;
    /// [1/sr] With which sample() finds a direction above the surface.
    virtual double pdf(Vec3 direction) const = 0;
};

struct SamplingStrategy {
    std::string_view name, summary;
    std::span<const trace::Parameter> parameters;
    /// The guide outlives the distribution.
    std::unique_ptr<GatherDistribution> (*make)(const trace::Parameters& given, const PhotonGuide& guide);
    /// For a point of a diffuse or a glossy surface.
    SamplingCost (*cost)(const trace::Parameters& given, bool glossy);
};

/// The strategy default_sampling.
std::unique_ptr<GatherDistribution> make_scattering();

/// The one table of strategies.
std::span<const SamplingStrategy> sampling_strategies();

/// What is done without a word on it.
inline constexpr std::string_view default_sampling = "brdf:even=0";

/// What a spec NAME:parameter=value,... asked for.
struct SamplingSpec {
    const SamplingStrategy* strategy;
    trace::Parameters parameters;
    std::string text;  ///< All parameters, defaults too; a spec again.

    std::unique_ptr<GatherDistribution> make(const PhotonGuide& guide) const {
        return strategy->make(parameters, guide);
    }
    SamplingCost cost(bool glossy) const { return strategy->cost(parameters, glossy); }
    /// Of the gather rays of a point. All strategies have even ones but the default, whose pictures stay the
    /// bytes that they were, unless it is asked.
    StrataShape strata() const;
    /// Photons that it asks for at each shaded point; 0: none.
    std::uint32_t photons_asked() const;
};
/// Throws trace::UsageError for an unknown strategy, names the nearest and lists all, and for its parameters.
SamplingSpec parse_sampling(std::string_view spec);

}  // namespace regather::capture
