#include "trace/folder.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <charconv>
#include <set>

#include "trace/file.h"

namespace regather::trace {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr ColumnEntry table[] = {
    {"photon", "photon", "see docs/trace_format.md",
     "photons in heap order of the left-balanced kd-tree; split axis and surface normal are in the flags",
     column_type<Photon>, true},
    {"query_position", "query", "scene units", "where the k nearest photons are asked for", column_type<Vec3>,
     true},
    {"query_pixel", "query", "y * image_width + x", "the pixel that the answer belongs to",
     column_type<std::uint32_t>, true},
    {"query_weight", "query", "1", "RGB factor of the answer in the pixel's sum", column_type<Vec3>, false},
    {"query_direction", "query", "unit vector", "travel direction of the gather ray that ended here",
     column_type<Vec3>, false},
    {"query_leaf_kd", "query", "leaf number, depth-first",
     "leaf of a kd-tree over the triangles that the hit lies in", column_type<std::uint32_t>, false},
    {"query_leaf_bvh", "query", "leaf number, depth-first",
     "leaf of a BVH over the triangles that holds the triangle hit", column_type<std::uint32_t>, false},
    {"query_walk_bytes", "query", "bytes", "length of the query's walk", column_type<std::uint32_t>, true},
    {"walk", "walk", "bits", "the walks one after the other, each starting on a byte",
     column_type<std::uint8_t>, true},
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

std::string hexadecimal(std::uint64_t value) {
    return fmt::format("{:016x}", value);
}

fs::path column_path(const fs::path& folder, std::string_view name) {
    return folder / fmt::format("{}.npy", name);
}

class JsonField {
public:
    JsonField(const fs::path& file, const json& object, std::string_view field) : file_(file), field_(field) {
        const auto found = object.is_object() ? object.find(field) : object.end();
        if (!object.is_object() || found == object.end()) refuse("nothing", "a value");
        value_ = &*found;
    }
    [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
        throw DataError(
            fmt::format("{}: {}: found {}, expected {}", file_.string(), field_, found, expected));
    }
    std::uint64_t unsigned_number() const {
        if (!value_->is_number_unsigned()) refuse(value_->dump(), "a whole number that is not negative");
        return value_->get<std::uint64_t>();
    }
    std::uint32_t small_number() const {
        const std::uint64_t number = unsigned_number();
        if (number > 0xffffffffu) refuse(value_->dump(), "a number below 2^32");
        return static_cast<std::uint32_t>(number);
    }
    std::string text() const {
        if (!value_->is_string()) refuse(value_->dump(), "a text");
        return value_->get<std::string>();
    }
    const json& object() const {
        if (!value_->is_object()) refuse(value_->dump(), "an object");
        return *value_;
    }
    const json& list() const {
        if (!value_->is_array()) refuse(value_->dump(), "a list");
        return *value_;
    }

private:
    const fs::path& file_;
    std::string_view field_;
    const json* value_ = nullptr;
};

}  // namespace

std::span<const ColumnEntry> column_table() {
    return table;
}

const ColumnEntry& column_entry(std::string_view name) {
    for (const ColumnEntry& entry : table)
        if (entry.name == name) return entry;
    throw UsageError(fmt::format("no trace column is called '{}'", name));
}

TraceWriter::TraceWriter(fs::path folder, bool force) : folder_(std::move(folder)) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error || !fs::is_directory(folder_))
        throw std::runtime_error(
            fmt::format("{}: cannot create the folder: {}", folder_.string(), error.message()));
    std::set<std::string> known{"trace.json", "trace.json.partial"};
    for (const ColumnEntry& entry : table) known.insert(fmt::format("{}.npy", entry.name));
    for (const auto& file : fs::directory_iterator(folder_))
        if (!known.contains(file.path().filename().string()))
            throw UsageError(fmt::format("{}: found '{}', expected an empty folder or an earlier trace",
                                         folder_.string(), file.path().filename().string()));
    if (fs::exists(folder_ / "trace.json")) {
        if (!force)
            throw UsageError(
                fmt::format("{}: holds a finished trace; --force overwrites it", folder_.string()));
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
    json columns = json::object();
    for (auto& [name, writer] : writers_) {
        const ColumnDigest digest = writer.finish();
        columns[name] = {{"rows", digest.rows},
                         {"type", column_entry(name).type().readable},
                         {"xxh3_64", hexadecimal(digest.checksum)}};
    }
    json left_out = json::array();
    for (const LeftOut& entry : info.left_out) left_out.push_back({{"what", entry.what}, {"why", entry.why}});
    json root{{"regather_trace", schema_version},
              {"scene", info.scene},
              {"image_width", info.image_width},
              {"image_height", info.image_height},
              {"map", info.map},
              {"k", info.k},
              {"seed", info.seed},
              {"structure", info.structure},
              {"queries", info.queries},
              {"photons", info.photons},
              {"found_photons", info.found_photons},
              {"visited_nodes", info.visited_nodes},
              {"parameters", info.parameters},
              {"counts", info.counts},
              {"left_out", left_out},
              {"columns", columns}};
    if (info.frame) root["frame"] = *info.frame;
    write_whole(folder_ / "trace.json", root.dump(2) + "\n");
}

