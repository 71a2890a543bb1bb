#include "capture/baselines/precomputed_irradiance.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "spatial/photons/nearest_facing.h"

namespace regather::capture {

PrecomputedIrradiance precompute_irradiance(std::span<const trace::Photon> heap, std::uint32_t every,
                                            const GatherConfig& config) {
    PrecomputedIrradiance precomputed;
    std::vector<trace::Photon> records;
    Queries sites;  // a white surface seen along its normal sends E / pi
    for (std::size_t i = 0; i < heap.size(); i += every) {
        const Vec3 normal = trace::decode_normal(heap[i]);
        records.push_back(heap[i]);
        sites.position.push_back(heap[i].position);
        sites.normal.push_back(normal);
        sites.direction.push_back(-normal);
        sites.triangle.push_back(0);
    }
    Scene white;
    white.materials = {{.name = "white", .diffuse = {1, 1, 1}}};
    white.triangle_material = {0};
    std::vector<std::uint32_t> order(sites.size());
    std::iota(order.begin(), order.end(), 0u);
    Gathered gathered;
    gather(white, spatial::PhotonKd(heap), sites, order, config, gathered);

    for (std::size_t i = 0; i < records.size(); ++i) {
        Vec3 irradiance = gathered.radiance[i] * std::numbers::pi_v<float>;
        if (!trace::is_finite(irradiance)) {
            ++precomputed.nonfinite;
            irradiance = {};
        }
        trace::encode_power(irradiance, records[i].power);
        records[i].theta = records[i].phi = 0;
    }
    precomputed.records = spatial::left_balanced(records);
    precomputed.searches = std::move(gathered);
    return precomputed;
}

void look_up(const Scene& scene, std::span<const trace::Photon> records, const Queries& queries,
             std::span<const std::uint32_t> order, const GatherConfig& config, Gathered& gathered) {
    const spatial::PhotonKd tree(records);
    gathered.radiance.assign(queries.size(), {});
    search_all(
        order, [&] { return spatial::NearestFacing(records, config.radius); },
        [&](std::uint32_t q, spatial::NearestFacing& nearest, spatial::WalkRecorder& recorder) {
            if (config.surface_check) nearest.look_for(queries.normal[q]);
            spatial::nearest(tree, queries.position[q], nearest, recorder);
            const std::optional<spatial::Neighbor> found = nearest.found();
            if (!found) return 0u;
            const Material& material = scene.materials[scene.triangle_material[queries.triangle[q]]];
            const Vec3 reflectance = material.kind == MaterialKind::glossy
                                         ? material.diffuse + material.specular
                                         : material.diffuse;
            gathered.radiance[q] =
                trace::decode_power(records[found->node].power) * reflectance * std::numbers::inv_pi_v<float>;
            return 1u;
        },
        gathered);
}

void write_photon_searches(trace::TraceWriter& writer, std::span<const trace::Photon> heap,
                           std::uint32_t every, const Searched& searches, trace::TraceInfo& info) {
    std::vector<Vec3> position;
    for (std::size_t i = 0; i < heap.size(); i += every) position.push_back(heap[i].position);
    std::vector<std::uint32_t> row(position.size());
    std::iota(row.begin(), row.end(), 0u);
    const auto append = [&](const char* name, const auto& rows) {
        writer.column(name).append(std::span(rows));
    };
    append("photon", heap);
    append("query_position", position);
    append("query_pixel", row);
    append("query_walk_bytes", searches.walk_bytes);
    append("walk", searches.walks);
    info.image_width = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(position.size()));
    info.image_height = 1;
    info.queries = position.size();
    info.photons = heap.size();
    info.found_photons = searches.found_photons;
    info.visited_nodes = searches.visited_nodes;
    for (const char* column : {"query_direction", "query_weight", "query_leaf_kd", "query_leaf_bvh"})
        info.left_out.push_back({column, "photons ask, not rays of a pixel"});
    info.left_out.push_back({"query_stratum", "no gather rays ask these queries"});
}

}  // namespace regather::capture
