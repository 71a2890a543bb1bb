#include "trace/folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>

#include "trace/digest.h"
#include "trace/field.h"
#include "trace/file.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::trace {
namespace {

namespace fs = std::filesystem;

constexpr ColumnEntry table[] = {
    {"photon", "photon", "see docs/trace_format.md",
     "photons in heap order of the left-balanced kd-tree; split axis and surface normal are in the flags",
     column_type<Photon>, true},
    {"tree_child", "tree_child", "element",
     "the children of each inner node of a tree with leaves, as many rows a node as it can have, 0: none; "
     "elements are the inner nodes, then the leaves",
     column_type<std::uint32_t>, false},
    {"tree_leaf_begin", "tree_leaf_begin", "place",
     "where the photons or triangles of each leaf begin, and their number", column_type<std::uint32_t>,
     false},
    {"tree_photon", "photon", "row of photon", "which photon lies at each place of the leaves",
     column_type<std::uint32_t>, false},
    {"element_bytes", "element", "bytes", "what each element of brought walks takes",
     column_type<std::uint32_t>, false},
    {"element_address", "element", "bytes", "where each element lay in the program that was walked",
     column_type<std::uint64_t>, false},
    {"element_region", "element", "number in the table of regions",
     "what each element is; those of a region stand together", column_type<std::uint32_t>, false},
    {"element_level", "element", "1", "steps from where a search begins", column_type<std::uint32_t>, false},
    {"element_parent", "element", "element", "what each element hangs below; itself: nothing",
     column_type<std::uint32_t>, false},
    {"tree_triangle", "tree_triangle", "triangle of the scene",
     "which triangle lies at each place of the leaves", column_type<std::uint32_t>, false},
    {"query_position", "query", "scene units", "where the k nearest photons are asked for", column_type<Vec3>,
     true},
    {"query_pixel", "query", "y * image_width + x", "the pixel that the answer belongs to",
     column_type<std::uint32_t>, true},
    {"query_weight", "query", "1", "RGB factor of the answer in the pixel's sum", column_type<Vec3>, false},
    {"query_direction", "query", "unit vector", "travel direction of the gather ray that ended here",
     column_type<Vec3>, false},
    {"query_end", "query", "scene units",
     "where a ray ends: at the hit, at its extent, or where it leaves the scene's box", column_type<Vec3>,
     false},
    {"query_guess", "query", "scene units", "where a ray ends among the scene's largest triangles alone",
     column_type<Vec3>, false},
    {"query_leaf_kd", "query", "leaf number, depth-first",
     "leaf of a kd-tree over the triangles that the hit lies in", column_type<std::uint32_t>, false},
    {"query_leaf_bvh", "query", "leaf number, depth-first",
     "leaf of a BVH over the triangles that holds the triangle hit", column_type<std::uint32_t>, false},
    {"query_stratum", "query", "65536ths of the unit square's edges",
     "middle of the stratum that the gather ray was drawn from: rows x 65536 + columns",
     column_type<std::uint32_t>, false},
    {"query_normal", "query", "unit vector",
     "which way the surface faces that the nearest record of irradiance is looked up for", column_type<Vec3>,
     false},
    {"query_walk_bytes", "query", "bytes", "length of the query's walk", column_type<std::uint32_t>, true},
    {"walk", "walk", "bits", "the walks one after the other, each starting on a byte",
     column_type<std::uint8_t>, true},
    {"query_candidate_bytes", "query", "bytes", "length of the query's bits in candidate",
     column_type<std::uint32_t>, false},
    {"candidate", "candidate", "bits",
     "for each photon that a walk looked at, whether it entered the list of the k nearest so far",
     column_type<std::uint8_t>, false},
#define REGATHER_RAY_COLUMNS(kind, meaning)                                                               \
    {"ray_" kind "_origin", "ray_" kind, "scene units", "origins of " meaning, column_type<Vec3>, false}, \
        {"ray_" kind "_direction", "ray_" kind,       "unit vector",                                      \
         "directions of " meaning, column_type<Vec3>, false},                                             \
        {"ray_" kind "_extent", "ray_" kind,                                                              \
         "scene units",         "how far the ray is asked for, may be infinite; " meaning,                \
         column_type<float>,    false},                                                                   \
    {                                                                                                     \
        "ray_" kind "_pixel", "ray_" kind, "y * image_width + x", "the pixels of " meaning,               \
            column_type<std::uint32_t>, false                                                             \
    }
    REGATHER_RAY_COLUMNS("eye", "eye rays"),
    REGATHER_RAY_COLUMNS("specular", "rays that continue an eye or a gather ray at a specular surface"),
    REGATHER_RAY_COLUMNS("shadow", "shadow rays towards points on area lights"),
    REGATHER_RAY_COLUMNS("gather", "final gather rays"),
#undef REGATHER_RAY_COLUMNS
};

constexpr std::uint64_t most_json_bytes = 16 << 20;  // a trace.json has some thousand

fs::path column_path(const fs::path& folder, std::string_view name) {
    return folder / fmt::format("{}.npy", name);
}

constexpr bool required = true, optional = false;
constexpr std::string_view count = "a whole number that is not negative",
                           from_one = "a whole number from 1 up",
                           pixels = "a whole number of pixels from 1 up";

const Kind trace_kind{"trace",
                      {{"regather_trace", required, "the version of the format"},
                       {"scene", required, "the name of the scene"},
                       {"image_width", required, pixels},
                       {"image_height", required, pixels},
                       {"map", optional, "the name of a photon map"},
                       {"frame", optional, count},
                       {"k", required, from_one},
                       {"seed", required, count},
                       {"structure", required, "the name of a structure"},
                       {"structure_version", required, from_one},
                       {"queries", required, count},
                       {"photons", required, count},
                       {"found_photons", required, count},
                       {"visited_nodes", required, count},
                       {"parameters", required, "an object"},
                       {"counts", required, "an object"},
                       {"left_out", required, "a list of what was left out, and why"},
                       {"columns", required, "an object of columns by name"}}};
const Kind left_out_kind{"entry of left_out", {{"what", required, "a text"}, {"why", required, "a text"}}};
const Kind column_kind{"column",
                       {{"rows", required, count},
                        {"type", required, "the type of the column"},
                        {"xxh3_64", required, "16 hexadecimal digits"}}};

std::uint64_t whole(const Field& object, std::string_view key, std::uint64_t least = 0,
                    std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
    return object[key].whole<std::uint64_t>(least, most, trace_kind.key(key).expected);
}
std::uint32_t small(const Field& object, std::string_view key, std::uint32_t least) {
    return static_cast<std::uint32_t>(whole(object, key, least, std::numeric_limits<std::uint32_t>::max()));
}
const Json& object_at(const Field& root, std::string_view key) {
    const Field field = root[key];
    if (!field.value().is_object()) field.fail(field.found(), "an object");
    return field.value();
}

ColumnDigest digest_of(const Field& column, const ColumnEntry& entry) {
    column.check(column_kind);
    ColumnDigest digest;
    digest.rows = column["rows"].whole<std::uint64_t>(0, std::numeric_limits<std::uint64_t>::max(), count);
    if (const std::string_view type = entry.type().readable; column["type"].text() != type)
        column["type"].fail(column["type"].found(), in_quotes(type));
    const Field checksum = column["xxh3_64"];
    const std::string& text = checksum.text("16 hexadecimal digits");
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), digest.checksum, 16);
    if (text.size() != 16 || error != std::errc{} || end != text.data() + text.size())
        checksum.fail(checksum.found(), "16 hexadecimal digits");
    return digest;
}

