// capture/view_plane.h -- eye rays of a pinhole camera: a point of the picture becomes a direction.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "scenes/scene.h"

namespace regather::capture {

class ViewPlane {
public:
    ViewPlane(const scenes::Camera& camera, std::uint32_t width, std::uint32_t height)
        : width_(static_cast<float>(width)), height_(static_cast<float>(height)) {
        using trace::cross;
        forward_ = normalize(camera.target - camera.position);
        const float half = std::tan(camera.vertical_fov_degrees * (std::numbers::pi_v<float> / 360));
        const trace::Vec3 right = normalize(cross(forward_, camera.up));
        up_ = cross(right, forward_) * half;
        right_ = right * (half * width_ / height_);
    }

    /// Unit direction through (x, y) [pixels], (0, 0) being the top left corner of the picture.
    trace::Vec3 direction(float x, float y) const {
        return normalize(forward_ + right_ * (2 * x / width_ - 1) + up_ * (1 - 2 * y / height_));
    }

private:
    float width_, height_;
    trace::Vec3 forward_, right_,
        up_;  // right_ and up_ reach from the image centre to its edges at unit distance
};

}  // namespace regather::capture
