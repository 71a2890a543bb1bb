#include "capture/irradiance/open_surfaces.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "capture/ray_caster.h"
#include "capture/view_plane.h"

namespace regather::capture {
namespace {

constexpr std::uint32_t rays_across = 64;    // rays along each edge of the picture
constexpr float least_cosine = 0.96592583f;  // 15 degrees
constexpr float most_off_plane = 0.2f;       // of the distance between both points

}  // namespace

OpenSurfaces open_surfaces(const scenes::Scene& scene) {
    const RayCaster caster(scene);
    const ViewPlane plane(scene.camera, rays_across, rays_across);
    OpenSurfaces found;
    std::vector<std::optional<Hit>> seen(std::size_t{rays_across} * rays_across);  // where it is diffuse
    for (std::uint32_t row = 0; row < rays_across; ++row)
        for (std::uint32_t column = 0; column < rays_across; ++column) {
            const auto hit = caster.closest(
                scene.camera.position,
                plane.direction(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f));
            if (!hit) continue;
            ++found.met;
            if (scene.materials[scene.triangle_material[hit->triangle]].kind != scenes::MaterialKind::diffuse)
                continue;
            ++found.diffuse;
            seen[std::size_t{row} * rays_across + column] = *hit;
        }
    const auto goes_on = [&](const Hit& at, std::uint32_t column, std::uint32_t row) {
        if (column == rays_across || row == rays_across) return true;
        const std::optional<Hit>& next = seen[std::size_t{row} * rays_across + column];
        if (!next) return false;
        const trace::Vec3 step = next->position - at.position;
        return std::fabs(dot(at.geometric_normal, next->geometric_normal)) >= least_cosine &&
               std::fabs(dot(step, at.geometric_normal)) <= most_off_plane * trace::length(step);
    };
    for (std::uint32_t row = 0; row < rays_across; ++row)
        for (std::uint32_t column = 0; column < rays_across; ++column)
            if (const std::optional<Hit>& at = seen[std::size_t{row} * rays_across + column])
                found.open += goes_on(*at, column + 1, row) && goes_on(*at, column, row + 1);
    return found;
}

std::string OpenSurfaces::text() const {
    const auto share = [&](std::uint32_t rays) { return met > 0 ? 100.0 * rays / met : 0.0; };
    return fmt::format(
        "{:.0f} % of what the camera sees is diffuse, {:.0f} % in surfaces that go on to the next of "
        "{} x {} rays: {}.",
        share(diffuse), share(open), rays_across, rays_across,
        suited() ? "records of irradiance serve many points" : "a record would serve few points");
}

}  // namespace regather::capture