/// Of a trace's folder.
std::string trace_json(const fs::path& folder) {
    const fs::path file = folder / "trace.json";
    std::error_code error;
    if (!fs::exists(file, error)) {
        if (!fs::is_directory(folder, error))
            throw DataError(fmt::format("{}: found no such folder, expected a trace",
                                        shown(folder.string(), most_shown_path)));
        throw DataError(fmt::format(
            "{}: found no trace.json, expected a finished trace (was the capture interrupted? capture again)",
            shown(folder.string(), most_shown_path)));
    }
    return read_file(file, most_json_bytes);
}

}  // namespace

std::span<const ColumnEntry> column_table() {
    return table;
}

const ColumnEntry& column_entry(std::string_view name) {
    for (const ColumnEntry& entry : table)
        if (entry.name == name) return entry;
    throw UsageError(fmt::format("no trace column is called '{}'", shown(name)));
}

TraceWriter::TraceWriter(fs::path folder, bool force) : folder_(std::move(folder)), lock_(folder_) {
    std::set<std::string> known{"trace.json", "trace.json.partial"};
    for (const ColumnEntry& entry : table) known.insert(fmt::format("{}.npy", entry.name));
    for (const auto& file : fs::directory_iterator(folder_))
        if (!known.contains(file.path().filename().string()))
            throw UsageError(fmt::format("{}: found '{}', expected an empty folder or an earlier trace",
                                         shown(folder_.string(), most_shown_path),
                                         shown(file.path().filename().string())));
    if (fs::exists(folder_ / "trace.json")) {
        if (!force)
            throw UsageError(fmt::format("{}: holds a finished trace; --force overwrites it",
                                         shown(folder_.string(), most_shown_path)));
        fs::remove(folder_ / "trace.json");
    }
    for (const std::string& name : known) fs::remove(folder_ / name);
}

