#include "capture/sampling/incident.h"

#include <algorithm>
#include <vector>

#include "capture/sampling/table_guide.h"
#include "trace/range.h"

namespace regather::capture {
namespace {

constexpr trace::Parameter incident_keys[] = {
    {"rows", "4", "of the table, by the angle to the normal"},
    {"columns", "16", "of the table, about the normal; an even number"},
    {"k", "400", "photons that are asked"},
    {"floor", "10",
     "[%] of the density that looks at no photon: light from where no photon came is found, too"},
    {"smooth", "1", "1: half of each cell goes to its neighbours"},
    {"shrink", "1", "1: shares go towards equal ones as far as so few photons may differ by chance"},
};

class Incident final : public TableGuide {
public:
    Incident(const trace::Parameters& given, const PhotonGuide& guide, bool times_brdf)
        : TableGuide(given.count("rows"), given.count("columns"), given.count("floor") / 100.0, times_brdf),
          guide_(guide),
          smooth_(given.count("smooth") != 0),
          shrink_(given.count("shrink") != 0),
          found_(std::min(given.count("k"), guide.photons.size()), std::numeric_limits<float>::infinity()) {}

private:
    void fill(const ShadedPoint& point, std::span<float> shares) override {
        double squares = 0;
        guide_.for_each_witness(point.surface, point.position, found_, [&](Vec3 from, Vec3 colour) {
            const float power = brightness(colour);
            shares[table().cell_of(frame().to_local(from))] += power;
            squares += static_cast<double>(power) * static_cast<double>(power);
        });
        if (smooth_) {
            smooth(shares);
            squares *= kept_by_smoothing();
        }
        if (shrink_) shrink(shares, squares);
    }

    /// Towards equal shares by as much of their unevenness as the photons' number explains (the positive part
    /// of James & Stein's estimate): `noise` is what the sum of the squared differences from the mean would
    /// be of photons that came from everywhere alike.
    static void shrink(std::span<float> shares, double noise) {
        double total = 0, unevenness = 0;
        for (const float share : shares) total += share;
        const double mean = total / static_cast<double>(shares.size());
        for (const float share : shares) unevenness += (share - mean) * (share - mean);
        if (!(unevenness > 0)) return;
        const double kept = std::max(0.0, 1 - noise / unevenness);
        for (float& share : shares) share = static_cast<float>(mean + kept * (share - mean));
    }

    /// What smooth() leaves of the sum of squares of independent cells: 1/2 and four times 1/8, squared;
    /// where two of the parts fall into one cell, their sum.
    double kept_by_smoothing() const {
        const double rows = table().rows(), across = table().columns() == 2 ? 1.0 / 16 : 2.0 / 64;
        const double inner = 1.0 / 4 + 2.0 / 64 + across, edge = 25.0 / 64 + 1.0 / 64 + across;
        return rows == 1 ? 36.0 / 64 + across : (2 * edge + (rows - 2) * inner) / rows;
    }

    /// Half of each cell to its neighbours; a row has none beyond the pole or the horizon, and keeps that
    /// part.
    void smooth(std::span<float> shares) {
        const std::uint32_t rows = table().rows(), columns = table().columns();
        smoothed_.assign(shares.size(), 0.0f);
        for (std::uint32_t row = 0; row < rows; ++row)
            for (std::uint32_t column = 0; column < columns; ++column) {
                const auto cell = [&](std::uint32_t r, std::uint32_t c) {
                    return std::size_t{r} * columns + c;
                };
                const float eighth = shares[cell(row, column)] / 8;
                smoothed_[cell(row, column)] += 4 * eighth;
                smoothed_[cell(row, (column + 1) % columns)] += eighth;
                smoothed_[cell(row, (column + columns - 1) % columns)] += eighth;
                smoothed_[cell(row > 0 ? row - 1 : row, column)] += eighth;
                smoothed_[cell(row + 1 < rows ? row + 1 : row, column)] += eighth;
            }
        std::copy(smoothed_.begin(), smoothed_.end(), shares.begin());
    }

    const PhotonGuide& guide_;
    bool smooth_, shrink_;
    std::vector<float> smoothed_;
    spatial::NearestSet found_;
};

void check(const trace::Parameters& given) {
    trace::require_range("incident", "k", given.count("k"), 1, 1'000'000);
    trace::require_range("incident", "floor", given.count("floor"), 1, 100);
    trace::require_range("incident", "smooth", given.count("smooth"), 0, 1);
    trace::require_range("incident", "shrink", given.count("shrink"), 0, 1);
}

}  // namespace

std::span<const trace::Parameter> incident_parameters() {
    return incident_keys;
}

std::unique_ptr<GatherDistribution> make_incident(const trace::Parameters& given, const PhotonGuide& guide) {
    check(given);
    return std::make_unique<Incident>(given, guide, false);
}

std::unique_ptr<GatherDistribution> make_combined(const trace::Parameters& given, const PhotonGuide& guide) {
    check(given);
    return std::make_unique<Incident>(given, guide, true);
}

}  // namespace regather::capture
