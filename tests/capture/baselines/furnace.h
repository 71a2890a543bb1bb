// tests/capture/baselines/furnace.h -- photons of 1 W in all at random on 1 m^2, all of which is white: every
// point has irradiance 1 and sends 1 / pi.
#pragma once
#include <cstdint>
#include <vector>

#include "capture/query_pass.h"
#include "capture/sampler.h"
#include "spatial/photons/left_balanced.h"
#include "trace/photon.h"

namespace regather::capture {

struct Furnace {
    double power = 0;  ///< Of all photons as they are stored [W].
    std::vector<trace::Photon> heap;
    scenes::Scene white;
    Queries queries;  ///< A tenth of the edge away from it and farther.
};

inline Furnace even_furnace(std::uint64_t seed, std::uint32_t count, int points) {
    Furnace out;
    std::vector<trace::Photon> photons(count);
    Sampler sampler(seed, Stream::photon, 2);
    for (trace::Photon& photon : photons) {
        const float x = sampler.uniform(), y = sampler.uniform();
        photon.position = {x, y, 0};
        trace::encode_power(trace::Vec3{1, 1, 1} * (1.0f / static_cast<float>(count)), photon.power);
        trace::encode_direction({0, 0, -1}, photon);
        trace::encode_normal({0, 0, 1}, photon);
    }
    out.power = static_cast<double>(trace::decode_power(photons[0].power).x) * count;
    out.heap = spatial::left_balanced(photons);
    out.white.materials = {{.name = "white", .diffuse = {1, 1, 1}}};
    out.white.triangle_material = {0};
    for (int i = 0; i < points; ++i) {
        const float x = sampler.uniform(), y = sampler.uniform();
        out.queries.position.push_back({0.1f + 0.8f * x, 0.1f + 0.8f * y, 0});
        out.queries.normal.push_back({0, 0, 1});
        out.queries.direction.push_back({0, 0, -1});
        out.queries.triangle.push_back(0);
        out.queries.pixel.push_back(0);
    }
    return out;
}

}  // namespace regather::capture
