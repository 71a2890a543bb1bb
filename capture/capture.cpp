#include "capture/capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>

#include "capture/baselines/precomputed_irradiance.h"
#include "capture/baselines/reverse_gather.h"
#include "capture/irradiance/irradiance_pass.h"
#include "capture/irradiance/octree_columns.h"
#include "capture/light/light_probe.h"
#include "scenes/needs.h"
#include "spatial/photons/photon_kd.h"
#include "trace/error.h"
#include "trace/packed_photon.h"

namespace regather::capture {
namespace {

constexpr std::uint64_t batch_rays = 1 << 19;  // gather and shadow rays held at once
constexpr std::uint32_t caustic_paths_per_photon = 25;

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

trace::Json length_of(float radius) {
    return std::isfinite(radius) ? trace::Json(radius) : trace::Json();  // JSON has no infinity
}

trace::Json counts_of(const PhotonTally& tally) {
    return trace::Json::object({{"photon_paths", tally.paths},
                                {"emitted_watts", tally.emitted},
                                {"reflected_watts", tally.reflected},
                                {"stored_watts", tally.stored},
                                {"not_stored_watts", tally.not_stored},
                                {"escaped_watts", tally.escaped},
                                {"absorbed_by_specular_watts", tally.absorbed_by_specular},
                                {"cut_off_watts", tally.cut_off}});
}

/// The photons of the map between two that are searched at.
std::uint32_t photons_apart(const CaptureConfig& config) {
    return std::max(1u, config.precompute_every);
}

/// Of a trace whose queries are not the picture's.
void describe(trace::TraceInfo& info, const char* map, const Scene& scene, const CaptureConfig& config) {
    info.scene = scene.name;
    info.map = map;
    info.frame = config.frame;
    info.seed = config.pixels.seed;
    info.parameters = trace::Json::object({{"capture", parameters(scene, config)}});
}

/// The photons in the order in which they were stored.
ReachingPhotons in_order(ReachingPhotons reaching, std::span<const std::uint32_t> from) {
    ReachingPhotons stored = reaching;
    for (std::size_t i = 0; i < from.size(); ++i) {
        stored.photons[from[i]] = reaching.photons[i];
        stored.radius2[from[i]] = reaching.radius2[i];
    }
    return stored;
}

/// A photon map: its photons in heap order, what its searches have found, and its trace.
struct Map {
    explicit Map(const GatherConfig& gather) : config(gather) {}

    GatherConfig config;
    std::vector<trace::Photon> heap;
    std::vector<PhotonOrigin> origin;  // of the heap's photons
    std::vector<trace::Photon> whole;  // where `heap` is of packed ones: the photons before, in heap order
    PhotonTally tally;
    Gathered gathered, of_whole;
    std::optional<PrecomputedIrradiance> precomputed;  // is looked up, and the photons are not gathered
    std::optional<ReverseGather> reverse;              // the photons search the queries
    trace::TraceWriter* reverse_writer = nullptr;
    trace::TraceInfo info;
    std::unique_ptr<TraceColumns> columns;

    /// What queries search.
    std::span<const trace::Photon> searched() const {
        if (reverse) return {};
        return precomputed ? precomputed->records : heap;
    }

