#include "capture/sampling/lobes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "capture/sampling/doubled_guide.h"
#include "trace/range.h"

namespace regather::capture {
namespace {

constexpr trace::Parameter lobe_keys[] = {
    {"lobes", "4", "of the mixture, up to 16"},
    {"k", "400", "photons that are asked"},
    {"floor", "10",
     "[%] of the density that looks at no photon: light from where no photon came is found, too"},
    {"iterations", "4", "of expectation and maximisation, from lobes that are spread evenly"},
    {"shrink", "1", "1: the mixture goes towards the cosine as far as so few photons may differ by chance"},
};

constexpr std::uint32_t most_lobes = 16;
constexpr double pi = std::numbers::pi;

/// exp(kappa cos) of the angle to the axis, with integral 1.
struct Lobe {
    Vec3 axis;
    float kappa = 0;  ///< Concentration; 0: uniform.
    float up_to = 1;  ///< The shares up to this one's end.
};

/// kappa / (1 - exp(-2 kappa)), from 1 / 2 up.
double steepness(double kappa) {
    return kappa > 0 ? kappa / -std::expm1(-2 * kappa) : 0.5;
}

/// Of the density: at the axis it is steepness / (2 pi).
double density_of_lobe(Vec3d axis, double kappa, Vec3d at) {
    // 1 - cos by the distance, which does not cancel where the lobe is steep.
    const Vec3d off = at - axis;
    return steepness(kappa) / (2 * pi) * std::exp(-0.5 * kappa * dot(off, off));
}

/// 1 - cos of the angle to the axis that the share u of the lobe is nearer than.
double below_one(double kappa, double u) {
    if (!(kappa > 0)) return 2 * u;
    return std::clamp(-std::log1p(u * std::expm1(-2 * kappa)) / kappa, 0.0, 2.0);
}

/// By the mean cosine (Banerjee et al., "Clustering on the Unit Hypersphere using von Mises-Fisher
/// Distributions", JMLR 6, 2005, equation 4.4).
double kappa_of(double mean_cosine) {
    constexpr double most = 32'000;
    const double squared = mean_cosine * mean_cosine;
    return std::min(mean_cosine * (3 - squared) / (1 - squared), most);
}

/// A lobe as it is fitted.
struct FittedLobe {
    Vec3d axis;
    double kappa = 0, share = 0;
    double photons = 0;  ///< That are its, in this iteration.
    Vec3d sum;           ///< Of where they are.
};

class Lobes final : public DoubledGuide {
public:
    explicit Lobes(const trace::Parameters& given, const PhotonGuide& guide)
        : DoubledGuide(guide, given.count("k"), given.count("floor") / 100.0),
          iterations_(given.count("iterations")),
          shrink_(given.count("shrink") != 0),
          fitted_(given.count("lobes")),
          lobes_(fitted_.size()) {}

private:
    double fit(std::span<const Witness> witnesses) override {
        double total = 0, squares = 0;
        for (const Witness& witness : witnesses) {
            total += witness.power;
            squares += witness.power * witness.power;
        }
        // Of equal photons that would tell as much, their number.
        const double photons = total * total / squares;
        spread();
        for (std::uint32_t i = 0; i < iterations_; ++i) {
            expect(witnesses, photons / total);
            maximise();
        }
        double up_to = 0;
        for (std::size_t j = 0; j < fitted_.size(); ++j) {
            up_to += fitted_[j].share;
            lobes_[j] = {to_float(fitted_[j].axis), static_cast<float>(fitted_[j].kappa),
                         static_cast<float>(up_to)};
        }
        lobes_.back().up_to = 1;
        if (!shrink_) return 1;
        const double chance = (4 * static_cast<double>(fitted_.size()) - 1) / photons, off = unevenness();
        return off > 0 ? std::max(0.0, 1 - chance / off) : 0;
    }

    /// Equal lobes at even distances (a spherical Fibonacci lattice), each as wide as its part of the sphere.
    void spread() {
        const auto count = static_cast<double>(fitted_.size());
        for (std::size_t j = 0; j < fitted_.size(); ++j) {
            const double down = (static_cast<double>(j) + 0.5) / count;
            const double turn = static_cast<double>(j) * (std::numbers::phi - 1);
            fitted_[j] = {about({0, 0, 1}, 2 * down, turn), kappa_of(1 - 1 / count), 1 / count, 0, {}};
        }
    }

