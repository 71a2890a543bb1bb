// experiment/traces/brought_queries.h -- the queries among the columns that somebody brings for a trace:
// where each is, and whatever else orderings can read of it. docs/trace_format.md.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trace/folder.h"
#include "trace/npy.h"

namespace regather::experiment {

/// A column of a folder that may be missing.
template <class T>
class BroughtColumn {
public:
    /// Throws trace::DataError for another number of rows than those of the column `as`.
    BroughtColumn(const std::filesystem::path& folder, std::string_view name, std::uint64_t rows,
                  std::string_view as);
    bool exists() const { return !file_.empty(); }
    std::string_view name() const { return name_; }
    /// Empty when it is missing.
    std::span<const T> rows() const {
        return exists() ? file_.front().template rows<T>() : std::span<const T>();
    }
    void store(trace::TraceWriter& writer) const {
        if (exists()) writer.column(name_).append(rows());
    }

private:
    std::string_view name_;
    std::vector<trace::MappedColumn> file_;
};

class BroughtQueries {
public:
    /// Throws trace::DataError for a column that is missing, of another length, or with a pixel that no image
    /// holds.
    explicit BroughtQueries(const std::filesystem::path& columns);

    std::span<const trace::Vec3> positions() const { return positions_.rows<trace::Vec3>(); }
    /// Writes the columns, and says in `info` what it can: scene, image, queries, what was left out. `width`
    /// [pixels] of the image, 0: all pixels in one row. Without pixels each query is one of its own.
    void store(trace::TraceWriter& writer, trace::TraceInfo& info, std::uint32_t width) const;

private:
    std::filesystem::path columns_;
    trace::MappedColumn positions_;
    BroughtColumn<std::uint32_t> pixel_;
    BroughtColumn<trace::Vec3> weight_, direction_;
    BroughtColumn<std::uint32_t> leaf_kd_, leaf_bvh_, stratum_;
    std::uint32_t last_pixel_ = 0;
};

/// Throws trace::DataError for a column in the folder that is none of a query's and none of `others`: one
/// whose name is misspelt.
void refuse_unknown_columns(const std::filesystem::path& folder, std::span<const std::string_view> others);

}  // namespace regather::experiment
