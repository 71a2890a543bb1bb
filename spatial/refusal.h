// spatial/refusal.h -- what is said of a trace's column that no structure can be opened with.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace regather::spatial {

/// Throws trace::DataError: "FOLDER/COLUMN.npy: row ROW: found FOUND, expected EXPECTED".
[[noreturn]] void refuse_row(const std::filesystem::path& folder, std::string_view column, std::uint64_t row,
                             const std::string& found, const std::string& expected);

}  // namespace regather::spatial
