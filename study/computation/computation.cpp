#include "study/computation/computation.h"

#include <fmt/format.h>

#include "trace/error.h"

namespace regather::study {
namespace {

constexpr double most_rays = 1e6, most_flops = 1e9, most_visits = 1e9;
constexpr std::string_view table_2 = "Table 2", left_open = "left open";

constexpr std::array<ComputationParameter, input_count> parameters{{
    {"pixels", "pixels", 1024 * 768, table_2, 1, 4294967296.0},
    {"samples", "eye rays a pixel", 2, table_2, 1e-3, most_rays},
    {"specular_rays", "specular rays an eye ray", 0, left_open, 0, most_rays},
    {"shadow_rays", "shadow rays an eye ray", 16, table_2, 0, most_rays},
    {"gather_rays", "gather rays an eye ray", 100, table_2, 0, most_rays},
    {"ray_flops", "FLOP to make a ray", 18, table_2, 0, most_flops},
    {"intersections", "triangles tested a ray", 20, table_2, 0, most_visits},
    {"intersection_flops", "FLOP to test a triangle", 30, table_2, 0, most_flops},
    {"nodes", "inner nodes visited a ray", 20, "section 8: as many as triangles", 0, most_visits},
    {"node_flops", "FLOP to visit a node", 0, "section 8: comparisons", 0, most_flops},
    {"gathers", "gathers an eye ray", 101, table_2, 0, most_rays},
    {"found", "photons found a gather", 100, table_2, 0, most_visits},
    {"brdf_flops", "FLOP to evaluate a BRDF", 20, table_2, 0, most_flops},
    {"looked_at", "photons looked at a gather", 100, "no less than found", 0, most_visits},
    {"distance_flops", "FLOP of a photon's distance", 0, "named, not in Table 2", 0, most_flops},
    {"table_flops", "FLOP of an eye ray's p.d.f.", 0, left_open, 0, most_flops},
    {"sample_flops", "FLOP to sample a gather ray", 0, left_open, 0, most_flops},
    {"lookup_flops", "FLOP to search the cache", 0, left_open, 0, most_flops},
    {"records", "cache records an eye ray", 0, left_open, 0, most_rays},
    {"record_flops", "FLOP to insert a record", 0, left_open, 0, most_flops},
}};

}  // namespace

std::span<const ComputationParameter, input_count> computation_parameters() {
    return parameters;
}

Computation::Computation() : values{} {
    for (std::size_t i = 0; i < input_count; ++i) values[i] = parameters[i].paper;
}

Computation printed_computation() {
    Computation printed;
    printed[Input::gather_rays] = printed[Input::gathers] = 102;
    return printed;
}

Operations operations(const Computation& of) {
    Operations out{};
    out.eye_rays = of[Input::pixels] * of[Input::samples];
    out.specular_rays = out.eye_rays * of[Input::specular_rays];
    out.shadow_rays = out.eye_rays * of[Input::shadow_rays];
    out.gather_rays = out.eye_rays * of[Input::gather_rays];
    out.generation = out.rays() * of[Input::ray_flops];
    out.casting = out.rays() * (of[Input::intersections] * of[Input::intersection_flops] +
                                of[Input::nodes] * of[Input::node_flops]);
    out.gathers =
        out.eye_rays * of[Input::gathers] *
        (of[Input::found] * of[Input::brdf_flops] + of[Input::looked_at] * of[Input::distance_flops]);
    out.sampling = out.eye_rays * of[Input::table_flops] + out.gather_rays * of[Input::sample_flops];
    out.caching = out.eye_rays * (of[Input::lookup_flops] + of[Input::records] * of[Input::record_flops]);
    return out;
}

void check_value(Input input, double value, std::string_view where) {
    const ComputationParameter& parameter = parameters[static_cast<std::size_t>(input)];
    if (value >= parameter.least && value <= parameter.most) return;
    throw trace::UsageError(fmt::format("{}: {} is {}, expected a number from {} to {}", where,
                                        parameter.name, value, parameter.least, parameter.most));
}

}  // namespace regather::study