    /// What part of each photon is which lobe's. What the floor explains is no lobe's.
    void expect(std::span<const Witness> witnesses, double scale) {
        for (FittedLobe& lobe : fitted_) {
            lobe.photons = 0;
            lobe.sum = {};
        }
        std::array<double, most_lobes> peak{}, parts{};
        for (std::size_t j = 0; j < fitted_.size(); ++j)
            peak[j] = (1 - floor()) * fitted_[j].share * steepness(fitted_[j].kappa) / (2 * pi);
        for (const Witness& witness : witnesses) {
            double all = floor() / (4 * pi);
            for (std::size_t j = 0; j < fitted_.size(); ++j) {
                const Vec3d off = witness.place - fitted_[j].axis;
                parts[j] = peak[j] * std::exp(-0.5 * fitted_[j].kappa * dot(off, off));
                all += parts[j];
            }
            const double weight = scale * witness.power / all;
            for (std::size_t j = 0; j < fitted_.size(); ++j) {
                const double part = weight * parts[j];
                fitted_[j].photons += part;
                fitted_[j].sum += witness.place * part;
            }
        }
    }

    /// The likeliest lobes for these parts, with what is expected without photons: a hundredth of a photon
    /// more in each lobe, and a fifth of a photon in each that came from anywhere (Ruppert et al., section
    /// 4.1; the figures are those of Intel's Open Path Guiding Library).
    void maximise() {
        constexpr double share_prior = 0.01, width_prior = 0.2;
        double total = share_prior * static_cast<double>(fitted_.size());
        for (const FittedLobe& lobe : fitted_) total += lobe.photons;
        for (FittedLobe& lobe : fitted_) {
            const double resultant = length(lobe.sum);
            lobe.share = (lobe.photons + share_prior) / total;
            lobe.kappa = kappa_of(resultant / (lobe.photons + width_prior));
            if (resultant > 0) lobe.axis = lobe.sum * (1 / resultant);
        }
    }

    /// 4 pi times the integral of the mixture's square, less 1: the mean square of its relative difference
    /// from the uniform density.
    double unevenness() const {
        double sum = 0;
        for (const FittedLobe& a : fitted_)
            for (const FittedLobe& b : fitted_) {
                // exp(kappa cos) times exp(kappa cos) is another such lobe.
                const double kappa = length(a.axis * a.kappa + b.axis * b.kappa);
                sum += a.share * b.share * steepness(a.kappa) * steepness(b.kappa) / steepness(kappa) *
                       std::exp(kappa - a.kappa - b.kappa);
            }
        return 2 * sum - 1;
    }

    Vec3d draw(double u, double v, std::size_t& lobe) const override {
        lobe = part_of(lobes_, u);
        return about(lobes_[lobe].axis, below_one(lobes_[lobe].kappa, u), v);
    }

    double density(Vec3d on_sphere, std::size_t) const override {
        double sum = 0, begin = 0;
        for (const Lobe& lobe : lobes_) {
            sum += (lobe.up_to - begin) * density_of_lobe(lobe.axis, lobe.kappa, on_sphere);
            begin = lobe.up_to;
        }
        return sum;
    }

    std::uint32_t iterations_;
    bool shrink_;
    std::vector<FittedLobe> fitted_;
    std::vector<Lobe> lobes_;
};

}  // namespace

std::span<const trace::Parameter> lobe_parameters() {
    return lobe_keys;
}

std::unique_ptr<GatherDistribution> make_lobes(const trace::Parameters& given, const PhotonGuide& guide) {
    trace::require_range("lobes", "lobes", given.count("lobes"), 1, most_lobes);
    trace::require_range("lobes", "k", given.count("k"), 1, 1'000'000);
    trace::require_range("lobes", "floor", given.count("floor"), 1, 100);
    trace::require_range("lobes", "iterations", given.count("iterations"), 1, 100);
    trace::require_range("lobes", "shrink", given.count("shrink"), 0, 1);
    return std::make_unique<Lobes>(given, guide);
}

}  // namespace regather::capture