    void gather(const Scene& scene, const Queries& queries, const CaptureConfig& capture) {
        if (reverse) {
            reverse->run(scene, queries, reverse_writer, gathered);
            info.queries += queries.size();
            return;
        }
        std::vector<std::uint32_t> order(queries.size());
        if (capture.order) {
            order = capture.order(queries);
        } else {
            std::iota(order.begin(), order.end(), 0u);
        }
        if (precomputed)
            look_up(scene, precomputed->records, queries, order, config, gathered);
        else
            capture::gather(scene, spatial::PhotonKd(heap), queries, order, config, gathered);
        if (capture.record == PhotonRecord::packed)
            capture::gather(scene, spatial::PhotonKd(whole), queries, order, config, of_whole);
        info.queries += queries.size();
        info.found_photons += gathered.found_photons;
        info.visited_nodes += gathered.visited_nodes;
    }
};

void check(const CaptureConfig& config) {
    const QueryConfig& pixels = config.pixels;
    const std::uint64_t count = std::uint64_t{pixels.width} * pixels.height;
    if (count == 0)
        throw trace::UsageError(fmt::format("image size: found {} x {}, expected at least one pixel",
                                            pixels.width, pixels.height));
    if (pixels.samples == 0)
        throw trace::UsageError("samples: found 0, expected at least one eye ray a pixel");
    // A dielectric splits an eye ray once, and each shaded point has one gather ray at least.
    std::uint64_t most = std::max<std::uint64_t>(pixels.gather_rays, 1) + 2 * std::uint64_t{pixels.samples};
    if (has_precomputation(config) && config.record == PhotonRecord::packed)
        throw trace::UsageError(
            "precomputed irradiance or reverse gathering: found packed photons, expected whole ones: what "
            "packing does to the image is told from two gathers of each query");
    if (config.reverse_pixels > 0 && (config.precompute_every > 0 || has_irradiance_cache(config)))
        throw trace::UsageError(
            fmt::format("reverse gathering: found beside {}, expected one of them",
                        config.precompute_every > 0 ? "precomputed irradiance" : "an irradiance cache"));
    if (has_irradiance_cache(config)) {
        if (config.record == PhotonRecord::packed)
            throw trace::UsageError(
                "irradiance cache: found packed photons, expected whole ones: what packing does to the image "
                "is told from two gathers of each pixel");
        // At worst each point has a record.
        const std::uint32_t rays = parse_irradiance_cache(pixels.irradiance_cache).rays();
        most += 2 * std::uint64_t{pixels.samples} * std::max<std::uint64_t>(rays, pixels.gather_rays);
    }
    if (count * most >= (std::uint64_t{1} << 32))
        throw trace::UsageError(
            fmt::format("gather rays: found {} pixels x {}, expected fewer than 2^32 queries", count,
                        pixels.gather_rays));
}

void count(const IrradianceTally& tally, trace::Json& counts) {
    counts["irradiance_records"] = tally.records;
    counts["irradiance_octree_bytes"] = tally.octree_bytes;
    counts["irradiance_rays"] = tally.rays;
    counts["irradiance_queries"] = tally.queries;
    counts["irradiance_points_served"] = tally.use.served;
    counts["irradiance_points_not_served"] = tally.use.not_served;
    counts["irradiance_rays_saved"] = tally.use.rays_saved;
    counts["irradiance_scatter"] = tally.scatter;
    counts["irradiance_scatter_of_all"] = tally.scatter_of_all;
    const WaitingPixels& waiting = tally.waiting;
    counts["irradiance_waiting_records"] = waiting.records;
    counts["irradiance_waiting_records_unheld"] = waiting.records_unheld;
    counts["irradiance_waiting_points"] = waiting.waited;
    counts["irradiance_waiting_most"] = waiting.most_waiting;
    counts["irradiance_waiting_half"] = waiting.half;
    counts["irradiance_waiting_nine_tenths"] = waiting.nine_tenths;
    counts["irradiance_waiting_ninety_nine"] = waiting.ninety_nine;
    counts["irradiance_waiting_longest"] = waiting.longest;
    counts["irradiance_waiting_stopped"] = waiting.stopped;
}

}  // namespace

trace::Json parameters(const Scene& scene, const CaptureConfig& config) {
    const QueryConfig& pixels = config.pixels;
    trace::Json all = trace::Json::object(
        {{"width", pixels.width},
         {"height", pixels.height},
         {"samples", pixels.samples},
         {"jitter", pixels.jitter},
         {"visualisation", visualisation_names[static_cast<std::size_t>(pixels.visualisation)]},
         {"gather_rays", pixels.gather_rays},
         {"shadow_rays", pixels.shadow_rays},
         {"max_specular", pixels.max_specular},
         {"photons", config.photon.photons},
         {"k", config.gather.k},
         {"radius", length_of(config.gather.radius)},
         {"filter", filter_names[static_cast<std::size_t>(config.gather.filter)]},
         {"surface_check", config.gather.surface_check},
         {"seed", pixels.seed},
         {"scene_checksum", checksum(scene)}});
    if (!config.renderer.empty())
        all["renderer"] = trace::Json::object({{"scene", scene.name}, {"fingerprint", config.renderer}});
    if (config.frame) all["frame"] = *config.frame;
    if (!config.keep.empty()) all["keep"] = config.keep;
    if (config.record == PhotonRecord::packed) all["photon_record"] = 16;
    if (const std::string sampling = parse_sampling(pixels.sampling).text; sampling != default_sampling)
        all["sampling"] = sampling;
    if (has_irradiance_cache(config))
        all["irradiance_cache"] = parse_irradiance_cache(pixels.irradiance_cache).text;
    const trace::Json radius = length_of(config.gather.radius);
    if (has_precomputation(config))
        all["precompute"] = trace::Json::object(
            {{"every", photons_apart(config)}, {"k", config.gather.k}, {"radius", radius}});
    if (config.precompute_every > 0) all["precomputed"] = trace::Json::object({{"k", 1}, {"radius", radius}});
    if (config.reverse_pixels > 0)
        all["hits"] = trace::Json::object(
            {{"k", config.gather.k}, {"radius", radius}, {"pixels", config.reverse_pixels}});
    if (has_caustic_map(scene, config))
        all["caustic"] =
            trace::Json::object({{"photons", config.caustic.photons},
                                 {"k", config.caustic.k},
                                 {"radius", length_of(config.caustic.radius)},
                                 {"filter", filter_names[static_cast<std::size_t>(config.caustic.filter)]}});
    if (has_guide(config))
        all["guide"] = trace::Json::object(
            {{"k", std::min(parse_sampling(pixels.sampling).photons_asked(), config.photon.photons)},
             {"radius", trace::Json()}});
    return all;
}

bool has_precomputation(const CaptureConfig& config) {
    return config.precompute_every > 0 || config.reverse_pixels > 0;
}

bool has_guide(const CaptureConfig& config) {
    return config.pixels.visualisation == Visualisation::final_gather &&
           parse_sampling(config.pixels.sampling).photons_asked() > 0;
}

bool has_irradiance_cache(const CaptureConfig& config) {
    return !config.pixels.irradiance_cache.empty() && config.pixels.gather_rays > 0 &&
           config.pixels.visualisation == Visualisation::final_gather;
}

bool has(Beside trace, const Scene& scene, const CaptureConfig& config) {
    switch (trace) {
        case Beside::caustic:
            return has_caustic_map(scene, config);
        case Beside::guide:
            return has_guide(config);
        case Beside::precompute:
            return has_precomputation(config);
        case Beside::reverse:
            return config.reverse_pixels > 0;
        case Beside::irradiance:
        case Beside::irradiance_rounds:
        case Beside::irradiance_inserts:
            return has_irradiance_cache(config);
    }
    return false;
}

bool has_caustic_map(const Scene& scene, const CaptureConfig& config) {
    scenes::Needs needs = scenes::needs_of(scene);
    needs.keep(config.keep);
    return needs.caustics.needed && config.caustic.photons > 0;
}

Captured capture(const Scene& scene, const CaptureConfig& config, const TraceWriters& writers) {
    check(config);
    const std::uint64_t pixels = std::uint64_t{config.pixels.width} * config.pixels.height;
    const auto report = [&](std::string_view stage, std::uint64_t done, std::uint64_t total) {
        if (config.progress) config.progress(stage, done, total);
    };
    scenes::Needs needs = scenes::needs_of(scene);
    needs.keep(config.keep);
    const bool caustics = has_caustic_map(scene, config);

    const bool packed = config.record == PhotonRecord::packed;
    double farthest = 0;  // that a packed photon moved
    Captured result;
    Clock clock;
    const RayCaster caster(scene);
    const LightSampler lights(scene);
    Map global(config.gather);
    // `from`: which of the photons as they were stored each of the heap's is.
    const auto precompute = [&](std::span<const std::uint32_t> from) {
        ReachingPhotons reaching;
        if (config.precompute_every > 0) {
            global.precomputed = precompute_irradiance(global.heap, config.precompute_every, config.gather);
            result.nonfinite.count(Stage::estimate, global.precomputed->nonfinite);
        } else {
            reaching = reaching_photons(global.heap, config.gather);
        }
        if (writers.beside[Beside::precompute]) {
            trace::TraceInfo& info = result.beside[Beside::precompute].emplace();
            write_photon_searches(*writers.beside[Beside::precompute], global.heap, photons_apart(config),
                                  global.precomputed ? global.precomputed->searches : reaching.searches,
                                  info);
            describe(info, "precompute", scene, config);
            info.k = config.gather.k;
            info.parameters["precompute"] = *parameters(scene, config).find("precompute");
        }
        if (global.precomputed) return;
        global.reverse_writer = writers.beside[Beside::reverse];
        global.reverse.emplace(in_order(std::move(reaching), from), config.gather,
                               static_cast<std::uint32_t>(pixels));
    };
    const auto build = [&](Map& map, const PhotonConfig& photon, trace::TraceWriter* writer) {
        clock.lap();
        PhotonPass pass = trace_photons(scene, caster, lights, photon);
        result.photon_seconds += clock.lap();
        if (packed) {
            map.whole = spatial::left_balanced(pass.photons);
            farthest = std::max(farthest, trace::pack_positions(pass.photons));
        }
        std::vector<std::uint32_t> from;
        map.heap = spatial::left_balanced(pass.photons, from);
        map.origin.resize(from.size());
        std::transform(from.begin(), from.end(), map.origin.begin(),
                       [&](std::uint32_t one) { return pass.origin[one]; });
        map.tally = pass.tally;
        result.nonfinite += pass.tally.nonfinite;
        if (&map == &global && has_precomputation(config)) precompute(from);
        result.tree_seconds += clock.lap();
        if (!writer) return;
        const bool gathered =
            writer == writers.global && config.pixels.visualisation == Visualisation::final_gather;
        map.columns = std::make_unique<TraceColumns>(scene, config.columns, needs, *writer, gathered);
        map.columns->write_photons(map.searched());
    };
    PhotonConfig photon = config.photon;
    if (caustics && config.pixels.visualisation == Visualisation::direct)
        photon.kind = PhotonKind::all_but_caustic;
    report("photons", 0, photon.photons);
    build(global, photon, writers.global);
    Map caustic({.k = config.caustic.k,
                 .radius = config.caustic.radius,
                 .filter = config.caustic.filter,
                 .surface_check = config.gather.surface_check});
    if (caustics) {
        report("caustic photons", 0, config.caustic.photons);
        build(caustic,
              {.photons = config.caustic.photons,
               .seed = config.photon.seed,
               .kind = PhotonKind::caustic,
               .paths_per_photon = caustic_paths_per_photon},
              writers.beside[Beside::caustic]);
    }

    const spatial::PhotonKd photons(global.heap);
    const LightProbe probe(scene, caster, photons, global.config);
    PassParts parts{.rays = writers.global && config.columns.rays,
                    .caustics = caustics,
                    .guide = {photons, global.origin, caustics,
                              [&](Vec3 origin, Vec3 direction) { return probe.seen(origin, direction); }},
                    .guide_queries = writers.beside[Beside::guide] != nullptr};
    std::array<std::uint64_t, ray_kind_names.size()> ray_counts{};
    PixelWork work;
    // What a batch asked for, in the counts and the global map's trace.
    const auto keep = [&] {
        for (std::size_t kind = 0; kind < ray_counts.size(); ++kind)
            ray_counts[kind] += work.ray_counts[kind];
        result.nonfinite += work.nonfinite;
        if (!global.columns) return;
        global.columns->write_queries(work.queries, global.gathered);
        if (global.precomputed && config.gather.surface_check)
            writers.global->column("query_normal").append(std::span<const Vec3>(work.queries.normal));
        global.columns->write_rays(work);
    };
    std::optional<IrradiancePass> irradiance;
    if (has_irradiance_cache(config)) {
        clock.lap();
        IrradianceTally& tally = result.irradiance.emplace();
        irradiance.emplace(scene, caster, lights, config.pixels, parts);
        while (irradiance->next(work)) {
            result.query_seconds += clock.lap();
            global.gather(scene, work.queries, config);
            irradiance->add(global.gathered.radiance, work.nonfinite);
            result.gather_seconds += clock.lap();
            tally.rays += work.ray_counts[static_cast<std::size_t>(RayKind::gather)];
            tally.queries += work.queries.size();
            keep();
            result.write_seconds += clock.lap();
            report("irradiance records", irradiance->octree().size(), irradiance->octree().size());
        }
        result.query_seconds += clock.lap();
        tally.records = irradiance->octree().size();
        tally.octree_bytes = irradiance->octree().bytes();
        tally.scatter = irradiance->scatter();
        tally.scatter_of_all = irradiance->scatter_of_all();
        tally.waiting = irradiance->waiting();
        result.query_seconds += clock.lap();
        parts.irradiance = &irradiance->octree();
        parts.octree_searches = writers.beside[Beside::irradiance] != nullptr;
    }
    trace::TraceInfo octree_info, rounds_info, inserts_info;
    if (irradiance) {
        write_seeding(irradiance->seeding(), config.pixels.width,
                      {writers.beside[Beside::irradiance_rounds], rounds_info},
                      {writers.beside[Beside::irradiance_inserts], inserts_info});
        result.write_seconds += clock.lap();
    }
    const QueryPass query_pass(scene, caster, lights, config.pixels, parts);
    Map guide({.k = parse_sampling(config.pixels.sampling).photons_asked()});
    if (writers.beside[Beside::guide]) {
        guide.heap = global.heap;
        guide.whole = global.whole;
        guide.config.k = std::min(guide.config.k, photons.size());
        guide.tally = global.tally;
        guide.columns = std::make_unique<TraceColumns>(scene, config.columns, needs,
                                                       *writers.beside[Beside::guide], false);
        guide.columns->write_photons(guide.heap);
    }
    Film film(config.pixels.width, config.pixels.height, config.pixels.samples);
    std::optional<Film> whole_film;
    if (packed) whole_film.emplace(config.pixels.width, config.pixels.height, config.pixels.samples);
    const std::uint64_t pixel_rays = config.pixels.gather_rays + 2 * std::uint64_t{config.pixels.samples} *
                                                                     config.pixels.shadow_rays *
                                                                     std::min<std::size_t>(lights.size(), 4);
    const std::uint64_t batch =
        config.reverse_pixels > 0
            ? config.reverse_pixels
            : std::max<std::uint64_t>(1, batch_rays / std::max<std::uint64_t>(pixel_rays, 1));
    for (std::uint64_t first = 0; first < pixels; first += batch) {
        clock.lap();
        const std::uint64_t count = std::min(batch, pixels - first);
        query_pass.run(first, count, work);
        result.query_seconds += clock.lap();
        global.gather(scene, work.queries, config);
        if (caustics) caustic.gather(scene, work.caustic_queries, config);
        if (guide.columns) guide.gather(scene, work.guide_queries, config);
        film.add(work, global.gathered, caustic.gathered);
        if (whole_film) whole_film->add(work, global.of_whole, caustic.of_whole);
        result.gather_seconds += clock.lap();
        if (result.irradiance) result.irradiance->use += work.irradiance;
        if (writers.beside[Beside::irradiance])
            write_searches(*writers.beside[Beside::irradiance], work.octree_searches, octree_info);
        keep();
        if (caustic.columns) caustic.columns->write_queries(work.caustic_queries, caustic.gathered);
        if (guide.columns) guide.columns->write_queries(work.guide_queries, guide.gathered);
        result.write_seconds += clock.lap();
        report("pixels", first + count, pixels);
    }
    result.image = film.image();
    result.layers = film.layers();
    result.nonfinite += film.nonfinite();
    if (whole_film) result.record_error = record_error(result.image, whole_film->image(), farthest);

    const auto finish = [&](Map& map, const char* name) {
        trace::TraceInfo& info = map.info;
        info.scene = scene.name;
        info.map = name;
        info.frame = config.frame;
        info.image_width = config.pixels.width;
        info.image_height = config.pixels.height;
        info.k = map.precomputed ? 1 : map.config.k;
        info.photons = map.searched().size();
        info.seed = config.pixels.seed;
        info.parameters = parameters(scene, config);
        info.counts = counts_of(map.tally);
        for (std::size_t kind = 0; kind < ray_counts.size(); ++kind)
            info.counts[fmt::format("{}_rays", ray_kind_names[kind])] = ray_counts[kind];
        for (std::size_t stage = 0; stage < stage_count; ++stage)
            info.counts[fmt::format("nonfinite_{}", stage_names[stage])] =
                result.nonfinite.of(static_cast<Stage>(stage));
        if (map.columns) {
            info.left_out = map.columns->left_out();
            map.columns->count_leaves(info.counts);
        }
        return info;
    };
    result.info = finish(global, global.precomputed ? "precomputed" : global.reverse ? "hits" : "global");
    if (result.beside[Beside::precompute])
        result.info.counts["precompute_queries"] = result.beside[Beside::precompute]->queries;
    if (global.reverse) {
        result.info.counts["reverse_passes"] = global.reverse->passes();
        result.info.counts["reverse_points"] = global.reverse->points();
        result.info.counts["reverse_additions"] = global.reverse->additions();
    }
    if (global.reverse && writers.beside[Beside::reverse]) {
        trace::TraceInfo& info = result.beside[Beside::reverse].emplace();
        global.reverse->finish(*writers.beside[Beside::reverse], info);
        describe(info, "global", scene, config);
    }
    const auto finish_octree = [&](Beside trace, trace::TraceInfo& info) {
        if (!irradiance || !writers.beside[trace]) return;
        finish_searches(*writers.beside[trace], irradiance->octree(), info);
        describe(info, "global", scene, config);
        info.image_width = config.pixels.width;
        info.image_height = config.pixels.height;
        result.beside[trace] = info;
    };
    finish_octree(Beside::irradiance, octree_info);
    finish_octree(Beside::irradiance_rounds, rounds_info);
    finish_octree(Beside::irradiance_inserts, inserts_info);
    if (result.irradiance) count(*result.irradiance, result.info.counts);
    if (const std::optional<RecordError>& error = result.record_error) {
        result.info.counts["packed_farthest"] = error->farthest;
        result.info.counts["packed_relative_rmse"] = error->relative_rmse;
        result.info.counts["packed_relative_mean"] = error->relative_mean;
        result.info.counts["packed_flip"] = error->flip;
    }
    if (writers.beside[Beside::guide]) {
        result.beside[Beside::guide] = finish(guide, "guide");
        result.info.counts["guide_queries"] = guide.info.queries;
    }
    if (caustics) {
        result.beside[Beside::caustic] = finish(caustic, "caustic");
    } else if (writers.global) {
        result.info.left_out.push_back({"caustic map", needs.caustics.needed
                                                           ? "no caustic photons were asked for"
                                                           : needs.caustics.reason});
    }
    return result;
}

}  // namespace regather::capture
