#include "replay/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "replay/walk_run.h"
#include "replay/walk_store.h"
#include "spatial/photons/candidate_bits.h"
#include "spatial/photons/photon_kd.h"
#include "spatial/photons/structures.h"
#include "spatial/rays/ray_structures.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::replay {

namespace {

using trace::Vec3;

constexpr double unit_tolerance = 1e-3;

/// Of trace.json.
[[noreturn]] void refuse_field(const trace::TraceReader& trace, std::string_view field,
                               std::string_view found, std::string_view expected) {
    throw trace::DataError(
        fmt::format("{}: {}: found {}, expected {}",
                    trace::shown((trace.folder() / "trace.json").string(), trace::most_shown_path), field,
                    found, expected));
}

std::string shown(const trace::Json& value) {
    return trace::shown(value.dump());
}

/// Whether trace.json has what a capture writes, and `regather walk` does not.
bool is_captured(const trace::TraceInfo& info) {
    return info.parameters.find("renderer") || info.parameters.find("scene_checksum") ||
           info.counts.find("photon_paths");
}

/// What a capture was asked for of the trace's map, and its path in trace.json; null when it is not there.
struct MapParameters {
    const trace::Json* object;
    std::string path;
};
MapParameters map_parameters(const trace::TraceInfo& info) {
    if (info.map != trace::map_names[0])
        return {info.parameters.find(info.map), fmt::format("parameters.{}", info.map)};
    return {&info.parameters, "parameters"};
}

class Verification {
public:
    explicit Verification(trace::TraceReader& trace)
        : trace_(trace),
          info_(trace.info()),
          is_of_rays_(spatial::is_ray_structure(trace.info().structure)) {}

    Verified run(const QueriesDone& progress) {
        check_parameters();
        trace_.verify_all();
        if (is_of_rays_) {
            check_queries();
            check_walks();
            check_candidates();
            return verified_;
        }
        if (trace_.has("photon")) check_photons();
        check_queries();
        for (const trace::ColumnEntry& entry : trace::column_table())
            if (entry.name.starts_with("ray_")) check_rays(entry.name);
        check_walks();
        check_candidates();
        check_searches(progress);
        return verified_;
    }

private:
    [[noreturn]] void refuse(std::string_view column, std::uint64_t row, const std::string& found,
                             const std::string& expected) const {
        throw trace::DataError(fmt::format("{}: row {}: found {}, expected {}",
                                           (trace_.folder() / fmt::format("{}.npy", column)).string(), row,
                                           found, expected));
    }
    /// Of trace.json.
    [[noreturn]] void refuse(std::string_view field, std::uint64_t found, std::string_view expected) const {
        refuse_field(trace_, field, fmt::format("{}", found), expected);
    }
    template <class T, class Fits>
    void check_rows(std::string_view column, const std::string& expected, const Fits& fits) {
        if (!trace_.has(column)) return;
        const std::span<const T> rows = trace_.column<T>(column);
        for (std::uint64_t row = 0; row < rows.size(); ++row)
            if (!fits(rows[row])) refuse(column, row, text(rows[row]), expected);
    }
    static std::string text(Vec3 v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }
    static std::string text(float x) { return fmt::format("{}", x); }
    static std::string text(std::uint32_t n) { return fmt::format("{}", n); }

