// study/computation/computation.h -- how many floating-point operations a frame takes: Table 2 of Steinhurst,
// Practical Photon Mapping in Hardware, 2004, section 8, as a product of parameters. An eye ray meets one
// surface, so what Table 2 counts for an intersection is counted for an eye ray here.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace regather::study {

/// What is multiplied, in the order of computation_parameters().
enum class Input : std::size_t {
    pixels,
    samples,
    specular_rays,
    shadow_rays,
    gather_rays,
    ray_flops,
    intersections,
    intersection_flops,
    nodes,
    node_flops,
    gathers,
    found,
    brdf_flops,
    looked_at,
    distance_flops,
    table_flops,
    sample_flops,
    lookup_flops,
    records,
    record_flops,
};
inline constexpr std::size_t input_count = 20;

struct ComputationParameter {
    std::string_view name, what;  ///< "gather_rays"; "gather rays an eye ray"
    double paper;                 ///< Table 2's value; what the paper leaves open is 0.
    std::string_view source;      ///< Where that stands: "Table 2", "left open".
    double least, most;
};

/// The one table of parameters.
std::span<const ComputationParameter, input_count> computation_parameters();

/// A value of each parameter; Table 2's to begin with. Whole numbers up to 2^53 are exact.
struct Computation {
    std::array<double, input_count> values;

    Computation();
    double operator[](Input input) const { return values[static_cast<std::size_t>(input)]; }
    double& operator[](Input input) { return values[static_cast<std::size_t>(input)]; }
};

/// Table 2 with 102 final gather rays and 102 gathers an eye ray, as its printed sums have them.
Computation printed_computation();

/// Rays, and floating-point operations by the paper's categories.
struct Operations {
    double eye_rays, specular_rays, shadow_rays, gather_rays;
    double generation, casting, gathers, sampling, caching;
    double rays() const { return eye_rays + specular_rays + shadow_rays + gather_rays; }
    double total() const { return generation + casting + gathers + sampling + caching; }
};
Operations operations(const Computation& computation);

/// Throws trace::UsageError unless `value` is in the parameter's range; `where` opens the message.
void check_value(Input input, double value, std::string_view where);

}  // namespace regather::study
