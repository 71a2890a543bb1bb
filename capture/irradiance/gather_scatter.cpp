#include "capture/irradiance/gather_scatter.h"

#include <map>
#include <optional>
#include <utility>

namespace regather::capture {

double gather_scatter(std::span<const SeedPoint> points, std::span<const std::uint8_t> is_origin,
                      std::uint32_t tile) {
    struct Tile {
        trace::Bounds3 box;
        std::optional<Vec3> last;
        double way = 0;
        std::uint64_t steps = 0;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Tile> tiles;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Tile& at = tiles[{points[i].row / tile, points[i].column / tile}];
        const Vec3 position = points[i].point.position;
        at.box.include(position);
        if (is_origin[i] == 0) continue;
        if (at.last) {
            at.way += trace::length(Vec3d(position) - Vec3d(*at.last));
            ++at.steps;
        }
        at.last = position;
    }
    double sum = 0, count = 0;
    for (const auto& [place, at] : tiles) {
        const double extent = trace::length(Vec3d(at.box.max) - Vec3d(at.box.min));
        if (at.steps == 0 || !(extent > 0)) continue;
        sum += at.way / static_cast<double>(at.steps) / extent;
        ++count;
    }
    return count > 0 ? sum / count : 0;
}

}  // namespace regather::capture
