#include "experiment/kept.h"

#include <fmt/format.h>

#include "trace/digest.h"
#include "trace/file.h"

namespace regather::experiment {
namespace {

/// All that stands before the bytes.
std::string header(std::string_view key, std::string_view bytes) {
    return fmt::format("regather part 1\nfor {}\nxxh3 {}\n", key, trace::digest_of(bytes));
}

}  // namespace

std::optional<std::string> read_kept(const std::filesystem::path& path, std::string_view key) {
    if (!std::filesystem::is_regular_file(path)) return std::nullopt;
    std::string text = trace::read_file(path);
    std::size_t start = 0;
    for (int line = 0; line < 3; ++line) {
        start = text.find('\n', start);
        if (start == std::string::npos) return std::nullopt;
        ++start;
    }
    std::string bytes = text.substr(start);
    if (std::string_view(text).substr(0, start) != header(key, bytes)) return std::nullopt;
    return bytes;
}

void write_kept(const std::filesystem::path& path, std::string_view key, std::string_view bytes) {
    trace::write_whole(path, header(key, bytes) + std::string(bytes));
}

}  // namespace regather::experiment
