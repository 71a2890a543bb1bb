#include "experiment/trace_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "spatial/photons/photon_kd.h"
#include "spatial/photons/structures.h"
#include "trace/error.h"
#include "trace/folder.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;
using trace::Vec3;

/// A column of the folder that may be missing.
template <class T>
struct OptionalColumn {
    OptionalColumn(const fs::path& folder, const char* name, std::uint64_t rows) {
        const fs::path path = folder / fmt::format("{}.npy", name);
        if (!fs::exists(path)) return;
        file.push_back(trace::MappedColumn(path, trace::column_type<T>()));
        if (file.front().size() != rows)
            throw trace::DataError(fmt::format("{}: found {} rows, expected {} as in query_position.npy",
                                               path.string(), file.front().size(), rows));
    }
    bool exists() const { return !file.empty(); }
    std::span<const T> rows() const { return file.front().template rows<T>(); }
    std::vector<trace::MappedColumn> file;
};

template <class T>
void copy(trace::TraceWriter& writer, const char* name, const OptionalColumn<T>& column) {
    if (column.exists()) writer.column(name).append(column.rows());
}

/// A column that nobody reads is one whose name is misspelt.
void refuse_unknown_columns(const fs::path& folder) {
    static constexpr std::array<std::string_view, 7> known{
        "photon_position", "query_position", "query_pixel",   "query_weight",
        "query_direction", "query_leaf_kd",  "query_leaf_bvh"};
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().stem().string();
        if (entry.path().extension() == ".npy" && std::find(known.begin(), known.end(), name) == known.end())
            throw trace::DataError(fmt::format("{}: found an unknown column {}, expected {} (known: {})",
                                               folder.string(), trace::in_quotes(name),
                                               trace::alternatives(trace::nearest_words(name, known)),
                                               trace::listed(known)));
    }
}

/// Without a column each query is a pixel of its own.
std::uint32_t greatest_pixel(const fs::path& columns, const OptionalColumn<std::uint32_t>& pixel,
                             std::uint64_t queries) {
    constexpr std::uint32_t most =
        std::numeric_limits<std::uint32_t>::max() - 1;  // so that an image width is one more
    if (!pixel.exists()) return queries == 0 ? 0 : static_cast<std::uint32_t>(queries - 1);
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < pixel.rows().size(); ++i) {
        last = std::max(last, pixel.rows()[i]);
        if (last > most)
            throw trace::DataError(fmt::format("{}: row {}: found {}, expected at most {}",
                                               (columns / "query_pixel.npy").string(), i, last, most));
    }
    return last;
}

}  // namespace

std::string run(const TraceJob& job, const ProgressListener& progress) {
    const spatial::StructureSpec spec = spatial::parse_structure(job.structure);
    refuse_unknown_columns(job.columns);
    const trace::MappedColumn photon_positions(job.columns / "photon_position.npy",
                                               trace::column_type<Vec3>());
    const trace::MappedColumn positions(job.columns / "query_position.npy", trace::column_type<Vec3>());
    const std::uint64_t queries = positions.size();
    const OptionalColumn<std::uint32_t> pixel(job.columns, "query_pixel", queries);
    const OptionalColumn<Vec3> weight(job.columns, "query_weight", queries);
    const OptionalColumn<Vec3> direction(job.columns, "query_direction", queries);
    const OptionalColumn<std::uint32_t> leaf_kd(job.columns, "query_leaf_kd", queries);
    const OptionalColumn<std::uint32_t> leaf_bvh(job.columns, "query_leaf_bvh", queries);
    if (queries >= std::numeric_limits<std::uint32_t>::max())
        throw trace::DataError(fmt::format("{}: found {} rows, expected fewer than 2^32 - 1",
                                           (job.columns / "query_position.npy").string(), queries));

    std::vector<trace::Photon> photons(photon_positions.size());
    for (std::size_t i = 0; i < photons.size(); ++i) {
        photons[i].position = photon_positions.rows<Vec3>()[i];
        if (!trace::is_finite(photons[i].position))
            throw trace::DataError(fmt::format("{}: row {}: found {} {} {}, expected finite numbers",
                                               (job.columns / "photon_position.npy").string(), i,
                                               photons[i].position.x, photons[i].position.y,
                                               photons[i].position.z));
    }
    const std::uint32_t last_pixel = greatest_pixel(job.columns, pixel, queries);
    const std::vector<trace::Photon> heap = spatial::left_balanced(photons);

    trace::TraceWriter writer(job.folder, job.force);  // from here on an earlier trace is gone
    writer.column("photon").append(std::span<const trace::Photon>(heap));
    writer.column("query_position").append(positions.rows<Vec3>());
    copy(writer, "query_weight", weight);
    copy(writer, "query_direction", direction);
    copy(writer, "query_leaf_kd", leaf_kd);
    copy(writer, "query_leaf_bvh", leaf_bvh);

    trace::TraceInfo info;
    if (pixel.exists()) {
        copy(writer, "query_pixel", pixel);
    } else {
        std::vector<std::uint32_t> own(queries);
        for (std::size_t i = 0; i < own.size(); ++i) own[i] = static_cast<std::uint32_t>(i);
        writer.column("query_pixel").append(std::span<const std::uint32_t>(own));
    }
    info.image_width = job.width > 0 ? job.width : last_pixel + 1;
    info.image_height = last_pixel / info.image_width + 1;

    const float radius =
        job.radius > 0 ? static_cast<float>(job.radius) : std::numeric_limits<float>::infinity();
    const auto search = spatial::build(spec, heap, job.k, radius);
    search->store(writer);
    info.structure = spec.text;
    info.structure_version = spec.entry->version;
    constexpr std::uint64_t batch = 1 << 20;
    for (std::uint64_t first = 0; first < queries || first == 0; first += batch) {
        const auto points = positions.rows<Vec3>().subspan(first, std::min(batch, queries - first));
        const spatial::Recording walks = search->record(points, job.k, radius);
        writer.column("query_walk_bytes").append(std::span<const std::uint32_t>(walks.walk_bytes));
        writer.column("walk").append(std::span<const std::uint8_t>(walks.walks));
        info.found_photons += walks.found_photons;
        info.visited_nodes += walks.visited_nodes;
        if (progress) progress("recording walks", "queries", first + points.size(), queries);
    }
    info.scene = fs::weakly_canonical(job.columns).filename().string();
    info.k = job.k;
    info.queries = queries;
    info.photons = heap.size();
    info.parameters["radius"] = std::isfinite(radius) ? trace::Json(job.radius) : trace::Json();
    info.parameters["k"] = job.k;
    const auto note = [&](const char* name, bool exists) {
        if (!exists) info.left_out.push_back({name, "it was not among the columns given"});
    };
    note("query_weight", weight.exists());
    note("query_direction", direction.exists());
    note("query_leaf_kd", leaf_kd.exists());
    note("query_leaf_bvh", leaf_bvh.exists());
    writer.finish(info);
    return fmt::format("{} photons, {} queries, {} nodes visited\ntrace: {}\n", info.photons, info.queries,
                       info.visited_nodes, job.folder.string());
}

}  // namespace regather::experiment
