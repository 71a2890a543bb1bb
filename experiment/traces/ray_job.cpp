#include "experiment/traces/ray_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "capture/capture.h"
#include "capture/ray_caster.h"
#include "scenes/camera_path.h"
#include "scenes/loader.h"
#include "spatial/rays/ray_recording.h"
#include "spatial/rays/ray_structures.h"
#include "trace/error.h"
#include "trace/folder.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;
using trace::Vec3;

void check_kind(const std::string& rays) {
    if (std::find(trace::ray_kinds.begin(), trace::ray_kinds.end(), rays) == trace::ray_kinds.end())
        throw trace::UsageError(fmt::format("--rays: found {}, expected {}", trace::in_quotes(rays),
                                            trace::alternatives(trace::ray_kinds)));
}

/// The scene that was captured, with the camera of the frame.
scenes::Scene scene_of(const trace::TraceReader& trace, const std::string& name_or_path) {
    const trace::TraceInfo& info = trace.info();
    const std::string file = trace::shown((trace.folder() / "trace.json").string(), trace::most_shown_path);
    const trace::Json* const checksum = info.parameters.find("scene_checksum");
    if (!checksum || !checksum->text())
        throw trace::DataError(fmt::format(
            "{}: parameters.scene_checksum: found {}, expected that of a capture, whose rays are cast again",
            file, checksum ? trace::shown(checksum->dump()) : "nothing"));
    scenes::Scene scene;
    try {
        scene = scenes::load_scene(name_or_path.empty() ? info.scene : name_or_path);
    } catch (const trace::UsageError& error) {
        throw trace::UsageError(fmt::format("{}; give the capture's scene file with --scene", error.what()));
    }
    if (info.frame) scene.camera = scenes::camera_at(scene, *info.frame);
    if (const std::string found = capture::checksum(scene); found != *checksum->text())
        throw trace::DataError(
            fmt::format("{}: parameters.scene_checksum: found {}, expected {} of {}; give the capture's "
                        "scene file with --scene",
                        file, trace::shown(*checksum->text()), found, trace::shown(scene.name)));
    return scene;
}

/// The columns of the rays of one kind.
struct RayColumns {
    std::span<const Vec3> origin, direction;
    std::span<const float> extent;
    std::span<const std::uint32_t> pixel;

    RayColumns(trace::TraceReader& trace, const std::string& kind)
        : origin(trace.column<Vec3>(fmt::format("ray_{}_origin", kind))),
          direction(trace.column<Vec3>(fmt::format("ray_{}_direction", kind))),
          extent(trace.column<float>(fmt::format("ray_{}_extent", kind))),
          pixel(trace.column<std::uint32_t>(fmt::format("ray_{}_pixel", kind))) {}
};

/// The largest triangles of the scene, one of sixteen and one at least: what a machine could hold on chip to
/// guess where rays end.
std::vector<spatial::TriangleIndices> largest_triangles(const scenes::Scene& scene) {
    std::vector<std::pair<double, std::uint32_t>> by_area;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const auto [a, b, c] = scene.triangles[t];
        const auto [x, y, z] = spatial::across(scene.vertices[a], scene.vertices[b], scene.vertices[c]);
        by_area.emplace_back(-(x * x + y * y + z * z), t);
    }
    std::sort(by_area.begin(), by_area.end());
    by_area.resize((by_area.size() + 15) / 16);
    std::vector<spatial::TriangleIndices> largest;
    for (const auto& [area, t] : by_area) largest.push_back(scene.triangles[t]);
    return largest;
}

}  // namespace