ColumnWriter& TraceWriter::column(std::string_view name) {
    auto found = writers_.find(name);
    if (found == writers_.end())
        found =
            writers_.emplace(name, ColumnWriter(column_path(folder_, name), column_entry(name).type())).first;
    return found->second;
}

void TraceWriter::finish(const TraceInfo& info) {
    Json columns = Json::object();
    for (auto& [name, writer] : writers_) {
        const ColumnDigest digest = writer.finish();
        columns[name] = Json::object({{"rows", digest.rows},
                                      {"type", column_entry(name).type().readable},
                                      {"xxh3_64", hexadecimal(digest.checksum)}});
    }
    Json::List left_out;
    for (const LeftOut& entry : info.left_out)
        left_out.push_back(Json::object({{"what", entry.what}, {"why", entry.why}}));
    Json root = Json::object({{"regather_trace", schema_version},
                              {"scene", info.scene},
                              {"map", info.map},
                              {"image_width", info.image_width},
                              {"image_height", info.image_height},
                              {"k", info.k},
                              {"seed", info.seed},
                              {"structure", info.structure},
                              {"structure_version", info.structure_version},
                              {"queries", info.queries},
                              {"photons", info.photons},
                              {"found_photons", info.found_photons},
                              {"visited_nodes", info.visited_nodes}});
    if (info.frame) root["frame"] = *info.frame;
    root["parameters"] = info.parameters;
    root["counts"] = info.counts;
    root["left_out"] = std::move(left_out);
    root["columns"] = std::move(columns);
    write_whole(folder_ / "trace.json", root.dump(2) + "\n");
}

TraceReader::TraceReader(fs::path folder) : folder_(std::move(folder)) {
    const fs::path file = folder_ / "trace.json";
    const Document document(trace_json(folder_), file.string());
    const Field root = document.root();
    if (const std::optional<Field> version = root.get("regather_trace");
        version && version->value() != Json(schema_version))
        version->fail("version " + version->found(),
                      fmt::format("{}; capture the scene again", schema_version));
    root.check(trace_kind);
    info_.scene = root["scene"].text();
    info_.image_width = small(root, "image_width", 1);
    info_.image_height = small(root, "image_height", 1);
    if (root.has("map")) info_.map = map_names[root["map"].word(map_names)];
    if (root.has("frame")) info_.frame = small(root, "frame", 0);
    info_.k = small(root, "k", 0);
    info_.seed = whole(root, "seed");
    info_.structure = root["structure"].text();
    info_.structure_version = small(root, "structure_version", 1);
    info_.queries = whole(root, "queries");
    info_.photons = whole(root, "photons");
    info_.found_photons = whole(root, "found_photons");
    info_.visited_nodes = whole(root, "visited_nodes");
    info_.parameters = object_at(root, "parameters");
    info_.counts = object_at(root, "counts");
    for (const Field& entry : root["left_out"].elements()) {
        entry.check(left_out_kind);
        info_.left_out.push_back({entry["what"].text(), entry["why"].text()});
    }
    read_columns(root["columns"]);
    if (info_.k == 0 && digests_.contains("photon")) root["k"].fail("0", from_one);
    const auto expect_rows = [&](std::string_view name, std::string_view total, std::uint64_t rows) {
        const auto digest = digests_.find(std::string(name));
        if (const std::uint64_t found = digest == digests_.end() ? 0 : digest->second.rows; found != rows)
            root[total].fail(fmt::format("{}", rows), fmt::format("{} as the rows of {}", found, name));
    };
    expect_rows("query_position", "queries", info_.queries);
    expect_rows("photon", "photons", info_.photons);
    for (const auto& [name, digest] : digests_) {
        const fs::path path = column_path(folder_, name);
        MappedColumn column(path, column_entry(name).type());
        if (column.size() != digest.rows)
            throw DataError(fmt::format("{}: found {} rows, expected {} as in trace.json", path.string(),
                                        column.size(), digest.rows));
        mapped_.emplace(name, std::move(column));
    }
}

