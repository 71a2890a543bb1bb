#include "capture/capture.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <xxhash.h>

#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <type_traits>

#include "capture/bsdf.h"
#include "scenes/needs.h"
#include "spatial/photon_kd.h"
#include "spatial/triangle_bvh.h"
#include "spatial/triangle_kd.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

constexpr std::uint64_t batch_rays = 1 << 19;  // gather and shadow rays held at once

class Clock {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Labels of the leaves that the queries' hits lie in (the paper, section 6.3.2, "Other interesting reorderings").
class LeafLabels {
public:
    LeafLabels(const Scene& scene, const Columns& columns) {
        if (columns.leaf_kd) kd_.emplace(scene.vertices, scene.triangles);
        if (columns.leaf_bvh) bvh_.emplace(scene.vertices, scene.triangles);
    }
    std::vector<std::uint32_t> kd(const Queries& queries) const {
        return labels(queries.size(), [&](std::size_t q) { return kd_->leaf_of(queries.position[q]); });
    }
    std::vector<std::uint32_t> bvh(const Queries& queries) const {
        return labels(queries.size(), [&](std::size_t q) { return bvh_->leaf_of_triangle(queries.triangle[q]); });
    }

private:
    template <class Label>
    static std::vector<std::uint32_t> labels(std::size_t count, const Label& label) {
        std::vector<std::uint32_t> result(count);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t q) { result[q] = label(q); });
        return result;
    }
    std::optional<spatial::TriangleKd> kd_;
    std::optional<spatial::TriangleBvh> bvh_;
};

template <class T>
void append(trace::TraceWriter& writer, std::string_view name, const std::vector<T>& rows) {
    writer.column(name).append(std::span<const T>(rows));
}

nlohmann::json parameters_of(const CaptureConfig& config) {
    nlohmann::json radius = nullptr;  // JSON has no infinity
    if (std::isfinite(config.gather.radius)) radius = config.gather.radius;
    return {{"width", config.pixels.width},           {"height", config.pixels.height},
            {"gather_rays", config.pixels.gather_rays}, {"shadow_rays", config.pixels.shadow_rays},
            {"max_specular", config.pixels.max_specular}, {"photons", config.photon.photons},
            {"k", config.gather.k},                   {"radius", radius},
            {"seed", config.pixels.seed}};
}

nlohmann::json counts_of(const PhotonTally& tally, const std::array<std::uint64_t, 4>& rays) {
    nlohmann::json counts{{"photon_paths", tally.paths},
                          {"emitted_watts", tally.emitted},
                          {"reflected_watts", tally.reflected},
                          {"stored_watts", tally.stored},
                          {"escaped_watts", tally.escaped},
                          {"absorbed_by_specular_watts", tally.absorbed_by_specular},
                          {"cut_off_watts", tally.cut_off}};
    for (std::size_t kind = 0; kind < rays.size(); ++kind)
        counts[fmt::format("{}_rays", ray_kind_names[kind])] = rays[kind];
    return counts;
}

/// What says whether a scene makes rays of this kind; null: every scene does.
const scenes::Need* need_of(const scenes::Needs& needs, RayKind kind) {
    if (kind == RayKind::shadow) return &needs.shadow_rays;
    return kind == RayKind::specular ? &needs.specular_rays : nullptr;
}

class Digest {
public:
    Digest() : state_(XXH3_createState()) { XXH3_64bits_reset(state_); }
    Digest(const Digest&) = delete;
    Digest& operator=(const Digest&) = delete;
    ~Digest() { XXH3_freeState(state_); }
    template <class T>
    void add(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, float> ||
                      std::is_same_v<T, Vec3>);
        XXH3_64bits_update(state_, &value, sizeof value);
    }
    template <class T>
    void add(const std::vector<T>& values) {
        add(values.size());
        XXH3_64bits_update(state_, values.data(), values.size() * sizeof(T));
    }
    std::string text() const { return fmt::format("{:016x}", XXH3_64bits_digest(state_)); }

private:
    XXH3_state_t* state_;
};

}  // namespace

std::string checksum(const Scene& scene) {
    Digest digest;
    digest.add(scene.vertices);
    digest.add(scene.normals);
    digest.add(scene.triangles);
    digest.add(scene.triangle_material);
    digest.add(scene.triangle_light);
    for (const Material& material : scene.materials) {
        digest.add(material.kind);
        digest.add(material.diffuse);
        digest.add(material.specular);
        digest.add(material.exponent);
        digest.add(material.index_of_refraction);
    }
    for (const scenes::AreaLight& light : scene.lights)
        for (const Vec3 v : {light.corner, light.edge_u, light.edge_v, light.radiance}) digest.add(v);
    for (const Vec3 v : {scene.camera.position, scene.camera.target, scene.camera.up}) digest.add(v);
    digest.add(scene.camera.vertical_fov_degrees);
    return digest.text();
}

nlohmann::json parameters(const Scene& scene, const CaptureConfig& config) {
    nlohmann::json all = parameters_of(config);
    all["scene_checksum"] = checksum(scene);
    return all;
}

