#include "capture/baselines/reverse_gather.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>

#include "spatial/list_walk.h"
#include "spatial/listed.h"
#include "spatial/listed_columns.h"
#include "spatial/photons/nearest.h"
#include "spatial/photons/structures.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

constexpr std::size_t photons_a_chunk = 1024, chunks_at_once = 64;

/// What spatial::nearest() fills: nothing, but all within a radius are looked at.
struct WithinRadius {
    float radius2;
    void clear() {}
    float bound2() const { return radius2; }
    bool offer(float distance2, std::uint32_t) const { return distance2 <= radius2; }
};

struct Addition {
    std::uint32_t query;
    Vec3 radiance;
};

/// The points of one pass. Photon records stand for them: the search reads their positions and split axes.
struct PointTree {
    std::vector<trace::Photon> nodes;
    std::vector<std::uint32_t> query;  // of each node

    explicit PointTree(const Queries& queries) {
        std::vector<trace::Photon> points;
        std::vector<std::uint32_t> of_point, from;
        for (std::uint32_t q = 0; q < queries.size(); ++q) {
            if (!trace::is_finite(queries.position[q])) continue;  // nothing reaches it
            points.emplace_back().position = queries.position[q];
            of_point.push_back(q);
        }
        nodes = spatial::left_balanced(points, from);
        for (const std::uint32_t point : from) query.push_back(of_point[point]);
    }
};

/// Photons that one task searches for, one after the other.
struct PhotonChunk {
    std::vector<Addition> additions;
    spatial::ListWalkRecorder walks;
    std::vector<std::uint32_t> walk_bytes;
};

/// Listens to one photon's search.
struct Splat {
    const Scene& scene;
    const Queries& queries;
    const PointTree& tree;
    const GatherConfig& config;
    const trace::Photon& photon;
    float radius2;
    std::uint32_t first_node;  // element of the tree's root
    bool keeps_walks;
    PhotonChunk& chunk;

    void visit(std::uint32_t node) {
        if (keeps_walks) chunk.walks.visit(first_node + node);
    }
    void near(bool) {}
    void far(bool) {}
    void look(std::uint32_t node, bool reached) {
        if (!reached) return;
        const std::uint32_t q = tree.query[node];
        const Vec3 to_point = photon.position - queries.position[q];
        const GatherPoint at{&scene.materials[scene.triangle_material[queries.triangle[q]]],
                             queries.normal[q], -queries.direction[q]};
        const Vec3 radiance =
            reverse_contribution(photon, radius2, trace::dot(to_point, to_point), at, config);
        if (radiance == Vec3{}) return;
        chunk.additions.push_back({q, radiance});
        if (keeps_walks) chunk.walks.visit(queries.pixel[q]);
    }
};

}  // namespace

ReachingPhotons reaching_photons(std::span<const trace::Photon> heap, const GatherConfig& config) {
    ReachingPhotons reaching;
    reaching.photons.assign(heap.begin(), heap.end());
    reaching.radius2.resize(heap.size());
    std::vector<std::uint32_t> order(heap.size());
    std::iota(order.begin(), order.end(), 0u);
    const spatial::PhotonKd tree(heap);
    search_all(
        order, [&] { return spatial::NearestSet(std::min(config.k, tree.size()), config.radius); },
        [&](std::uint32_t i, spatial::NearestSet& found, spatial::WalkRecorder& recorder) {
            spatial::nearest(tree, heap[i].position, found, recorder);
            reaching.radius2[i] = found.disc_radius2();
            return found.size();
        },
        reaching.searches);
    return reaching;
}

Vec3 reverse_contribution(const trace::Photon& photon, float radius2, float distance2, const GatherPoint& at,
                          const GatherConfig& config) {
    if (!is_used(photon, at, config.surface_check)) return {};
    return brdf(*at.material, at.normal, -trace::decode_direction(photon), at.to_viewer) *
           trace::decode_power(photon.power) *
           (filter_weight(config.filter, distance2 / radius2) / (std::numbers::pi_v<float> * radius2));
}

ReverseGather::ReverseGather(ReachingPhotons reaching, const GatherConfig& config, std::uint32_t pixels)
    : reaching_(std::move(reaching)), config_(config), pixels_(pixels), parent_(pixels) {
    std::iota(parent_.begin(), parent_.end(), 0u);
}