    void check_photons() {
        const spatial::PhotonKd tree(trace_.column<trace::Photon>("photon"));
        if (const std::uint32_t node = spatial::first_disorder(tree); node != tree.size())
            refuse("photon", node, "a photon at no finite place or on the wrong side of a split",
                   "a left-balanced kd-tree");
    }
    void check_pixels(std::string_view column) {
        const std::uint64_t pixels = std::uint64_t{info_.image_width} * info_.image_height;
        check_rows<std::uint32_t>(column,
                                  fmt::format("a pixel below {} x {}", info_.image_width, info_.image_height),
                                  [&](std::uint32_t pixel) { return pixel < pixels; });
    }
    void check_directions(std::string_view column) {
        check_rows<Vec3>(column, "a vector of length 1",
                         [](Vec3 v) { return std::fabs(trace::length(v) - 1) <= unit_tolerance; });
    }
    /// What the capture was asked for is what the trace says of itself.
    void check_parameters() const {
        const auto agree = [&](const trace::Json* of, const std::string& path, std::string_view key,
                               std::string_view name, const trace::Json& value) {
            const trace::Json* const asked = of ? of->find(key) : nullptr;
            if (asked && *asked != value)
                refuse_field(trace_, fmt::format("{}.{}", path, key), shown(*asked),
                             fmt::format("{} as {}", shown(value), name));
        };
        const MapParameters map = map_parameters(info_);
        agree(map.object, map.path, "k", "k", info_.k);
        agree(&info_.parameters, "parameters", "width", "image_width", info_.image_width);
        agree(&info_.parameters, "parameters", "height", "image_height", info_.image_height);
        agree(&info_.parameters, "parameters", "seed", "seed", info_.seed);
        if (!is_of_rays_) search_radius(trace_);
        for (const char* const kind : {"eye", "specular", "shadow", "gather"}) {
            const std::string columns = fmt::format("ray_{}_", kind), rays = fmt::format("{}_rays", kind);
            const auto column = trace_.digests().lower_bound(columns);
            if (column == trace_.digests().end() || !column->first.starts_with(columns)) continue;
            const trace::Json* const count = info_.counts.find(rays);
            if (count && *count != trace::Json(column->second.rows))
                refuse_field(trace_, fmt::format("counts.{}", rays), shown(*count),
                             fmt::format("{} as the rows of {}", column->second.rows, column->first));
        }
    }
    void check_labels(const char* column, const char* leaves) {
        if (!trace_.has(column)) return;
        const trace::Json* const count = info_.counts.find(leaves);
        if (!count && !is_captured(info_)) return;
        if (!count || !count->whole())
            refuse_field(trace_, fmt::format("counts.{}", leaves), count ? shown(*count) : "nothing",
                         fmt::format("how many leaves {} counts", column));
        check_rows<std::uint32_t>(
            column, fmt::format("a leaf below {}, as {} in trace.json says", *count->whole(), leaves),
            [&](std::uint32_t label) { return label < *count->whole(); });
    }

    void check_queries() {
        check_pixels("query_pixel");
        check_rows<Vec3>("query_weight", "finite numbers", [](Vec3 v) { return trace::is_finite(v); });
        check_directions("query_direction");
        check_directions("query_normal");
        check_labels("query_leaf_kd", "leaves_kd");
        check_labels("query_leaf_bvh", "leaves_bvh");
        for (const char* const point : {"query_end", "query_guess"})
            check_rows<Vec3>(point, "finite numbers", [](Vec3 v) { return trace::is_finite(v); });
        const std::span<const Vec3> positions = trace_.column<Vec3>("query_position");
        verified_.queries_nowhere = static_cast<std::uint64_t>(
            std::count_if(positions.begin(), positions.end(), [](Vec3 v) { return !trace::is_finite(v); }));
    }

    void check_rays(std::string_view column) {
        if (column.ends_with("_pixel")) check_pixels(column);
        if (column.ends_with("_direction")) check_directions(column);
        if (column.ends_with("_origin"))
            check_rows<Vec3>(column, "finite numbers", [](Vec3 v) { return trace::is_finite(v); });
        if (column.ends_with("_extent"))
            check_rows<float>(column, "a length that is not negative", [](float x) { return x >= 0; });
    }

    void check_walks() {
        struct Sum {
            std::uint64_t nodes = 0;
        };
        const WalkStore walks(trace_);
        tbb::enumerable_thread_specific<Sum> parts;
        run_all_walks(walks, parts, {}, [](Sum& sum, std::span<const std::uint32_t> elements) {
            sum.nodes += elements.size();
        });
        std::uint64_t nodes = 0;
        for (const Sum& sum : parts) nodes += sum.nodes;
        if (nodes != info_.visited_nodes)
            refuse("visited_nodes", info_.visited_nodes, fmt::format("{}, the nodes of all walks", nodes));
    }