TraceReader::TraceReader(fs::path folder) : folder_(std::move(folder)) {
    const fs::path file = folder_ / "trace.json";
    if (!fs::exists(file)) {
        if (!fs::is_directory(folder_))
            throw DataError(fmt::format("{}: found no such folder, expected a trace", folder_.string()));
        throw DataError(
            fmt::format("{}: found no trace.json, expected a finished trace (was the capture interrupted? "
                        "capture again)",
                        folder_.string()));
    }
    json root;
    try {
        root = json::parse(read_file(file));
    } catch (const json::exception& error) {
        throw DataError(fmt::format("{}: found no valid JSON ({})", file.string(), error.what()));
    }
    const auto field = [&](std::string_view name) { return JsonField(file, root, name); };
    const std::uint64_t version = field("regather_trace").unsigned_number();
    if (version != schema_version)
        throw DataError(
            fmt::format("{}: regather_trace: found version {}, expected {}; capture the scene again",
                        file.string(), version, schema_version));
    info_.scene = field("scene").text();
    info_.image_width = field("image_width").small_number();
    info_.image_height = field("image_height").small_number();
    if (root.contains("map")) info_.map = field("map").text();
    if (root.contains("frame")) info_.frame = field("frame").small_number();
    info_.k = field("k").small_number();
    info_.seed = field("seed").unsigned_number();
    info_.structure = field("structure").text();
    info_.queries = field("queries").unsigned_number();
    info_.photons = field("photons").unsigned_number();
    info_.found_photons = field("found_photons").unsigned_number();
    info_.visited_nodes = field("visited_nodes").unsigned_number();
    info_.parameters = field("parameters").object();
    info_.counts = field("counts").object();
    for (const json& entry : field("left_out").list())
        info_.left_out.push_back(
            {JsonField(file, entry, "what").text(), JsonField(file, entry, "why").text()});

    std::map<std::string_view, std::pair<std::string, std::uint64_t>> group_rows;
    for (const auto& [name, value] : field("columns").object().items()) {
        const ColumnEntry* entry = nullptr;
        for (const ColumnEntry& candidate : table)
            if (candidate.name == name) entry = &candidate;
        if (!entry)
            throw DataError(fmt::format("{}: columns: found '{}', expected a column of docs/trace_format.md",
                                        file.string(), name));
        ColumnDigest digest;
        digest.rows = JsonField(file, value, "rows").unsigned_number();
        const JsonField checksum(file, value, "xxh3_64");
        const std::string text = checksum.text();
        const auto [end, error] =
            std::from_chars(text.data(), text.data() + text.size(), digest.checksum, 16);
        if (text.size() != 16 || error != std::errc{} || end != text.data() + text.size())
            checksum.refuse('"' + text + '"', "16 hexadecimal digits");
        const auto [group, first] = group_rows.try_emplace(entry->group, name, digest.rows);
        if (!first && group->second.second != digest.rows)
            throw DataError(fmt::format("{}: columns.{}.rows: found {}, expected {} as in {}", file.string(),
                                        name, digest.rows, group->second.second, group->second.first));
        digests_[name] = digest;
    }
    for (const ColumnEntry& entry : table)
        if (entry.required && !digests_.contains(std::string(entry.name)))
            throw DataError(fmt::format("{}: columns: found no {}, expected every required column",
                                        file.string(), entry.name));
    const auto expect_rows = [&](std::string_view name, std::string_view total, std::uint64_t rows) {
        const std::uint64_t found = digests_.at(std::string(name)).rows;
        if (found != rows)
            throw DataError(fmt::format("{}: {}: found {}, expected {} as the rows of {}", file.string(),
                                        total, rows, found, name));
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

const MappedColumn& TraceReader::open(std::string_view name, const ColumnType& type) {
    const fs::path path = column_path(folder_, name);
    const auto digest = digests_.find(std::string(name));
    if (digest == digests_.end()) {
        std::string why = "it was not captured";
        for (const LeftOut& entry : info_.left_out)
            if (entry.what == name) why = entry.why;
        throw DataError(
            fmt::format("{}: found no such column ({}), expected {}", path.string(), why, type.readable));
    }
    const MappedColumn& column = mapped_.find(name)->second;
    if (verified_.contains(name)) return column;
    if (const std::uint64_t checksum = column.checksum(); checksum != digest->second.checksum)
        throw DataError(fmt::format("{}: found checksum {}, expected {} as in trace.json", path.string(),
                                    hexadecimal(checksum), hexadecimal(digest->second.checksum)));
    verified_.emplace(name);
    return column;
}

void TraceReader::verify_all() {
    for (const auto& [name, digest] : digests_) open(name, column_entry(name).type());
}

std::string TraceReader::checksum() const {
    std::string text;
    for (const auto& [name, digest] : digests_)
        text += fmt::format("{} {} {}\n", name, digest.rows, hexadecimal(digest.checksum));
    return hexadecimal(XXH3_64bits(text.data(), text.size()));
}

void TraceReader::expect_random_access(std::string_view name) {
    open(name, column_entry(name).type()).expect_random_access();
}

}  // namespace regather::trace
