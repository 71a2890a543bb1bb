#include "experiment/traces/brought_queries.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;
using trace::Vec3;

constexpr std::array<std::string_view, 7> known_columns{"query_position",  "query_pixel",   "query_weight",
                                                        "query_direction", "query_leaf_kd", "query_leaf_bvh",
                                                        "query_stratum"};

fs::path file_of(const fs::path& folder, std::string_view name) {
    return folder / fmt::format("{}.npy", name);
}

}  // namespace

template <class T>
BroughtColumn<T>::BroughtColumn(const fs::path& folder, std::string_view name, std::uint64_t rows,
                                std::string_view as)
    : name_(name) {
    const fs::path path = file_of(folder, name);
    std::error_code error;
    if (!fs::exists(path, error)) return;
    file_.push_back(trace::MappedColumn(path, trace::column_type<T>()));
    if (file_.front().size() != rows)
        throw trace::DataError(fmt::format("{}: found {} rows, expected {} as in {}.npy", path.string(),
                                           file_.front().size(), rows, as));
}
template class BroughtColumn<std::uint32_t>;
template class BroughtColumn<std::uint64_t>;
template class BroughtColumn<Vec3>;

void refuse_unknown_columns(const fs::path& folder, std::span<const std::string_view> others) {
    std::vector<std::string_view> known(others.begin(), others.end());
    known.insert(known.end(), known_columns.begin(), known_columns.end());
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

BroughtQueries::BroughtQueries(const fs::path& columns)
    : columns_(columns),
      positions_(file_of(columns, "query_position"), trace::column_type<Vec3>()),
      pixel_(columns, "query_pixel", positions_.size(), "query_position"),
      weight_(columns, "query_weight", positions_.size(), "query_position"),
      direction_(columns, "query_direction", positions_.size(), "query_position"),
      leaf_kd_(columns, "query_leaf_kd", positions_.size(), "query_position"),
      leaf_bvh_(columns, "query_leaf_bvh", positions_.size(), "query_position"),
      stratum_(columns, "query_stratum", positions_.size(), "query_position") {
    const std::uint64_t queries = positions_.size();
    if (queries >= std::numeric_limits<std::uint32_t>::max())
        throw trace::DataError(fmt::format("{}: found {} rows, expected fewer than 2^32 - 1",
                                           file_of(columns, "query_position").string(), queries));
    if (!pixel_.exists()) last_pixel_ = queries == 0 ? 0 : static_cast<std::uint32_t>(queries - 1);
    constexpr std::uint32_t most =
        std::numeric_limits<std::uint32_t>::max() - 1;  // so that an image width is one more
    for (std::size_t i = 0; i < pixel_.rows().size(); ++i) {
        last_pixel_ = std::max(last_pixel_, pixel_.rows()[i]);
        if (last_pixel_ > most)
            throw trace::DataError(fmt::format("{}: row {}: found {}, expected at most {}",
                                               file_of(columns, "query_pixel").string(), i, last_pixel_,
                                               most));
    }
}

void BroughtQueries::store(trace::TraceWriter& writer, trace::TraceInfo& info, std::uint32_t width) const {
    writer.column("query_position").append(positions());
    const auto copy = [&](const auto& column) {
        column.store(writer);
        if (!column.exists())
            info.left_out.push_back({std::string(column.name()), "it was not among the columns given"});
    };
    copy(weight_);
    copy(direction_);
    copy(leaf_kd_);
    copy(leaf_bvh_);
    copy(stratum_);
    if (pixel_.exists()) {
        pixel_.store(writer);
    } else {
        std::vector<std::uint32_t> own(positions_.size());
        for (std::size_t i = 0; i < own.size(); ++i) own[i] = static_cast<std::uint32_t>(i);
        writer.column("query_pixel").append(std::span<const std::uint32_t>(own));
    }
    info.image_width = width > 0 ? width : last_pixel_ + 1;
    info.image_height = last_pixel_ / info.image_width + 1;
    info.scene = fs::weakly_canonical(columns_).filename().string();
    info.queries = positions_.size();
}

}  // namespace regather::experiment