    bool has_candidates() const { return trace_.has("candidate") || trace_.has("query_candidate_bytes"); }

    void check_candidates() {
        if (!has_candidates()) return;
        const std::span<const std::uint32_t> lengths = trace_.column<std::uint32_t>("query_candidate_bytes");
        const std::span<const std::uint8_t> bits = trace_.column<std::uint8_t>("candidate");
        const WalkStore walks(trace_);
        const spatial::Structure& structure = walks.structure();
        const auto decoder = structure.decoder();
        std::uint64_t at = 0, entered = 0;
        for (std::uint64_t q = 0; q < lengths.size(); ++q) {
            std::uint64_t looks = 0;
            spatial::for_each_look(structure, decoder->decode(walks.walk(q)).elements,
                                   [&looks](std::uint32_t) { ++looks; });
            if (lengths[q] != (looks + 7) / 8)
                refuse("query_candidate_bytes", q, text(lengths[q]),
                       fmt::format("{}, a bit for each of {} photons looked at", (looks + 7) / 8, looks));
            if (lengths[q] > bits.size() - at)
                refuse("candidate", bits.size(), "the end", "more bytes, as query_candidate_bytes has it");
            for (const std::uint8_t byte : bits.subspan(at, lengths[q]))
                entered += static_cast<std::uint64_t>(std::popcount(byte));
            at += lengths[q];
            if (looks % 8 != 0 && (bits[at - 1] & 0xff >> looks % 8) != 0)
                refuse("candidate", at - 1, fmt::format("{:08b}", bits[at - 1]),
                       fmt::format("zeros behind {} bits", looks % 8));
        }
        if (at != bits.size())
            refuse("candidate", at, "more bytes", "the end, as query_candidate_bytes has it");
        if (entered < info_.found_photons)
            refuse("found_photons", info_.found_photons,
                   fmt::format("at most {}, the photons that entered the list by candidate.npy", entered));
    }

    /// Rows of bytes, one behind the other.
    struct ByteRows {
        std::span<const std::uint32_t> lengths{};
        std::span<const std::uint8_t> bytes{};
    };
    /// That the rows in front are these; takes them away.
    void take_same(ByteRows& stored, const ByteRows& expected, std::uint64_t first, std::string_view column,
                   std::string_view what, const std::string& expectation) const {
        std::uint64_t at = 0;
        for (std::size_t i = 0; i < expected.lengths.size(); ++i) {
            const std::uint32_t length = stored.lengths[i];
            if (expected.lengths[i] != length ||
                !std::equal(expected.bytes.begin() + static_cast<std::ptrdiff_t>(at),
                            expected.bytes.begin() + static_cast<std::ptrdiff_t>(at + length),
                            stored.bytes.begin()))
                refuse(column, first + i, std::string(what), expectation);
            at += length;
            stored.bytes = stored.bytes.subspan(length);
        }
        stored.lengths = stored.lengths.subspan(expected.lengths.size());
    }

    void check_recall(std::string_view key, std::uint64_t expected) const {
        const trace::Json* const count = info_.counts.find(key);
        if (!count || *count != trace::Json(expected))
            refuse_field(trace_, fmt::format("counts.{}", key), count ? shown(*count) : "nothing",
                         fmt::format("{}, as the searches and exact ones find", expected));
    }

    spatial::Recording recorded(const spatial::PhotonSearch& search, std::span<const Vec3> points,
                                std::uint64_t first, float radius) {
        if (!trace_.has("query_normal")) return search.record(points, info_.k, radius, has_candidates());
        return spatial::record_facing(spatial::PhotonKd(trace_.column<trace::Photon>("photon")), points,
                                      trace_.column<Vec3>("query_normal").subspan(first, points.size()),
                                      radius);
    }

