#include "trace/size.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::trace {

std::uint64_t parse_size(std::string_view text) {
    const auto refuse = [&] {
        return UsageError(
            fmt::format("size: found '{}', expected bytes below 2^64 as 4096, 16K, 1M or 2G", shown(text)));
    };
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) throw refuse();
    const std::string_view suffix = text.substr(static_cast<std::size_t>(end - text.data()));
    if (suffix.empty()) return value;
    const std::size_t power = std::string_view("KkMmGg").find(suffix);
    if (suffix.size() != 1 || power == std::string_view::npos) throw refuse();
    const std::size_t shift = 10 * (power / 2 + 1);
    if (value > std::numeric_limits<std::uint64_t>::max() >> shift) throw refuse();
    return value << shift;
}

std::string size_text(std::uint64_t bytes) {
    if (bytes >= 1 << 20 && bytes % (1 << 20) == 0) return fmt::format("{}M", bytes >> 20);
    if (bytes >= 1 << 10 && bytes % (1 << 10) == 0) return fmt::format("{}K", bytes >> 10);
    return fmt::format("{}", bytes);
}

Scaled scaled_down(double value, double base, double from) {
    unsigned steps = 0;
    for (; value >= from && steps < 6; ++steps) value /= base;
    return {value, steps};
}

}  // namespace regather::trace
