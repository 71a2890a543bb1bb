#include "spatial/refusal.h"

#include <fmt/format.h>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::spatial {

void refuse_row(const std::filesystem::path& folder, std::string_view column, std::uint64_t row,
                const std::string& found, const std::string& expected) {
    throw trace::DataError(
        fmt::format("{}: row {}: found {}, expected {}",
                    trace::shown((folder / fmt::format("{}.npy", column)).string(), trace::most_shown_path),
                    row, found, expected));
}

}  // namespace regather::spatial