void ReverseGather::run(const Scene& scene, const Queries& queries, trace::TraceWriter* writer,
                        Gathered& gathered) {
    const std::vector<trace::Photon>& photons = reaching_.photons;
    const PointTree tree(queries);
    if (writer && parent_.size() + tree.nodes.size() > ~0u)
        throw trace::UsageError(fmt::format(
            "reverse gathering: found {} hit points and {} pixels, expected fewer than 2^32 in all",
            points_ + queries.size(), pixels_));
    const auto first_node = static_cast<std::uint32_t>(parent_.size());
    if (writer)
        for (std::uint32_t node = 0; node < tree.nodes.size(); ++node)
            parent_.push_back(first_node + (node == 0 ? 0 : (node - 1) / 2));

    std::vector<std::array<double, 3>> sums(queries.size());
    std::vector<PhotonChunk> chunks(chunks_at_once);
    const std::size_t at_once = photons_a_chunk * chunks_at_once;
    for (std::size_t first = 0; first < photons.size(); first += at_once) {
        tbb::parallel_for(std::size_t{0}, chunks_at_once, [&](std::size_t c) {
            PhotonChunk& chunk = chunks[c];
            chunk.additions.clear();
            chunk.walks.clear();
            chunk.walk_bytes.clear();
            const std::size_t begin = std::min(photons.size(), first + c * photons_a_chunk),
                              end = std::min(photons.size(), begin + photons_a_chunk);
            for (std::size_t i = begin; i < end; ++i) {
                if (const float radius2 = reaching_.radius2[i]; radius2 > 0) {
                    WithinRadius within{radius2};
                    spatial::nearest(spatial::PhotonKd(tree.nodes), photons[i].position, within,
                                     Splat{scene, queries, tree, config_, photons[i], radius2, first_node,
                                           writer != nullptr, chunk});
                }
                chunk.walk_bytes.push_back(chunk.walks.finish());
            }
        });
        // In the photons' order, so that sums do not depend on threads.
        for (const PhotonChunk& chunk : chunks) {
            for (const Addition& addition : chunk.additions)
                for (int c = 0; c < 3; ++c)
                    sums[addition.query][static_cast<std::size_t>(c)] +=
                        static_cast<double>(addition.radiance[c]);
            additions_ += chunk.additions.size();
            visited_ += chunk.walks.visited_nodes();
            if (!writer) continue;
            writer->column("query_walk_bytes").append(std::span<const std::uint32_t>(chunk.walk_bytes));
            writer->column("walk").append(chunk.walks.bytes());
        }
    }
    if (writer) {
        std::vector<Vec3> position;
        std::vector<std::uint32_t> pixel(photons.size());
        std::iota(pixel.begin(), pixel.end(), 0u);
        for (const trace::Photon& photon : photons) position.push_back(photon.position);
        writer->column("query_position").append(std::span<const Vec3>(position));
        writer->column("query_pixel").append(std::span<const std::uint32_t>(pixel));
        searches_ += photons.size();
    }
    ++passes_;
    points_ += queries.size();

    gathered = {};
    gathered.walk_bytes.assign(queries.size(), 0);
    for (const std::array<double, 3>& sum : sums)
        gathered.radiance.push_back(
            {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])});
}

void ReverseGather::finish(trace::TraceWriter& writer, trace::TraceInfo& info) const {
    spatial::Listed::Elements elements;
    const auto nodes = static_cast<std::uint32_t>(parent_.size() - pixels_);
    elements.ranges.push_back({trace::Region::other, 0, pixels_});
    if (nodes > 0) elements.ranges.push_back({trace::Region::nodes, pixels_, nodes});
    elements.parent = parent_;
    elements.bytes.assign(pixels_, sum_bytes);
    elements.bytes.resize(parent_.size(), point_bytes);
    elements.node_bytes = point_bytes;
    const spatial::StructureSpec spec = spatial::parse_structure(spatial::brought_structure);
    spatial::store_elements(writer, spatial::Listed(spec.text, std::move(elements)));
    info.structure = spec.text;
    info.structure_version = spec.entry->version;
    info.image_width = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(reaching_.photons.size()));
    info.image_height = 1;
    info.queries = searches_;
    info.visited_nodes = visited_;
    info.left_out.push_back({"photon", "hit points of gather rays are searched"});
}

}  // namespace regather::capture
