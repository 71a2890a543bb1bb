// capture/query_pass.h -- from pixels to photon gathers: eye rays, specular recursion, direct light by stratified shadow
// rays, and final gather rays whose ends become kNN queries (the paper, section 5.1, Figure 3 and equation 3).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "capture/ray_caster.h"

namespace regather::capture {

/// What a non-specular surface that an eye path meets shows of the light that reaches it by way of other surfaces.
enum class Visualisation : std::uint8_t {
    final_gather,  ///< Equation 3: gather rays, and photon gathers where they end.
    direct,        ///< Equation 2: one photon gather at the surface itself.
};

struct QueryConfig {
    std::uint32_t width = 512, height = 512;  ///< [pixels]
    std::uint32_t gather_rays = 100;          ///< N a pixel; the paper, Table 1.
    std::uint32_t shadow_rays = 16;           ///< Per light and shaded point; the paper, Table 2.
    std::uint32_t max_specular = 16;          ///< Specular surfaces in a row, then the path ends.
    std::uint32_t samples = 1;                ///< Eye rays a pixel, stratified over it; a single one goes through its centre ...
    bool jitter = false;                      ///< ... or anywhere in the pixel.
    Visualisation visualisation = Visualisation::final_gather;
    std::uint64_t seed = 1;
};

/// Columns in capture order.
struct Queries {
    std::vector<Vec3> position, direction, weight;
    std::vector<std::uint32_t> pixel, triangle;
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

/// What a run of pixels asks for, and what it has gathered without photons.
struct PixelWork {
    Queries queries;
    std::array<Rays, 4> rays;     ///< By RayKind; empty unless they are kept.
    std::array<std::uint64_t, 4> ray_counts{};
    std::vector<Vec3> radiance;   ///< [W / (m^2 sr)] a pixel: emission and direct light.
    void append(const PixelWork& other);
    void clear();
};

class QueryPass {
public:
    /// Scene and caster outlive the pass.
    QueryPass(const Scene& scene, const RayCaster& caster, const QueryConfig& config, bool keep_rays);

    /// Pixels [first, first + count) in row order, in parallel; the same on any number of threads.
    void run(std::uint64_t first, std::uint64_t count, PixelWork& work) const;

private:
    class Pixel;
    const Scene& scene_;
    const RayCaster& caster_;
    QueryConfig config_;
    bool keep_rays_;
    Vec3 forward_, right_, up_;  // right_ and up_ reach from the image centre to its edges at unit distance
};

}  // namespace regather::capture
