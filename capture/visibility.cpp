#include "capture/visibility.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <numbers>
#include <optional>

#include "scenes/camera_path.h"
#include "scenes/tessellation.h"

namespace regather::capture {

std::vector<std::uint8_t> triangles_seen(const Scene& scene, const RayCaster& caster,
                                         const scenes::Camera& camera) {
    const Vec3 forward = trace::normalize(camera.target - camera.position);
    const Vec3 right = trace::normalize(cross(forward, camera.up)), up = cross(right, forward);
    const double half = std::tan(static_cast<double>(camera.vertical_fov_degrees) * std::numbers::pi / 360);
    std::vector<std::atomic<std::uint8_t>> seen(scene.triangles.size());
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, visibility_grid), [&](const auto& rows) {
        for (std::uint32_t y = rows.begin(); y != rows.end(); ++y)
            for (std::uint32_t x = 0; x < visibility_grid; ++x) {
                const double u = half * (2 * (x + 0.5) / visibility_grid - 1);
                const double v = half * (1 - 2 * (y + 0.5) / visibility_grid);
                const Vec3 direction =
                    trace::normalize(forward + right * static_cast<float>(u) + up * static_cast<float>(v));
                if (const std::optional<Hit> hit = caster.closest(camera.position, direction))
                    seen[hit->triangle].store(1, std::memory_order_relaxed);
            }
    });
    return {seen.begin(), seen.end()};
}

double share_seen(const Scene& scene, const RayCaster& caster, std::span<const scenes::Camera> cameras) {
    std::vector<std::uint8_t> seen(scene.triangles.size());
    for (const scenes::Camera& camera : cameras) {
        const std::vector<std::uint8_t> one = triangles_seen(scene, caster, camera);
        for (std::size_t t = 0; t < seen.size(); ++t) seen[t] |= one[t];
    }
    double all = 0, part = 0;
    for (std::size_t t = 0; t < seen.size(); ++t) {
        const auto [a, b, c] = scene.triangles[t];
        const double area = scenes::triangle_area(scene.vertices[a], scene.vertices[b], scene.vertices[c]);
        all += area;
        if (seen[t] != 0) part += area;
    }
    return all > 0 ? part / all : 0;
}

double share_seen(const Scene& scene) {
    return share_seen(scene, RayCaster(scene), {&scene.camera, 1});
}

double share_seen_over_path(const Scene& scene) {
    std::vector<scenes::Camera> cameras;
    for (std::uint32_t frame = 0; frame < scene.frames; ++frame)
        cameras.push_back(scenes::camera_at(scene, frame));
    return share_seen(scene, RayCaster(scene), cameras);
}

}  // namespace regather::capture