std::string run(const RayJob& job, const ProgressListener& progress) {
    check_kind(job.rays);
    const spatial::RayStructureSpec spec = spatial::parse_ray_structure(job.structure);
    trace::TraceReader from(job.trace);
    std::error_code error;
    if (fs::equivalent(job.trace, job.folder, error))
        throw trace::UsageError(
            fmt::format("--output: found {}, expected another folder than the trace's", job.folder.string()));
    const scenes::Scene scene = scene_of(from, job.scene);
    const RayColumns rays(from, job.rays);
    const bool any_hit = job.rays == "shadow";
    const capture::RayCaster caster(scene);
    const std::optional<spatial::RayBvh> own =
        spec.entry->renderers ? std::nullopt
                              : std::optional(spatial::build(spec, scene.vertices, scene.triangles));
    const spatial::RayBvh& bvh = own ? *own : caster.bvh();
    const std::shared_ptr<const spatial::RayTree> tree = spatial::tree_of(spec, bvh, any_hit);
    const spatial::RayBvh coarse(scene.vertices, largest_triangles(scene));
    const spatial::RayTree coarse_tree("coarse", spatial::shape_of(coarse, spatial::RayBvh::width),
                                       {.on_chip = {}, .any_hit = any_hit});

    trace::TraceWriter writer(job.folder, job.force);  // from here on an earlier trace is gone
    spatial::store(*tree, bvh, writer);
    writer.column("query_position").append(rays.origin);
    writer.column("query_direction").append(rays.direction);
    writer.column("query_pixel").append(rays.pixel);
    trace::TraceInfo info;
    std::uint64_t hits = 0;
    constexpr std::uint64_t batch = 1 << 20;
    std::vector<spatial::Ray> cast;
    for (std::uint64_t first = 0; first < rays.origin.size() || first == 0; first += batch) {
        const std::uint64_t count = std::min<std::uint64_t>(batch, rays.origin.size() - first);
        cast.assign(count, {});
        for (std::uint64_t i = 0; i < count; ++i) {
            const Vec3 origin = rays.origin[first + i], direction = rays.direction[first + i];
            const std::optional<spatial::Ray> ray =
                any_hit ? caster.shadow_ray(origin, direction, rays.extent[first + i])
                        : caster.ray(origin, direction);
            cast[i] = ray.value_or(spatial::Ray{.origin = origin, .direction = {}});
        }
        const spatial::RayRecording walks = spatial::record_walks(bvh, *tree, cast);
        writer.column("query_end").append(std::span<const Vec3>(walks.end));
        writer.column("query_guess")
            .append(std::span<const Vec3>(spatial::record_walks(coarse, coarse_tree, cast).end));
        writer.column("query_leaf_bvh").append(std::span<const std::uint32_t>(walks.leaf));
        writer.column("query_walk_bytes").append(std::span<const std::uint32_t>(walks.walk_bytes));
        writer.column("walk").append(std::span<const std::uint8_t>(walks.walks));
        info.visited_nodes += walks.visited;
        hits += walks.hits;
        if (progress) progress("recording walks", "rays", first + count, rays.origin.size());
    }
    const trace::TraceInfo& captured = from.info();
    info.scene = captured.scene;
    info.frame = captured.frame;
    info.image_width = captured.image_width;
    info.image_height = captured.image_height;
    info.k = 0;
    info.seed = captured.seed;
    info.structure = spec.text;
    info.structure_version = spec.entry->version;
    info.queries = rays.origin.size();
    info.parameters = trace::Json::object({{"rays", job.rays}, {"capture", captured.parameters}});
    if (const trace::Json* const renderer = captured.parameters.find("renderer"))
        info.parameters["renderer"] = *renderer;
    info.counts = trace::Json::object(
        {{"hits", hits}, {"triangles", tree->shape().leaf_begin.back()}, {"leaves_bvh", tree->leaves() + 1}});
    info.left_out.push_back({"photon", "rays are not searches for photons"});
    writer.finish(info);
    const double count = std::max<double>(1, static_cast<double>(info.queries));
    return fmt::format(
        "{}: {} nodes of {} bytes, {} leaves with {} triangles; {} {} rays, {:.1f} % hit, {:.1f} elements "
        "visited a ray\ntrace: {}\n",
        info.structure, tree->inner_nodes(), tree->node_bytes(), tree->leaves(),
        tree->shape().leaf_begin.back(), info.queries, job.rays, 100 * static_cast<double>(hits) / count,
        static_cast<double>(info.visited_nodes) / count, job.folder.string());
}

}  // namespace regather::experiment
