#include "experiment/traces/visits_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "experiment/traces/brought_queries.h"
#include "spatial/list_walk.h"
#include "spatial/listed_columns.h"
#include "spatial/photons/structures.h"
#include "trace/error.h"
#include "trace/folder.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> visit_columns{"visit_element",   "query_visits",   "element_bytes",
                                                        "element_address", "element_region", "element_level",
                                                        "element_parent"};
constexpr std::uint64_t most_visits = (std::uint64_t{1} << 29) - 1;  // so that a walk's bytes fit 32 bits

fs::path file_of(const fs::path& folder, std::string_view name) {
    return folder / fmt::format("{}.npy", name);
}

[[noreturn]] void refuse(const fs::path& file, std::uint64_t row, const std::string& found,
                         const std::string& expected) {
    throw trace::DataError(
        fmt::format("{}: row {}: found {}, expected {}", file.string(), row, found, expected));
}

/// How many visits each query has.
class VisitCounts {
public:
    VisitCounts(const fs::path& columns, std::uint64_t queries)
        : file_(file_of(columns, "query_visits")),
          column_(file_, trace::column_type<std::uint32_t>(), trace::column_type<std::uint64_t>()) {
        if (column_.size() != queries)
            throw trace::DataError(fmt::format("{}: found {} rows, expected {} as in query_position.npy",
                                               file_.string(), column_.size(), queries));
    }
    std::uint64_t operator[](std::uint64_t query) const {
        return column_.row_bytes() == 4 ? column_.rows<std::uint32_t>()[query]
                                        : column_.rows<std::uint64_t>()[query];
    }
    /// Together they are all visits there are.
    void check(std::uint64_t visits) const {
        std::uint64_t left = visits;
        for (std::uint64_t q = 0; q < column_.size(); ++q) {
            const std::uint64_t count = (*this)[q];
            if (count > left)
                refuse(file_, q, fmt::format("{}", count),
                       fmt::format("at most {}, what is left of the {} rows of visit_element.npy", left,
                                   visits));
            if (count > most_visits)
                refuse(file_, q, fmt::format("{}", count), fmt::format("at most {}", most_visits));
            left -= count;
        }
        if (left > 0)
            throw trace::DataError(
                fmt::format("{}: found {} visits in {} rows, expected {} as the rows of "
                            "visit_element.npy",
                            file_.string(), visits - left, column_.size(), visits));
    }

private:
    fs::path file_;
    trace::MappedColumn column_;
};

/// What was walked, numbered by region.
struct BroughtElements {
    spatial::Listed::Elements elements;
    std::vector<std::uint32_t> number;  ///< By the number that the columns give an element.
};

template <class T>
std::vector<T> in_order(std::span<const T> rows, std::span<const std::uint32_t> order) {
    std::vector<T> sorted;
    if (!rows.empty())
        for (const std::uint32_t e : order) sorted.push_back(rows[e]);
    return sorted;
}

template <class T>
std::vector<T> copied(std::span<const T> rows) {
    return {rows.begin(), rows.end()};
}

BroughtElements read_elements(const VisitsJob& job) {
    const fs::path& columns = job.columns;
    const trace::MappedColumn bytes_column(file_of(columns, "element_bytes"),
                                           trace::column_type<std::uint32_t>());
    const std::uint64_t count = bytes_column.size();
    if (count >= std::uint64_t{1} << 31)
        throw trace::DataError(fmt::format("{}: found {} rows, expected fewer than 2^31",
                                           file_of(columns, "element_bytes").string(), count));
    const BroughtColumn<std::uint64_t> address(columns, "element_address", count, "element_bytes");
    const BroughtColumn<std::uint32_t> region_column(columns, "element_region", count, "element_bytes"),
        level(columns, "element_level", count, "element_bytes"),
        parent(columns, "element_parent", count, "element_bytes");

    const std::span<const std::uint32_t> bytes = bytes_column.rows<std::uint32_t>();
    std::vector<std::uint32_t> region = copied(region_column.rows());
    if (region.empty()) region.assign(count, static_cast<std::uint32_t>(trace::Region::other));
    spatial::check_elements({.ranges = {},
                             .parent = copied(parent.rows()),
                             .level = copied(level.rows()),
                             .bytes = copied(bytes),
                             .address = copied(address.rows()),
                             .record_begin = {}},
                            region, job.allow_overlaps, columns);

    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return region[a] < region[b]; });
    BroughtElements brought;
    brought.number.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) brought.number[order[i]] = i;
    spatial::Listed::Elements& elements = brought.elements;
    elements.bytes = in_order(bytes, order);
    elements.address = in_order(address.rows(), order);
    elements.level = in_order(level.rows(), order);
    elements.parent = in_order(parent.rows(), order);
    for (std::uint32_t& above : elements.parent) above = brought.number[above];
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto own = static_cast<trace::Region>(region[order[i]]);
        if (elements.ranges.empty() || elements.ranges.back().region != own)
            elements.ranges.push_back({own, i, 0});
        ++elements.ranges.back().count;
    }
    return brought;
}

}  // namespace