void TraceReader::read_columns(const Field& columns) {
    std::vector<std::string_view> names;
    for (const ColumnEntry& entry : table) names.push_back(entry.name);
    std::map<std::string_view, std::pair<std::string, std::uint64_t>> group_rows;
    for (const auto& [name, column] : columns.members()) {
        if (std::find(names.begin(), names.end(), name) == names.end())
            column.fail("unknown column " + in_quotes(name), alternatives(nearest_words(name, names)));
        const ColumnEntry& entry = column_entry(name);
        const ColumnDigest digest = digest_of(column, entry);
        const auto [group, first] = group_rows.try_emplace(entry.group, name, digest.rows);
        if (!first && group->second.second != digest.rows)
            column["rows"].fail(fmt::format("{}", digest.rows),
                                fmt::format("{} as in {}", group->second.second, group->second.first));
        digests_[name] = digest;
    }
    for (const ColumnEntry& entry : table)
        if (entry.required && !digests_.contains(std::string(entry.name)) &&
            (entry.name != "photon" || info_.k > 0))
            columns.fail(fmt::format("no {}", entry.name), "every required column");
}

const MappedColumn& TraceReader::open(std::string_view name, const ColumnType& type) {
    const fs::path path = column_path(folder_, name);
    const auto digest = digests_.find(std::string(name));
    if (digest == digests_.end()) {
        std::string why = "it was not captured: capture the scene again";
        if (name == "query_end" || name == "query_guess")
            why = "rays have it: regather walk TRACE --rays KIND";
        if (name == "query_candidate_bytes" || name == "candidate")
            why = "searches tell it: regather walk TRACE --candidates";
        for (const LeftOut& entry : info_.left_out)
            if (entry.what == name) why = entry.why;
        throw DataError(fmt::format("{}: found no such column ({}), expected {}",
                                    shown(path.string(), most_shown_path), shown(why, 200), type.readable));
    }
    const MappedColumn& column = mapped_.find(name)->second;
    if (verified_.contains(name)) return column;
    if (const std::uint64_t checksum = column.checksum(); checksum != digest->second.checksum)
        throw DataError(fmt::format("{}: found checksum {}, expected {} as in trace.json", path.string(),
                                    hexadecimal(checksum), hexadecimal(digest->second.checksum)));
    verified_.emplace(name);
    return column;
}

std::span<const std::byte> TraceReader::bytes(std::string_view name) {
    return open(name, column_entry(name).type()).bytes();
}

void TraceReader::verify_all() {
    for (const auto& [name, digest] : digests_) open(name, column_entry(name).type());
}

std::string TraceReader::checksum() const {
    std::string text;
    for (const auto& [name, digest] : digests_)
        text += fmt::format("{} {} {}\n", name, digest.rows, hexadecimal(digest.checksum));
    return digest_of(text);
}

void TraceReader::expect_random_access(std::string_view name) {
    open(name, column_entry(name).type()).expect_random_access();
}

}  // namespace regather::trace
