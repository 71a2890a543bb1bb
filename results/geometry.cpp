#include "results/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

#include "trace/error.h"
#include "trace/size.h"
#include "trace/text.h"

namespace regather::results {
namespace {

/// "128K" -> 131072. Nothing when it is no whole number from 1 up with an optional K or M.
std::optional<std::uint64_t> parse_size(std::string_view text) {
    std::uint64_t value = 0, unit = 1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
    if (rest == "K")
        unit = 1024;
    else if (rest == "M")
        unit = 1024 * 1024;
    else if (!rest.empty())
        return {};
    if (error != std::errc{} || value == 0 || value > (std::uint64_t{1} << 62) / unit) return {};
    return value * unit;
}

std::string three_digits(double value) {
    const int decimals = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return fmt::format("{:.{}f}", value, decimals);
}

/// "B" is written whole; from 999.5 of a unit on, the next one is taken.
std::string decimal(double value, const char* unit) {
    if (value < 999.5) return fmt::format("{:.4g} {}", value, unit);
    const auto [number, steps] = trace::scaled_down(value, 1000, 999.5);
    return fmt::format("{} {}{}", three_digits(number), trace::decimal_prefixes[steps], unit);
}

}  // namespace

Geometry parse_geometry(std::string_view text) {
    const auto first = text.find(':'), second = first == text.npos ? first : text.find(':', first + 1);
    if (second != text.npos) {
        const auto size = parse_size(text.substr(0, first));
        const auto line = parse_size(text.substr(first + 1, second - first - 1));
        const std::string_view last = text.substr(second + 1);
        const auto ways = last == "full" ? std::optional<std::uint64_t>(0) : parse_size(last);
        if (size && line && ways) return {*size, *line, *ways};
    }
    throw trace::UsageError(fmt::format(
        "cache {}: expected SIZE:LINE:WAYS, for example 128K:128:8 or 1M:64:full", trace::in_quotes(text)));
}

std::string geometry_text(const Geometry& geometry) {
    return fmt::format("{}, {}", binary_bytes(geometry.cache_bytes), shape_text(geometry));
}

std::string shape_text(const Geometry& geometry) {
    return fmt::format("{} lines, {}", binary_bytes(geometry.line_bytes),
                       geometry.ways == 0   ? "fully associative"
                       : geometry.ways == 1 ? "direct mapped"
                                            : fmt::format("{}-way", geometry.ways));
}

std::optional<Geometry> geometry_of(const Row& row) {
    if (!row.cache_bytes || !row.line_bytes || !row.ways) return {};
    return Geometry{*row.cache_bytes, *row.line_bytes, *row.ways};
}

std::optional<Geometry> commonest_geometry(std::span<const Row> rows) {
    std::vector<std::pair<Geometry, std::size_t>> counts;
    for (const Row& row : rows) {
        const auto geometry = geometry_of(row);
        if (!geometry) continue;
        auto found =
            std::find_if(counts.begin(), counts.end(), [&](auto& c) { return c.first == *geometry; });
        if (found == counts.end()) found = counts.insert(counts.end(), {*geometry, 0});
        ++found->second;
    }
    std::optional<Geometry> best;
    std::size_t most = 0;
    for (const auto& [geometry, count] : counts) {
        if (count < most || (count == most && geometry != Geometry{})) continue;
        best = geometry;
        most = count;
    }
    return best;
}

std::string binary_bytes(std::uint64_t bytes) {
    if (bytes < 1024) return fmt::format("{} B", bytes);
    const auto [number, steps] = trace::scaled_down(static_cast<double>(bytes), 1024, 1024);
    return fmt::format("{:.4g} {}iB", number, "KMGTPE"[steps - 1]);
}

std::string decimal_bytes(std::uint64_t bytes) {
    return decimal(static_cast<double>(bytes), "B");
}

std::string decimal_count(double count) {
    std::string out = decimal(count, "");
    while (out.back() == ' ') out.pop_back();
    return out;
}

ByteUnit byte_unit(double most) {
    for (const ByteUnit unit : {ByteUnit{"GB", 1e9}, ByteUnit{"MB", 1e6}, ByteUnit{"kB", 1e3}})
        if (most >= unit.bytes) return unit;
    return {"bytes", 1};
}

std::string joined(std::span<const std::string> parts, std::string_view separator) {
    std::string out;
    for (const std::string& part : parts) {
        if (part.empty()) continue;
        if (!out.empty()) out += separator;
        out += part;
    }
    return out;
}

}  // namespace regather::results