bool brings_visits(const fs::path& columns) {
    std::error_code error;
    return fs::exists(file_of(columns, "visit_element"), error);
}

std::string run(const VisitsJob& job, const ProgressListener& progress) {
    std::error_code error;
    if (fs::exists(file_of(job.columns, "photon_position"), error))
        throw trace::DataError(
            fmt::format("{}: found photon_position.npy beside visit_element.npy, expected "
                        "photons to search or visits of a search",
                        job.columns.string()));
    refuse_unknown_columns(job.columns, visit_columns);
    if (job.allow_overlaps && !fs::exists(file_of(job.columns, "element_address"), error))
        throw trace::UsageError(
            fmt::format("--allow-overlaps: found {} without element_address.npy, expected addresses at which "
                        "elements may share bytes",
                        job.columns.string()));
    const BroughtQueries queries(job.columns);
    const fs::path visit_file = file_of(job.columns, "visit_element");
    const trace::MappedColumn visit_column(visit_file, trace::column_type<std::uint32_t>());
    const std::span<const std::uint32_t> visits = visit_column.rows<std::uint32_t>();
    const VisitCounts counts(job.columns, queries.positions().size());
    counts.check(visits.size());
    BroughtElements brought = read_elements(job);
    const std::vector<std::uint32_t>& number = brought.number;
    for (std::uint64_t v = 0; v < visits.size(); ++v)
        if (visits[v] >= number.size())
            refuse(visit_file, v, fmt::format("{}", visits[v]),
                   fmt::format("an element below {}, the rows of element_bytes.npy", number.size()));

    trace::TraceWriter writer(job.folder, job.force);  // from here on an earlier trace is gone
    trace::TraceInfo info;
    queries.store(writer, info, job.width);
    info.left_out.push_back({"photon", "the walks were brought as visits"});
    const spatial::StructureSpec spec = spatial::parse_structure(spatial::brought_structure);
    const spatial::Listed structure(spec.text, std::move(brought.elements));
    spatial::store_elements(writer, structure);
    info.structure = spec.text;
    info.structure_version = spec.entry->version;
    if (job.allow_overlaps) info.parameters["overlaps"] = true;

    constexpr std::uint64_t batch = 1 << 16;
    spatial::ListWalkRecorder recorder;
    std::vector<std::uint32_t> walk_bytes;
    std::uint64_t next = 0;
    const auto flush = [&] {
        writer.column("query_walk_bytes").append(std::span<const std::uint32_t>(walk_bytes));
        writer.column("walk").append(recorder.bytes());
        walk_bytes.clear();
        info.visited_nodes += recorder.visited_nodes();
        recorder.clear();
    };
    for (std::uint64_t q = 0; q < info.queries; ++q) {
        for (const std::uint32_t element : visits.subspan(next, counts[q])) recorder.visit(number[element]);
        next += counts[q];
        walk_bytes.push_back(recorder.finish());
        if ((q + 1) % batch != 0) continue;
        flush();
        if (progress) progress("recording walks", "queries", q + 1, info.queries);
    }
    flush();
    writer.finish(info);
    return fmt::format("{} elements, {} queries, {} elements visited\ntrace: {}\n", structure.end(),
                       info.queries, info.visited_nodes, job.folder.string());
}

}  // namespace regather::experiment
