// trace/folder.h -- a trace: a folder with one .npy file per column and a trace.json that is written last, by
// an atomic rename. A folder without trace.json is an unfinished capture. Every column, with type and unit:
// docs/trace_format.md.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trace/folder_lock.h"
#include "trace/json.h"
#include "trace/npy.h"

namespace regather::trace {

class Field;

inline constexpr int schema_version = 2;

/// The columns that a trace can have; columns of one group have the same number of rows.
struct ColumnEntry {
    std::string_view name, group, unit, meaning;
    const ColumnType& (*type)();
    bool required;  ///< By replay; the others may have been left out. `photon` where k is above 0.
};
std::span<const ColumnEntry> column_table();
const ColumnEntry& column_entry(std::string_view name);  ///< UsageError for an unknown name.

/// What is searched: the photon maps of a capture; "guide" is the global map, asked where gather rays should
/// go, "precompute" the global map, asked for the irradiance at photons, and "precomputed" the records of it;
/// "hits" search nothing: photons search them.
inline constexpr std::array<std::string_view, 6> map_names{"global",     "caustic",     "guide",
                                                           "precompute", "precomputed", "hits"};

/// The rays of a capture: columns ray_KIND_*.
inline constexpr std::array<std::string_view, 4> ray_kinds{"eye", "specular", "shadow", "gather"};

struct LeftOut {
    std::string what, why;
};

/// What trace.json says besides the columns.
struct TraceInfo {
    std::string scene;
    std::uint32_t image_width = 0, image_height = 0;  ///< [pixels]
    std::string map{map_names[0]};                    ///< Which photon map: of map_names.
    std::optional<std::uint32_t> frame;               ///< Of the scene's camera path.
    std::uint32_t k = 0;  ///< Photons of a search; 0: what was searched holds no photons.
    std::uint64_t seed = 0;
    std::string structure{"left-balanced-kd"};  ///< What was walked: a spec of
                                                ///< spatial/photons/structures.h or
                                                ///< spatial/rays/ray_structures.h.
    std::uint32_t structure_version = 1;
    std::uint64_t queries = 0, photons = 0;
    std::uint64_t found_photons = 0;   ///< Sum over the queries of the photons that each found.
    std::uint64_t visited_nodes = 0;   ///< Sum over the queries of the nodes that each visited.
    Json parameters = Json::object();  ///< As the capture was asked for.
    Json counts = Json::object();      ///< What the capture counted: rays, energy [W] ...
    std::vector<LeftOut> left_out;
};

/// Writes a trace. Until finish() the folder is not a trace for any reader, whatever happens.
class TraceWriter {
public:
    /// Creates `folder` if needed. Throws UsageError when it holds a finished trace and `force` is false, or
    /// other files than a trace's, or while another process writes into it; a finished trace that is
    /// overwritten loses its trace.json first.
    TraceWriter(std::filesystem::path folder, bool force);

    ColumnWriter& column(std::string_view name);  ///< Created at the first call.
    void finish(const TraceInfo& info);

private:
    std::filesystem::path folder_;
    FolderLock lock_;
    std::map<std::string, ColumnWriter, std::less<>> writers_;
};

/// Opens a finished trace. Throws DataError that names file, field, found and expected when it is not one, or
/// is of another schema version or map, or its image is empty, or k is 0 beside photons, or a required column
/// is not listed, or a listed one is missing or has another type or row count than trace.json says.
class TraceReader {
public:
    explicit TraceReader(std::filesystem::path folder);

    const TraceInfo& info() const { return info_; }
    const std::filesystem::path& folder() const { return folder_; }
    bool has(std::string_view name) const { return digests_.contains(std::string(name)); }
    std::map<std::string, ColumnDigest> const& digests() const { return digests_; }

    /// The rows of a column; its checksum is verified the first time. DataError when it was left out or
    /// altered.
    template <class T>
    std::span<const T> column(std::string_view name) {
        return open(name, column_type<T>()).template rows<T>();
    }
    /// The rows of any column as bytes; otherwise as column().
    std::span<const std::byte> bytes(std::string_view name);
    void verify_all();  ///< Reads every column.
    /// One number for the whole trace: XXH3-64 over the names and checksums of its columns, in hexadecimal.
    std::string checksum() const;
    /// The walks are read in no order: tells the kernel so.
    void expect_random_access(std::string_view name);

private:
    void read_columns(const Field& columns);
    const MappedColumn& open(std::string_view name, const ColumnType& type);

    std::filesystem::path folder_;
    TraceInfo info_;
    std::map<std::string, ColumnDigest> digests_;
    std::map<std::string, MappedColumn, std::less<>> mapped_;
    std::set<std::string, std::less<>> verified_;
};

}  // namespace regather::trace
