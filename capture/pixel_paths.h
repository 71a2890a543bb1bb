// capture/pixel_paths.h -- all that one pixel asks for: eye rays, specular recursion, direct light by
// stratified shadow rays, and the points where photons are gathered (the paper, section 5.1, Figures 2 and 3,
// equations 2 and 3).
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "capture/irradiance/hemisphere_grid.h"
#include "capture/light/surface.h"
#include "capture/query_pass.h"
#include "capture/sampling/gather_distribution.h"
#include "capture/sampling/strata.h"
#include "capture/view_plane.h"
#include "spatial/list_walk.h"

namespace regather::capture {

/// The pixels of one block, one after the other; scratch memory is kept between them.
class PixelPaths {
public:
    PixelPaths(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
               const QueryConfig& config, PassParts parts, PixelWork& work);

    void run(std::uint32_t pixel);

    struct Shaded {
        Vec3 position, normal, side, to_viewer, throughput;
        const Material* material;
        std::uint32_t triangle;
        bool specular;  // the eye sees it by way of a specular surface
        std::uint32_t gather_rays = 0;
    };
    /// Where an eye ray ends on a diffuse surface that is not black.
    struct DiffusePoint {
        Shaded at;
        std::uint32_t pixel, sample, number;  // which of the pixel's eye rays; which of its points
    };
    /// Appends the pixel's, in the order in which run() shades them.
    void look(std::uint32_t pixel, std::vector<DiffusePoint>& found);
    /// A ray through each cell of the grid about the point's normal. `incoming`: what they bring without
    /// photons; `query`: for each the row of the work's queries that says what photons add, whose weight is
    /// what the ray's light is to be multiplied with; no_query where there is none.
    static constexpr std::uint32_t no_query = ~0u;
    void gather_hemisphere(const DiffusePoint& point, const HemisphereGrid& grid,
                           std::span<Incoming> incoming, std::span<std::uint32_t> query);

private:
    struct Branch {
        Vec3 origin, direction, throughput;
    };
    struct GatherRay {
        Vec3 direction, weight;
        double density;  // of all gather rays of a glossy point, per solid angle; 0 when its lights are
                         // left to the shadow rays
        std::uint32_t stratum;  // Strata::place()
    };

    void count(RayKind kind, Vec3 origin, Vec3 direction, float extent);
    void add(Stage stage, Layer layer, Vec3 radiance);
    Vec3 emitted(const Hit& hit, bool front) const;
    std::uint64_t stream_index(std::size_t shaded) const;

    Branch mirrored(const Hit& hit, const Surface& at, Vec3 incoming, Vec3 throughput) const;
    bool transmitted(const Hit& hit, const Surface& at, Vec3 incoming, Vec3 throughput, Branch& branch) const;
    Branch choose_specular(const Hit& hit, const Surface& at, Vec3 incoming, Vec3 throughput,
                           Sampler& sampler) const;
    void follow_eye(Vec3 origin, Vec3 direction, Vec3 throughput, std::uint32_t specular, bool may_split,
                    Sampler& sampler);

    void follow_eye_ray(const Strata& strata);
    bool add_recorded_light(const Shaded& at);
    std::optional<Vec3> recorded_irradiance(const Shaded& at);
    void add_direct_light(const Shaded& at, std::size_t number);
    void add_light_of(const Shaded& at, Vec3 origin, const LightPoint& point, double density);
    void ask(Queries& queries, const Shaded& at, Layer layer);
    void share_gather_rays(std::uint32_t rays);
    void add_gather_rays(const Shaded& at, std::size_t number);
    /// Returns how far the ray goes before it meets anything [scene units].
    float follow_gather(const Shaded& at, const GatherRay& ray, Sampler& sampler);
    double light_density(std::uint32_t light) const;

    const Scene& scene_;
    const RayCaster& caster_;
    const LightSampler& lights_;
    const QueryConfig& config_;
    const PassParts parts_;
    const ViewPlane plane_;
    PixelWork& work_;

    std::uint32_t pixel_ = 0, sample_ = 0;
    std::array<std::array<double, 3>, layer_names.size()> radiance_{};
    std::array<Shaded, 2> shaded_{};  // one dielectric splits an eye path
    std::size_t shaded_points_ = 0;
    std::vector<std::uint32_t> sequence_;
    const SamplingSpec sampling_;
    const std::unique_ptr<GatherDistribution> distribution_;  // looks at the point that is shaded
    View view_;
    spatial::ListWalkRecorder octree_walk_;
};

}  // namespace regather::capture
