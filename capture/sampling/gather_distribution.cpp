#include "capture/sampling/gather_distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "capture/sampling/footprints.h"
#include "capture/sampling/incident.h"
#include "capture/sampling/lobes.h"
#include "capture/sampling/mixture.h"
#include "capture/sampling/oracle.h"
#include "trace/range.h"
#include "trace/word.h"

namespace regather::capture {
namespace {

/// Directions about the normal by a fixed density.
class AboutNormal : public GatherDistribution {
public:
    void look(const ShadedPoint& point) override { frame_ = Frame(point.surface.normal); }

protected:
    const Frame& frame() const { return frame_; }
    float cosine(Vec3 direction) const { return dot(frame_.normal, direction); }

private:
    Frame frame_{{0, 0, 1}};
};

class Uniform final : public AboutNormal {
public:
    bool sample(Strata::Point place, Sampler&, GatherSample& found) const override {
        // The cosine of the angle to the normal is uniform: its square's complement is sin^2.
        const float up = 1 - place.along_rows;
        found = {frame().to_world(cosine_hemisphere(1 - up * up, place.along_columns)),
                 0.5 * std::numbers::inv_pi, 0.5 * std::numbers::inv_pi};
        return true;
    }
    double pdf(Vec3 direction) const override {
        return cosine(direction) > 0 ? 0.5 * std::numbers::inv_pi : 0;
    }
};

class Cosine final : public AboutNormal {
public:
    bool sample(Strata::Point place, Sampler&, GatherSample& found) const override {
        found.direction = frame().to_world(cosine_hemisphere(place.along_rows, place.along_columns));
        found.density = found.divisor = pdf(found.direction);
        found.is_cosine = true;
        return true;
    }
    double pdf(Vec3 direction) const override {
        return std::max(0.0, static_cast<double>(cosine(direction)) * std::numbers::inv_pi);
    }
};

class Scattering final : public GatherDistribution {
public:
    void look(const ShadedPoint& point) override {
        point_ = point.surface;
        cosine_.look(point);
    }
    bool sample(Strata::Point place, Sampler& sampler, GatherSample& found) const override {
        if (point_.material->kind != MaterialKind::glossy) return cosine_.sample(place, sampler, found);
        const float choice = sampler.uniform();
        if (!sample_direction(*point_.material, point_.normal, point_.to_viewer, choice, place.along_rows,
                              place.along_columns, found.direction))
            return false;
        found.density = found.divisor = pdf(found.direction);
        found.is_cosine = false;
        return found.density > 0;
    }
    double pdf(Vec3 direction) const override {
        if (point_.material->kind != MaterialKind::glossy) return cosine_.pdf(direction);
        return static_cast<double>(scatter_pdf(*point_.material, point_.normal, point_.to_viewer, direction));
    }

private:
    GatherPoint point_{};
    Cosine cosine_;
};

template <class Distribution>
std::unique_ptr<GatherDistribution> make(const trace::Parameters&, const PhotonGuide&) {
    return std::make_unique<Distribution>();
}

constexpr trace::Parameter scattering_parameters[] = {
    {"even", "0", "1: strata of any number of rays; 0: a grid by its divisors, so a prime number is one row"},
};

std::span<const SamplingStrategy> table() {
    static const SamplingStrategy all[] = {
        {"uniform", "every direction above the surface alike", {}, make<Uniform>, cost_of_uniform},
        {"cosine", "by the cosine of the angle to the normal", {}, make<Cosine>, cost_of_cosine},
        {"brdf", "as the surface scatters: diffuse by the cosine, glossy by the two lobes of its material",
         scattering_parameters, make<Scattering>, cost_of_scattering},
        {"incident", "by where the photons about the point came from, at least the floor of the cosine",
         incident_parameters(), make_incident, cost_of_incident},
        {"combined", "by the same table times the BRDF", incident_parameters(), make_combined,
         cost_of_combined},
        {"footprints", "by discs about where the photons came from, smaller where more did",
         footprint_parameters(), make_footprints, cost_of_footprints},
        {"lobes", "by a mixture of von Mises-Fisher lobes fitted to those photons, times the cosine",
         lobe_parameters(), make_lobes, cost_of_lobes},
        {"mis", "by the BRDF or by that table, each weighted (Veach & Guibas 1995)", mixture_parameters(),
         make_mixture, cost_of_mixture},
        {"oracle", "by a table of the light that gather rays would find: a ceiling, at any cost",
         oracle_parameters(), make_oracle, cost_of_oracle},
    };
    return all;
}

}  // namespace

std::unique_ptr<GatherDistribution> make_scattering() {
    return std::make_unique<Scattering>();
}

std::span<const SamplingStrategy> sampling_strategies() {
    return table();
}

std::uint32_t SamplingSpec::photons_asked() const {
    return parameters.knows("k") ? parameters.count("k") : 0;
}

StrataShape SamplingSpec::strata() const {
    return parameters.knows("even") && parameters.count("even") == 0 ? StrataShape::grid : StrataShape::even;
}

SamplingSpec parse_sampling(std::string_view spec) {
    const auto [which, behind] = trace::named_spec("sampling", spec, table());
    const SamplingStrategy& strategy = table()[which];
    trace::Parameters parameters(strategy.name, strategy.parameters, behind);
    if (parameters.knows("even")) trace::require_range(strategy.name, "even", parameters.count("even"), 0, 1);
    const std::string given = parameters.text();
    return {&strategy, std::move(parameters),
            given.empty() ? std::string(strategy.name) : fmt::format("{}:{}", strategy.name, given)};
}

}  // namespace regather::capture
