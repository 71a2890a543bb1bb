#include "capture/sampling/oracle.h"

#include <cmath>

#include "capture/sampling/table_guide.h"
#include "trace/range.h"

namespace regather::capture {
namespace {

constexpr trace::Parameter oracle_keys[] = {
    {"rows", "4", "of the table, by the angle to the normal"},
    {"columns", "16", "of the table, about the normal; an even number"},
    {"floor", "5", "[%] of the density that looks at no light"},
    {"probes", "4", "along each side of a cell"},
    {"brdf", "1", "1: the table is taken times the BRDF"},
};

class Oracle final : public TableGuide {
public:
    Oracle(const trace::Parameters& given, const PhotonGuide& guide)
        : TableGuide(given.count("rows"), given.count("columns"), given.count("floor") / 100.0,
                     given.count("brdf") != 0),
          guide_(guide),
          probes_(given.count("probes")) {}

private:
    void fill(const ShadedPoint& point, std::span<float> shares) override {
        const auto place = [this](std::uint32_t cell, std::uint32_t probe, std::uint32_t cells) {
            return (static_cast<float>(cell) +
                    (static_cast<float>(probe) + 0.5f) / static_cast<float>(probes_)) /
                   static_cast<float>(cells);
        };
        for (std::uint32_t cell = 0; cell < shares.size(); ++cell) {
            double squares = 0;
            for (std::uint32_t probe = 0; probe < probes_ * probes_; ++probe) {
                const Vec3 direction = frame().to_world(
                    cosine_hemisphere(place(cell / table().columns(), probe / probes_, table().rows()),
                                      place(cell % table().columns(), probe % probes_, table().columns())));
                const double light = brightness(guide_.seen(point.origin, direction));
                squares += light * light;
            }
            shares[cell] = static_cast<float>(std::sqrt(squares / (probes_ * probes_)));
        }
    }

    const PhotonGuide& guide_;
    std::uint32_t probes_;
};

}  // namespace

std::span<const trace::Parameter> oracle_parameters() {
    return oracle_keys;
}

std::unique_ptr<GatherDistribution> make_oracle(const trace::Parameters& given, const PhotonGuide& guide) {
    trace::require_range("oracle", "floor", given.count("floor"), 1, 100);
    trace::require_range("oracle", "probes", given.count("probes"), 1, 64);
    trace::require_range("oracle", "brdf", given.count("brdf"), 0, 1);
    return std::make_unique<Oracle>(given, guide);
}

}  // namespace regather::capture