    void check_searches(const QueriesDone& progress) {
        const std::uint64_t most = info_.queries * std::min<std::uint64_t>(info_.k, info_.photons);
        if (info_.found_photons > most)
            refuse("found_photons", info_.found_photons, fmt::format("at most {}", most));
        const std::optional<float> radius = search_radius(trace_);
        if (!radius || !trace_.has("photon")) return;
        const auto search = spatial::build(spatial::parse_structure(info_.structure),
                                           trace_.column<trace::Photon>("photon"), info_.k, *radius);
        if (!search->structure()->same_as(*spatial::open_structure(trace_)))
            refuse(trace_.has("tree_child") ? "tree_child" : "element_parent", 0, "another structure",
                   "the one that " + info_.structure + " builds over the photons");
        if (const std::span<const std::uint32_t> places = search->photon_at(); !places.empty()) {
            const std::span<const std::uint32_t> stored = trace_.column<std::uint32_t>("tree_photon");
            const auto [at, other] =
                std::mismatch(stored.begin(), stored.end(), places.begin(), places.end());
            if (at != stored.end())
                refuse("tree_photon", static_cast<std::uint64_t>(at - stored.begin()), fmt::format("{}", *at),
                       fmt::format("{}", *other));
        }
        const std::span<const Vec3> positions = trace_.column<Vec3>("query_position");
        ByteRows walks{trace_.column<std::uint32_t>("query_walk_bytes"), trace_.column<std::uint8_t>("walk")};
        ByteRows candidates;
        if (has_candidates())
            candidates = {trace_.column<std::uint32_t>("query_candidate_bytes"),
                          trace_.column<std::uint8_t>("candidate")};
        const std::string search_for = fmt::format("the search for {} photons within {}", info_.k, *radius);
        std::uint64_t found = 0;
        std::optional<spatial::Recall> recall;
        constexpr std::uint64_t batch = 1 << 20;
        for (std::uint64_t first = 0; first < positions.size(); first += batch) {
            const std::span<const Vec3> points =
                positions.subspan(first, std::min(batch, positions.size() - first));
            const spatial::Recording again = recorded(*search, points, first, *radius);
            take_same(walks, {again.walk_bytes, again.walks}, first, "walk", "another walk",
                      "the one of " + search_for);
            if (has_candidates())
                take_same(candidates, {again.candidate_bytes, again.candidates}, first, "candidate",
                          "other bits", "those of " + search_for);
            found += again.found_photons;
            if (const auto part = search->recall(points, info_.k, *radius))
                recall = recall.value_or(spatial::Recall()) += *part;
            if (progress) progress(first + points.size());
        }
        if (found != info_.found_photons)
            refuse("found_photons", info_.found_photons, fmt::format("{}, as the searches find", found));
        if (recall) {
            check_recall(spatial::nearest_count, recall->nearest);
            check_recall(spatial::nearest_found_count, recall->found);
        }
        verified_.searched = true;
    }

    trace::TraceReader& trace_;
    const trace::TraceInfo& info_;
    bool is_of_rays_;
    Verified verified_;
};

}  // namespace

std::optional<float> search_radius(const trace::TraceReader& trace) {
    const trace::TraceInfo& info = trace.info();
    const MapParameters map = map_parameters(info);
    const trace::Json* const radius = map.object ? map.object->find("radius") : nullptr;
    const auto refuse = [&](std::string_view found) {
        refuse_field(trace, map.path + ".radius", found,
                     "the radius of the searches above 0, or null: unlimited");
    };
    if (!radius) {
        if (is_captured(info) || info.map != trace::map_names[0]) refuse("nothing");
        return std::nullopt;
    }
    if (radius->is_null()) return std::numeric_limits<float>::infinity();
    const auto length = static_cast<float>(radius->number());
    if (!(length > 0) || !std::isfinite(length)) refuse(shown(*radius));
    return length;
}

void refuse_normals(const trace::TraceReader& trace) {
    if (trace.has("query_normal"))
        throw trace::DataError(
            fmt::format("{}: found searches of the nearest record whose surface faces as the query's does, "
                        "expected searches of the k nearest photons, which can be run again elsewhere",
                        (trace.folder() / "query_normal.npy").string()));
}

Verified verify(trace::TraceReader& trace, const QueriesDone& progress) {
    return Verification(trace).run(progress);
}

}  // namespace regather::replay
