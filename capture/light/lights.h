// capture/light/lights.h -- light leaving the area lights of a scene, and points on them as a surface sees
// them. Emission: lights in proportion to their power, points evenly over their area, directions with density
// cos / pi. Direct light: one light in proportion to an estimate from above of what it can send to the point,
// power / distance^2 with bounds of both cosines (after Conty Estevez & Kulla, "Importance Sampling of Many
// Lights with Adaptive Tree Splitting", HPG 2018, with two levels in place of a tree), then a point evenly
// over its area. Up to 64 lights: a look costs one estimate a light, a sample a binary search. More lights
// are put into about sqrt(lights) groups of neighbours: a look costs one estimate a group, a sample or a
// density one estimate for each light of one group (10,000 lights: 128 and at most 79; a few microseconds).
// Lengths in scene units, radiance [W / (m^2 sr)], power [W], densities [1 / m^2].
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/sampler.h"
#include "scenes/scene.h"
#include "trace/vec.h"

namespace regather::capture {

using scenes::Scene;
using trace::Vec3;

/// A point on a light.
struct LightPoint {
    Vec3 position, normal;  ///< Unit normal on the outside, where the light emits.
    Vec3 radiance;
    double pdf = 0;  ///< Per area; the chance of the light's choice included where there was one.
    std::uint32_t light = 0;
};

/// A photon as it leaves a light.
struct Emission {
    Vec3 position, normal, direction;
    Vec3 power;  ///< As if it were the only one: its expectation is the total power.
    std::uint32_t light = 0;
};

/// The lights as one point sees them; filled by LightSampler::look, to be used again and again.
class View {
public:
    bool dark() const { return !(total_ > 0); }  ///< No light can reach the point.

private:
    friend class LightSampler;
    trace::Vec3d position_, side_;
    std::vector<double> cumulative_;  // over the groups
    double total_ = 0;
};

class LightSampler {
public:
    /// The scene outlives the sampler. Any number of threads may call, each with a View of its own.
    explicit LightSampler(const Scene& scene);

    std::size_t size() const { return lights_.size(); }
    Vec3 total_power() const { return total_power_; }
    bool dark() const { return group_first_.size() < 2; }  ///< No light with power.

    /// Not for a dark scene.
    Emission emit(Sampler& sampler) const;

    /// Density over the area of one light; 0 for a light without area.
    double density(std::uint32_t light) const { return lights_[light].density; }
    /// The point of one light for (u, v) in [0, 1)^2, with its density(): stratified pairs give stratified
    /// points.
    LightPoint sample_light(std::uint32_t light, double u, double v) const;

    /// `side`: unit normal of the surface on the side that is lit; zero for a point that light reaches from
    /// all sides.
    void look(Vec3 position, Vec3 side, View& view) const;
    /// The chance that sample() takes this light. 0 only when it has no power, or certainly cannot light the
    /// point: it is wholly below the horizon, or flat and the point is behind it.
    double share(const View& view, std::uint32_t light) const;
    /// A light by `choice` and its point for (u, v), all in [0, 1). False: no light, which counts as black.
    bool sample(const View& view, double choice, double u, double v, LightPoint& point) const;
    /// The density with which sample() finds a given point of the light, wherever it is.
    double pdf_area(const View& view, std::uint32_t light) const {
        return share(view, light) * density(light);
    }

private:
    /// What an estimate looks at: of a light, or of a group of them.
    struct Bound {
        trace::Vec3d low, high;     // box
        trace::Vec3d plane_normal;  // of a flat light
        double plane_offset = 0, plane_slack = 0;
        double radius = 0, power = 0;
        bool flat = false;
    };
    struct Light {
        Bound bound;
        double density = 0;
        std::size_t first_area = 0;  // of a mesh: its cumulative areas in areas_
        std::uint32_t group = 0;
    };
    static double estimate(const Bound& bound, const View& view);
    std::span<const std::uint32_t> members(std::size_t group) const;
    void measure(std::uint32_t light);
    void divide(std::size_t first, std::size_t last, std::size_t most);

    const Scene& scene_;
    std::vector<Light> lights_;
    std::vector<double> areas_;
    std::vector<std::uint32_t> order_;      // lights with power, group by group
    std::vector<std::size_t> group_first_;  // into order_, with an end
    std::vector<Bound> groups_;
    std::vector<double> cumulative_power_;  // over order_
    Vec3 total_power_;
};

}  // namespace regather::capture
