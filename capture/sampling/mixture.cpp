#include "capture/sampling/mixture.h"

#include <algorithm>
#include <vector>

#include "capture/sampling/incident.h"
#include "trace/range.h"

namespace regather::capture {
namespace {

class Mixture final : public GatherDistribution {
public:
    Mixture(double of_brdf, bool power, std::unique_ptr<GatherDistribution> incident)
        : of_brdf_(of_brdf), power_(power), scattering_(make_scattering()), incident_(std::move(incident)) {}

    void look(const ShadedPoint& point) override {
        scattering_->look(point);
        incident_->look(point);
    }

    // Each technique has a part of the strata's rows, and strata of its own.
    bool sample(Strata::Point place, Sampler& sampler, GatherSample& found) const override {
        const auto share = static_cast<float>(of_brdf_);
        const bool by_brdf = place.along_rows < share;
        place.along_rows = by_brdf ? place.along_rows / share : (place.along_rows - share) / (1 - share);
        place.along_rows = std::min(place.along_rows, 0x1.fffffep-1f);
        if (!(by_brdf ? scattering_ : incident_)->sample(place, sampler, found)) return false;
        const double brdf = of_brdf_ * scattering_->pdf(found.direction),
                     incident = (1 - of_brdf_) * incident_->pdf(found.direction),
                     own = by_brdf ? brdf : incident;
        found.is_cosine = false;
        found.density = brdf + incident;
        // A direction rounded across a cell's edge may have no density there.
        found.divisor = power_ ? (brdf * brdf + incident * incident) / own : found.density;
        return own > 0;
    }
    double pdf(Vec3 direction) const override {
        return of_brdf_ * scattering_->pdf(direction) + (1 - of_brdf_) * incident_->pdf(direction);
    }

private:
    double of_brdf_;
    bool power_;
    std::unique_ptr<GatherDistribution> scattering_, incident_;
};

}  // namespace

std::span<const trace::Parameter> mixture_parameters() {
    static const std::vector<trace::Parameter> all = [] {
        const std::span<const trace::Parameter> of_table = incident_parameters();
        std::vector<trace::Parameter> list(of_table.begin(), of_table.end());
        list.push_back({"brdf", "50", "[%] of the rays that go by the BRDF"});
        list.push_back({"heuristic", "balance", "balance or power: how the two are weighted"});
        return list;
    }();
    return all;
}

std::unique_ptr<GatherDistribution> make_mixture(const trace::Parameters& given, const PhotonGuide& guide) {
    const std::uint32_t of_brdf = given.count("brdf");
    trace::require_range("mis", "brdf", of_brdf, 1, 99);
    return std::make_unique<Mixture>(of_brdf / 100.0, given.choice("heuristic", {"balance", "power"}) == 1,
                                     make_incident(given, guide));
}

}  // namespace regather::capture
