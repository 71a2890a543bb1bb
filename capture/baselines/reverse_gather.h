// capture/baselines/reverse_gather.h -- photons search the points where light is gathered, in place of points
// that search photons (Havran, Herzog & Seidel, "Fast Final Gathering via Reverse Photon Mapping", Computer
// Graphics Forum 24(3), 2005): the hit points of gather rays stand in a kd-tree, and each photon adds its
// power to the pixels of those within its radius.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "capture/gather_pass.h"
#include "trace/folder.h"

namespace regather::capture {

/// Photons, and how far each reaches.
struct ReachingPhotons {
    std::vector<trace::Photon> photons;
    std::vector<float> radius2;  ///< [scene units^2] 0: it reaches nothing.
    Searched searches;           ///< That the radii were found by, one a photon.
};

/// A photon reaches as far as the k-th nearest photon of `heap` (itself the first), and config.radius at
/// most: sample-point density estimation (Silverman, "Density Estimation", 1986, section 5.3; of reverse
/// photon mapping: Singh & Faloutsos, "SIMD Packet Techniques for Photon Mapping", RT 2007). Its mean is
/// right where photons lie evenly, at any k. In the heap's order.
ReachingPhotons reaching_photons(std::span<const trace::Photon> heap, const GatherConfig& config);

/// What a photon of squared radius `radius2` adds to a point `distance2` away that it reaches [W / (m^2 sr)]:
/// f_r x power x the filter's weight, over the area of the photon's disc; 0 where is_used() says no.
Vec3 reverse_contribution(const trace::Photon& photon, float radius2, float distance2, const GatherPoint& at,
                          const GatherConfig& config);

/// Passes over the photons, each for the hit points of some pixels.
class ReverseGather {
public:
    /// Photons in the order in which they search. `pixels` of the image: sums of `sum_bytes` each.
    ReverseGather(ReachingPhotons reaching, const GatherConfig& config, std::uint32_t pixels);

    /// `gathered`: the radiance of each query, summed over the photons in their order, and no walks.
    /// `writer`: the searches are appended as a trace of visits (docs/bringing_walks.md): a photon visits
    /// nodes of the pass's tree, and behind each point that it lights, the sum of the point's pixel. Null:
    /// they are not kept. Throws trace::UsageError when the trace would have 2^32 elements or more.
    void run(const Scene& scene, const Queries& queries, trace::TraceWriter* writer, Gathered& gathered);

    /// Writes what was searched, and says so in `info`.
    void finish(trace::TraceWriter& writer, trace::TraceInfo& info) const;

    std::uint64_t passes() const { return passes_; }
    std::uint64_t points() const { return points_; }  ///< Of all passes.
    std::uint64_t additions() const { return additions_; }

    /// A node: position 12, pixel 4, weight times reflectance in RGBE 4, direction to the viewer 2, normal
    /// and split axis 2, material 4.
    static constexpr std::uint32_t point_bytes = 28;
    static constexpr std::uint32_t sum_bytes = 12;  ///< RGB.

private:
    ReachingPhotons reaching_;
    GatherConfig config_;
    std::uint32_t pixels_;
    std::vector<std::uint32_t> parent_;  // of the elements: the sums of the pixels, then each pass's nodes
    std::uint64_t passes_ = 0, points_ = 0, additions_ = 0, searches_ = 0, visited_ = 0;
};

}  // namespace regather::capture
