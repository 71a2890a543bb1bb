#include "capture/irradiance/irradiance_estimate.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace regather::capture {

IrradianceEstimate estimate_irradiance(const HemisphereGrid& grid, const Frame& frame,
                                       std::span<const Incoming> incoming) {
    const std::uint32_t rows = grid.rows(), columns = grid.columns();
    IrradianceEstimate found;
    found.nearest = std::numeric_limits<double>::infinity();
    std::array<Vec3d, 3> rotation{}, translation{};  // in the frame
    double inverse_distances = 0;
    const auto add = [](std::array<Vec3d, 3>& sums, Vec3d light, Vec3d per_light) {
        for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)] += per_light * light[c];
    };
    for (std::uint32_t j = 0; j < rows; ++j) {
        const HemisphereGrid::Row& row = grid.row()[j];
        for (std::uint32_t k = 0; k < columns; ++k) {
            const HemisphereGrid::Column& column = grid.column()[k];
            const Incoming& here = incoming[std::size_t{j} * columns + k];
            const Vec3d light = radiance_of(here);
            const double distance = distance_of(here);
            found.irradiance += light;
            found.nearest = std::min(found.nearest, distance);
            inverse_distances += 1 / distance;
            // n x d, integrated over the cell: turning the normal by w adds w . (n x d) to each cosine.
            add(rotation, light, column.around * row.turning);
            // A border at distance r shifts by -(move . theta) / r along theta, and by -(move . phi) / (r
            // sin(theta)) along phi; what it sweeps over goes from one cell's light to the other's.
            const auto across = [&](const Incoming& there, Vec3d swept) {
                const double nearer = std::min(distance, distance_of(there));
                add(translation, light - radiance_of(there), swept * (1 / nearer));
            };
            if (j > 0) across(incoming[std::size_t{j - 1} * columns + k], column.outward * row.upper_edge);
            across(incoming[std::size_t{j} * columns + (k + columns - 1) % columns],
                   column.at_begin * row.width);
        }
    }
    const double cells = grid.cells();
    found.irradiance = found.irradiance * (std::numbers::pi / cells);
    found.harmonic_distance = cells / inverse_distances;
    const Vec3d tangent = frame.tangent, bitangent = frame.bitangent;
    const auto to_world = [&](Vec3d local) { return tangent * local.x + bitangent * local.y; };
    std::transform(rotation.begin(), rotation.end(), found.rotation.begin(), to_world);
    std::transform(translation.begin(), translation.end(), found.translation.begin(), to_world);
    return found;
}

}  // namespace regather::capture
