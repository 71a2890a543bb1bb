#include "capture/sampling/table_guide.h"

#include <algorithm>

namespace regather::capture {

void TableGuide::look(const ShadedPoint& point) {
    frame_ = Frame(point.surface.normal);
    std::fill(shares_.begin(), shares_.end(), 0.0f);
    fill(point, shares_);
    // A diffuse surface reflects alike everywhere.
    if (times_brdf_ && point.surface.material->kind == MaterialKind::glossy) multiply(point.surface);
    table_.set(shares_, floor_);
}

bool TableGuide::sample(Strata::Point place, Sampler&, GatherSample& found) const {
    const HemisphereTable::Found drawn = table_.sample(place.along_rows, place.along_columns);
    found = {frame_.to_world(drawn.direction), drawn.density, drawn.density};
    return drawn.density > 0;
}

/// The floor's share is spread here, as the BRDF is, not by the table alone.
void TableGuide::multiply(const GatherPoint& at) {
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

}  // namespace regather::capture
