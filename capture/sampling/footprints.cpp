#include "capture/sampling/footprints.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "capture/sampling/doubled_guide.h"
#include "trace/range.h"

namespace regather::capture {
namespace {

constexpr trace::Parameter footprint_keys[] = {
    {"k", "200", "photons that are asked"},
    {"neighbours", "16", "photons that a footprint reaches as far as"},
    {"floor", "10",
     "[%] of the density that looks at no photon: light from where no photon came is found, too"},
};

/// Of the sphere: a cell of the paper's table of 32 x 32. Photons from one direction leave no smaller one.
constexpr double least_area = 1.0 / 1024;

/// Even where 1 - cos of the angle to the axis is at most twice the area.
struct Footprint {
    Vec3 axis;
    float area = 1;   ///< Part of the sphere, and of the cosine density above the surface.
    float up_to = 1;  ///< The shares of its band up to this one's end.
};

/// Footprints at about the same angle to the normal.
struct Band {
    std::size_t end = 0;  ///< One past its last footprint.
    float up_to = 1;      ///< The shares up to this one's end.
};

class Footprints final : public DoubledGuide {
public:
    Footprints(const trace::Parameters& given, const PhotonGuide& guide)
        : DoubledGuide(guide, given.count("k"), given.count("floor") / 100.0),
          neighbours_(given.count("neighbours")) {}

private:
    double fit(std::span<const Witness> witnesses) override {
        sorted_.assign(witnesses.begin(), witnesses.end());
        sort_into_bands();
        double total = 0, up_to_band = 0;
        for (const Witness& witness : sorted_) total += witness.power;
        footprints_.clear();
        for (Band& band : bands_) {
            const auto of_band =
                std::span(sorted_).subspan(footprints_.size(), band.end - footprints_.size());
            double of_power = 0, up_to = 0;
            for (const Witness& witness : of_band) of_power += witness.power;
            for (const Witness& witness : of_band) {
                up_to += witness.power;
                footprints_.push_back({to_float(witness.place), static_cast<float>(area_of(witness.place)),
                                       static_cast<float>(up_to / of_power)});
            }
            footprints_.back().up_to = 1;
            up_to_band += of_power;
            band.up_to = static_cast<float>(up_to_band / total);
        }
        bands_.back().up_to = 1;
        return 1;
    }

    /// As many bands about the normal as photons in each, and about it in a band: so both coordinates of a
    /// stratum are of directions.
    void sort_into_bands() {
        const std::size_t photons = sorted_.size();
        bands_.resize(static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(photons)))));
        std::stable_sort(sorted_.begin(), sorted_.end(),
                         [](const Witness& a, const Witness& b) { return a.place.z > b.place.z; });
        std::size_t begin = 0;
        for (std::size_t i = 0; i < bands_.size(); ++i) {
            bands_[i].end = (i + 1) * photons / bands_.size();
            std::stable_sort(
                sorted_.begin() + static_cast<std::ptrdiff_t>(begin),
                sorted_.begin() + static_cast<std::ptrdiff_t>(bands_[i].end),
                [](const Witness& a, const Witness& b) { return turn_of(a.place) < turn_of(b.place); });
            begin = bands_[i].end;
        }
    }

    /// Rises with the turn about z, from 0 up to 4.
    static double turn_of(Vec3d place) {
        const double cosine = place.x / std::max(std::hypot(place.x, place.y), 1e-300);
        return place.y >= 0 ? 1 - cosine : 3 + cosine;
    }

    /// Up to the neighbour that it is to reach, or all of the sphere where there are fewer.
    double area_of(Vec3d place) {
        if (neighbours_ >= sorted_.size()) return 1;
        distances_.clear();
        for (const Witness& other : sorted_) {
            const Vec3d off = other.place - place;
            distances_.push_back(dot(off, off));
        }
        // The photon itself comes first, at no distance.
        const auto reached = distances_.begin() + neighbours_;
        std::nth_element(distances_.begin(), reached, distances_.end());
        return std::clamp(*reached / 4, least_area, 1.0);
    }

    Vec3d draw(double u, double v, std::size_t& lobe) const override {
        const std::size_t band = part_of(bands_, u);
        const std::size_t begin = band == 0 ? 0 : bands_[band - 1].end;
        lobe = begin + part_of(std::span(footprints_).subspan(begin, bands_[band].end - begin), v);
        return about(footprints_[lobe].axis, 2 * u * footprints_[lobe].area, v);
    }

    double density(Vec3d on_sphere, std::size_t drawn) const override {
        double sum = 0, band_begin = 0;
        std::size_t i = 0;
        for (const Band& band : bands_) {
            double of_band = 0, begin = 0;
            for (; i < band.end; ++i) {
                const Footprint& one = footprints_[i];
                const Vec3d off = on_sphere - Vec3d(one.axis);
                if (i == drawn || dot(off, off) <= 4 * double{one.area})
                    of_band += (one.up_to - begin) / one.area;
                begin = one.up_to;
            }
            sum += (band.up_to - band_begin) * of_band;
            band_begin = band.up_to;
        }
        return sum / (4 * std::numbers::pi);
    }

    std::uint32_t neighbours_;
    std::vector<Witness> sorted_;
    std::vector<double> distances_;
    std::vector<Band> bands_;
    std::vector<Footprint> footprints_;
};

}  // namespace

std::span<const trace::Parameter> footprint_parameters() {
    return footprint_keys;
}

std::unique_ptr<GatherDistribution> make_footprints(const trace::Parameters& given,
                                                    const PhotonGuide& guide) {
    trace::require_range("footprints", "k", given.count("k"), 1, 1'000'000);
    trace::require_range("footprints", "neighbours", given.count("neighbours"), 1, 1'000'000);
    trace::require_range("footprints", "floor", given.count("floor"), 1, 100);
    return std::make_unique<Footprints>(given, guide);
}

}  // namespace regather::capture
