#include "scenes/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trace/error.h"

namespace regather::scenes {

namespace {

// Slope at key i, a frame [m].
std::array<double, 3> tangent(const std::vector<KeyFrame>& keys, std::size_t i, Vec3 KeyFrame::*point) {
    const KeyFrame& before = keys[i == 0 ? 0 : i - 1];
    const KeyFrame& after = keys[std::min(i + 1, keys.size() - 1)];
    const double frames = after.frame - before.frame;
    std::array<double, 3> slope{};
    for (int axis = 0; axis < 3; ++axis)
        slope[static_cast<std::size_t>(axis)] =
            (static_cast<double>((after.*point)[axis]) - (before.*point)[axis]) / frames;
    return slope;
}

// Between the keys i and i + 1, t from 0 to 1.
Vec3 hermite(const std::vector<KeyFrame>& keys, std::size_t i, double t, Vec3 KeyFrame::*point) {
    const double frames = keys[i + 1].frame - keys[i].frame, t2 = t * t, t3 = t2 * t;
    const auto m0 = tangent(keys, i, point), m1 = tangent(keys, i + 1, point);
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        p[axis] = static_cast<float>(
            (2 * t3 - 3 * t2 + 1) * (keys[i].*point)[axis] + (t3 - 2 * t2 + t) * frames * m0[k] +
            (3 * t2 - 2 * t3) * (keys[i + 1].*point)[axis] + (t3 - t2) * frames * m1[k]);
    }
    return p;
}

// At an even rate on the great circle from a to b (Shoemake 1985); along a where they are opposite.
Vec3 turned(Vec3 a, Vec3 b, double t) {
    a = trace::normalize(a);
    b = trace::normalize(b);
    const double cosine = std::clamp(static_cast<double>(dot(a, b)), -1.0, 1.0), angle = std::acos(cosine);
    const double sine = std::sin(angle);
    if (sine < 1e-6) return t < 1 || cosine > 0 ? a : b;
    return trace::normalize(a * static_cast<float>(std::sin((1 - t) * angle) / sine) +
                            b * static_cast<float>(std::sin(t * angle) / sine));
}

}  // namespace

Camera camera_at(const Scene& scene, std::uint32_t frame) {
    const std::vector<KeyFrame>& keys = scene.camera_path;
    if (keys.size() < 2)
        throw trace::UsageError(
            fmt::format("frame: found {}, and the scene {} has no camera path", frame, scene.name));
    if (frame >= scene.frames)
        throw trace::UsageError(fmt::format("frame: found {}, expected 0 to {} in the scene {}", frame,
                                            scene.frames - 1, scene.name));
    std::size_t i = 0;
    while (i + 2 < keys.size() && keys[i + 1].frame <= frame) ++i;
    const double t = static_cast<double>(frame - keys[i].frame) / (keys[i + 1].frame - keys[i].frame);
    Camera camera = scene.camera;
    camera.position = hermite(keys, i, t, &KeyFrame::position);
    camera.target = hermite(keys, i, t, &KeyFrame::target);
    camera.up = turned(keys[i].up, keys[i + 1].up, t);
    return camera;
}

}  // namespace regather::scenes