Captured capture(const Scene& scene, const CaptureConfig& config, trace::TraceWriter* writer) {
    const std::uint64_t pixels = std::uint64_t{config.pixels.width} * config.pixels.height;
    if (pixels == 0)
        throw trace::UsageError(fmt::format("image size: found {} x {}, expected at least one pixel",
                                            config.pixels.width, config.pixels.height));
    if (pixels * (std::uint64_t{config.pixels.gather_rays} + 1) >= (std::uint64_t{1} << 32))
        throw trace::UsageError(fmt::format("gather rays: found {} pixels x {}, expected fewer than 2^32 queries",
                                            pixels, config.pixels.gather_rays));
    const auto report = [&](std::string_view stage, std::uint64_t done, std::uint64_t total) {
        if (config.progress) config.progress(stage, done, total);
    };

    Captured result;
    Clock clock;
    report("photons", 0, config.photon.photons);
    const RayCaster caster(scene);
    const PhotonPass photon_pass = trace_photons(scene, caster, config.photon);
    result.photon_seconds = clock.lap();
    const std::vector<trace::Photon> heap = spatial::left_balanced(photon_pass.photons);
    const spatial::PhotonKd tree(heap);
    result.tree_seconds = clock.lap();

    Columns columns = config.columns;
    if (!writer) columns = {.rays = false, .direction = false, .leaf_kd = false, .leaf_bvh = false};
    const LeafLabels labels(scene, columns);
    const QueryPass query_pass(scene, caster, config.pixels, columns.rays);
    const scenes::Needs needs = scenes::needs_of(scene);
    if (writer) append(*writer, "photon", heap);

    trace::TraceInfo& info = result.info;
    result.image = {config.pixels.width, config.pixels.height, {}};
    result.image.pixels.reserve(pixels);
    std::array<std::uint64_t, 4> ray_counts{};
    const std::uint64_t pixel_rays =
        config.pixels.gather_rays + 2 * std::uint64_t{config.pixels.shadow_rays} * scene.lights.size();
    const std::uint64_t batch = std::max<std::uint64_t>(1, batch_rays / std::max<std::uint64_t>(pixel_rays, 1));
    PixelWork work;
    Gathered gathered;
    for (std::uint64_t first = 0; first < pixels; first += batch) {
        clock.lap();
        const std::uint64_t count = std::min(batch, pixels - first);
        query_pass.run(first, count, work);
        const Queries& queries = work.queries;
        result.query_seconds += clock.lap();

        std::vector<std::uint32_t> order(queries.size());
        if (config.order) {
            order = config.order(queries);
        } else {
            std::iota(order.begin(), order.end(), 0u);
        }
        gather(scene, tree, queries, order, config.gather, gathered);
        result.gather_seconds += clock.lap();

        // The sums run in capture order, whatever the order of the searches.
        for (std::size_t q = 0, i = 0; i < count; ++i) {
            const Vec3 direct = work.radiance[i];
            double sum[3] = {direct.x, direct.y, direct.z};
            for (; q < queries.size() && queries.pixel[q] == first + i; ++q) {
                const Vec3 part = queries.weight[q] * gathered.radiance[q];
                for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(part[c]);
            }
            Vec3 pixel{static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
            if (!trace::is_finite(pixel)) {
                pixel = {};
                ++result.nonfinite_pixels;
            }
            result.image.pixels.push_back(pixel);
        }

        info.queries += queries.size();
        info.found_photons += gathered.found_photons;
        info.visited_nodes += gathered.visited_nodes;
        for (std::size_t kind = 0; kind < ray_counts.size(); ++kind) ray_counts[kind] += work.ray_counts[kind];
        if (writer) {
            append(*writer, "query_position", queries.position);
            append(*writer, "query_pixel", queries.pixel);
            append(*writer, "query_weight", queries.weight);
            if (columns.direction) append(*writer, "query_direction", queries.direction);
            if (columns.leaf_kd) append(*writer, "query_leaf_kd", labels.kd(queries));
            if (columns.leaf_bvh) append(*writer, "query_leaf_bvh", labels.bvh(queries));
            append(*writer, "query_walk_bytes", gathered.walk_bytes);
            append(*writer, "walk", gathered.walks);
            for (std::size_t kind = 0; columns.rays && kind < work.rays.size(); ++kind) {
                const Rays& rays = work.rays[kind];
                if (const scenes::Need* need = need_of(needs, static_cast<RayKind>(kind)); need && !need->needed) continue;
                const auto name = [&](const char* field) { return fmt::format("ray_{}_{}", ray_kind_names[kind], field); };
                append(*writer, name("origin"), rays.origin);
                append(*writer, name("direction"), rays.direction);
                append(*writer, name("extent"), rays.extent);
                append(*writer, name("pixel"), rays.pixel);
            }
        }
        result.write_seconds += clock.lap();
        report("pixels", first + count, pixels);
    }

    info.scene = scene.name;
    info.image_width = config.pixels.width;
    info.image_height = config.pixels.height;
    info.k = config.gather.k;
    info.seed = config.pixels.seed;
    info.photons = heap.size();
    info.parameters = parameters(scene, config);
    info.counts = counts_of(photon_pass.tally, ray_counts);
    info.counts["nonfinite_pixels"] = result.nonfinite_pixels;
    const auto left_out = [&](const char* what, const char* why) { info.left_out.push_back({what, why}); };
    if (!columns.direction) left_out("query_direction", "no ordering asked for it");
    if (!columns.leaf_kd) left_out("query_leaf_kd", "no ordering asked for it");
    if (!columns.leaf_bvh) left_out("query_leaf_bvh", "no ordering asked for it");
    for (std::size_t k = 0; k < ray_kind_names.size(); ++k) {
        const char* const kind = ray_kind_names[k];
        const scenes::Need* const need = need_of(needs, static_cast<RayKind>(k));
        for (const char* field : {"origin", "direction", "extent", "pixel"}) {
            const std::string name = fmt::format("ray_{}_{}", kind, field);
            if (!columns.rays) {
                left_out(name.c_str(), "no replay asked for rays");
            } else if (need && !need->needed) {
                left_out(name.c_str(), need->reason.c_str());
            }
        }
    }
    return result;
}

}  // namespace regather::capture
