#include "capture/sampling/incident.h"

#include <algorithm>
#include <vector>

#include "capture/sampling/hemisphere_table.h"
#include "trace/range.h"

namespace regather::capture {
namespace {

constexpr trace::Parameter parameters[] = {
    {"rows", "4", "of the table, by the angle to the normal"},
    {"columns", "16", "of the table, about the normal; an even number"},
    {"k", "100", "photons that are asked"},
    {"floor", "25",
     "[%] of the density that looks at no photon: light from where no photon came is found, too"},
    {"smooth", "1", "1: half of each cell goes to its neighbours"},
    {"shrink", "1", "1: shares go towards equal ones as far as so few photons may differ by chance"},
};

float brightness(Vec3 power) {
    return power.x + power.y + power.z;
}

class Incident final : public GatherDistribution {
public:
    Incident(const trace::Parameters& given, const PhotonGuide& guide, bool times_brdf)
        : guide_(guide),
          times_brdf_(times_brdf),
          smooth_(given.count("smooth") != 0),
          shrink_(given.count("shrink") != 0),
          floor_(given.count("floor") / 100.0),
          table_(given.count("rows"), given.count("columns")),
          shares_(std::size_t{table_.rows()} * table_.columns()),
          found_(std::min(given.count("k"), guide.photons.size()), std::numeric_limits<float>::infinity()) {}

    void look(const ShadedPoint& point) override {
        frame_ = Frame(point.surface.normal);
        std::fill(shares_.begin(), shares_.end(), 0.0f);
        double squares = 0;
        spatial::nearest(guide_.photons, point.position, found_);
        for (std::size_t i = 0; i < found_.size(); ++i) {
            const std::uint32_t photon = found_[i].node;
            if (!guide_.is_witness(photon, point.surface)) continue;
            const trace::Photon& witness = guide_.photons.nodes()[photon];
            const float power = brightness(trace::decode_power(witness.power));
            shares_[table_.cell_of(local(-trace::decode_direction(witness)))] += power;
            squares += static_cast<double>(power) * static_cast<double>(power);
        }
        if (smooth_) {
            smooth();
            squares *= kept_by_smoothing;
        }
        if (shrink_) shrink(squares);
        if (times_brdf_) multiply(point.surface);
        table_.set(shares_, floor_);
    }

    bool sample(Strata::Point place, Sampler&, GatherSample& found) const override {
        const HemisphereTable::Found drawn = table_.sample(place.along_rows, place.along_columns);
        found = {frame_.to_world(drawn.direction), drawn.density, drawn.density};
        return drawn.density > 0;
    }
    double pdf(Vec3 direction) const override { return table_.pdf(local(direction)); }

private:
    Vec3 local(Vec3 world) const {
        return {dot(frame_.tangent, world), dot(frame_.bitangent, world), dot(frame_.normal, world)};
    }

    /// Towards equal shares by as much of their unevenness as the photons' number explains (the positive part
    /// of James & Stein's estimate): `noise` is what the sum of the squared differences from the mean would be
    /// of photons that came from everywhere alike.
    void shrink(double noise) {
        double total = 0, unevenness = 0;
        for (const float share : shares_) total += share;
        const double mean = total / static_cast<double>(shares_.size());
        for (const float share : shares_) unevenness += (share - mean) * (share - mean);
        if (!(unevenness > 0)) return;
        const double kept = std::max(0.0, 1 - noise / unevenness);
        for (float& share : shares_) share = static_cast<float>(mean + kept * (share - mean));
    }

    /// Half of each cell to its neighbours; a row has none beyond the pole or the horizon, and keeps that
    /// part.
    void smooth() {
        const std::uint32_t rows = table_.rows(), columns = table_.columns();
        smoothed_.assign(shares_.size(), 0.0f);
        for (std::uint32_t row = 0; row < rows; ++row)
            for (std::uint32_t column = 0; column < columns; ++column) {
                const auto cell = [&](std::uint32_t r, std::uint32_t c) {
                    return std::size_t{r} * columns + c;
                };
                const float eighth = shares_[cell(row, column)] / 8;
                smoothed_[cell(row, column)] += 4 * eighth;
                smoothed_[cell(row, (column + 1) % columns)] += eighth;
                smoothed_[cell(row, (column + columns - 1) % columns)] += eighth;
                smoothed_[cell(row > 0 ? row - 1 : row, column)] += eighth;
                smoothed_[cell(row + 1 < rows ? row + 1 : row, column)] += eighth;
            }
        shares_.swap(smoothed_);
    }

    /// The floor's share is spread here, as the BRDF is, not by the table.
    void multiply(const GatherPoint& at) {
        double total = 0;
        for (const float share : shares_) total += share;
        const auto even = static_cast<float>(1.0 / static_cast<double>(shares_.size()));
        for (std::uint32_t cell = 0; cell < shares_.size(); ++cell) {
            const Vec3 towards = frame_.to_world(table_.middle_of(cell));
            const float light =
                total > 0 ? static_cast<float>((1 - floor_) * shares_[cell] / total + floor_ * even) : even;
            shares_[cell] = light * brightness(brdf(*at.material, at.normal, towards, at.to_viewer));
        }
    }

    const PhotonGuide& guide_;
    /// Of the sum of squares of independent cells: 1/2 and four times 1/8, squared.
    static constexpr double kept_by_smoothing = 0.3125;

    bool times_brdf_, smooth_, shrink_;
    double floor_;
    HemisphereTable table_;
    std::vector<float> shares_, smoothed_;
    spatial::NearestSet found_;
    Frame frame_{{0, 0, 1}};
};

void check(const trace::Parameters& given) {
    trace::require_range("incident", "k", given.count("k"), 1, 1'000'000);
    trace::require_range("incident", "floor", given.count("floor"), 1, 100);
    trace::require_range("incident", "smooth", given.count("smooth"), 0, 1);
    trace::require_range("incident", "shrink", given.count("shrink"), 0, 1);
}

}  // namespace

std::span<const trace::Parameter> incident_parameters() {
    return parameters;
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
