// capture/query_pass.h -- from pixels to photon gathers: eye rays, specular recursion, direct light by
// stratified shadow rays, and final gather rays whose ends become kNN queries (the paper, section 5.1, Figure
// 3 and equation 3).
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "capture/irradiance/irradiance_octree.h"
#include "capture/light/lights.h"
#include "capture/nonfinite.h"
#include "capture/ray_caster.h"
#include "capture/sampling/gather_distribution.h"
#include "spatial/list_walk.h"

namespace regather::capture {

/// What a non-specular surface that an eye path meets shows of the light that reaches it by way of other
/// surfaces.
enum class Visualisation : std::uint8_t {
    final_gather,  ///< Equation 3: gather rays, and photon gathers where they end.
    direct,        ///< Equation 2: one photon gather at the surface itself.
};
inline constexpr std::array<const char*, 2> visualisation_names{"final-gather", "direct"};

struct QueryConfig {
    std::uint32_t width = 512, height = 512;  ///< [pixels]
    std::uint32_t gather_rays = 100;          ///< N a pixel, shared among its eye rays; the paper, Table 1.
    std::uint32_t shadow_rays =
        16;  ///< Per shaded point and light, of up to four lights; the paper, Table 2.
    std::uint32_t max_specular = 16;  ///< Specular surfaces in a row, then the path ends.
    std::uint32_t samples =
        1;                ///< Eye rays a pixel, stratified over it; a single one goes through its centre ...
    bool jitter = false;  ///< ... or anywhere in the pixel.
    Visualisation visualisation = Visualisation::final_gather;
    std::string sampling{default_sampling};  ///< Of gather rays: a spec of sampling/gather_distribution.h.
    std::string irradiance_cache{};          ///< A spec of irradiance/irradiance_metric.h; empty: none.
    std::uint64_t seed = 1;
};

/// What a part of a pixel's light is (capture.h, Layers).
enum class Layer : std::uint8_t { direct, caustic, indirect, specular };
inline constexpr std::array<const char*, 4> layer_names{"direct", "caustic", "indirect", "specular"};

/// Columns in capture order.
struct Queries {
    std::vector<Vec3> position, direction, weight;
    std::vector<std::uint32_t> pixel, triangle;
    std::vector<std::uint32_t>
        stratum;  ///< Strata::place() that the gather ray was drawn from; empty where no gather ray asks.
    std::vector<Vec3>
        normal;  ///< Shading normal on the side that the ray met; not stored in traces, as are the next two.
    std::vector<std::uint32_t> sample;  ///< Eye ray of the pixel.
    std::vector<Layer> layer;
    std::size_t size() const { return position.size(); }
    void append(const Queries& other);
    void clear();
};

enum class RayKind : std::uint8_t { eye, specular, shadow, gather };
inline constexpr std::array<const char*, 4> ray_kind_names{"eye", "specular", "shadow", "gather"};

struct Rays {
    std::vector<Vec3> origin, direction;
    std::vector<float> extent;  ///< [scene units], infinite unless the ray is a shadow ray
    std::vector<std::uint32_t> pixel;
    std::size_t size() const { return origin.size(); }
    void append(const Rays& other);
    void clear();
};

using LayeredRadiance = std::array<Vec3, layer_names.size()>;  ///< [W / (m^2 sr)] by Layer.

/// What diffuse points asked of records of irradiance.
struct IrradianceUse {
    std::uint64_t served = 0, not_served = 0;  ///< Points.
    std::uint64_t rays_saved = 0;              ///< Gather rays that points that were served did without.
    IrradianceUse& operator+=(const IrradianceUse& other) {
        served += other.served;
        not_served += other.not_served;
        rays_saved += other.rays_saved;
        return *this;
    }
    friend bool operator==(const IrradianceUse&, const IrradianceUse&) = default;
};

/// Searches of an octree of irradiance records, and the list walks that they took, in capture order.
struct OctreeSearches {
    std::vector<Vec3> position;
    std::vector<std::uint32_t> pixel, walk_bytes;
    std::vector<std::uint8_t> walks;
    std::uint64_t visited = 0;  ///< Elements.
    std::size_t size() const { return position.size(); }
    /// Ends the walk, and leaves it empty.
    void add(Vec3 at, std::uint32_t of_pixel, spatial::ListWalkRecorder& walk);
    void append(const OctreeSearches& other);
};

/// What a run of pixels asks for, and what it has gathered without photons.
struct PixelWork {
    Queries queries;  ///< Of the global map.
    Queries
        caustic_queries;  ///< Of the caustic map, one at each shaded point; empty unless they are asked for.
    Queries guide_queries;  ///< Of the global map, where a strategy asks it, one at each shaded point; empty
                            ///< unless they are kept.
    std::array<Rays, 4> rays;  ///< By RayKind; empty unless they are kept.
    std::array<std::uint64_t, 4> ray_counts{};
    std::vector<LayeredRadiance>
        radiance;         ///< Emission and direct light of each eye ray: pixel by pixel, sample by sample.
    Nonfinite nonfinite;  ///< Contributions and queries that were left out.
    IrradianceUse irradiance;
    OctreeSearches octree_searches;  ///< Empty unless they are kept.
    void append(const PixelWork& other);
    void clear();
};

/// What is kept and asked for besides the global map's queries.
struct PassParts {
    bool rays = false;      ///< Keep the rays.
    bool caustics = false;  ///< There is a caustic map: ask it, and let gather rays not look for lights by
                            ///< way of specular surfaces.
    PhotonGuide guide{};    ///< What strategies of sampling ask that want photons.
    bool guide_queries = false;  ///< Keep what they ask.
    /// Diffuse points that records serve, by errors below the octree's tolerance, have their gathered light
    /// from them. Null: none.
    const IrradianceOctree* irradiance = nullptr;
    bool octree_searches = false;  ///< Keep the searches of it.
};

class QueryPass {
public:
    /// Scene, caster and lights outlive the pass.
    QueryPass(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
              const QueryConfig& config, PassParts parts);

    /// Pixels [first, first + count) in row order, in parallel; the same on any number of threads.
    void run(std::uint64_t first, std::uint64_t count, PixelWork& work) const;

private:
    const Scene& scene_;
    const RayCaster& caster_;
    const LightSampler& lights_;
    QueryConfig config_;
    PassParts parts_;
};

}  // namespace regather::capture
