// meshes/number.h -- numbers as text files of triangles have them.
#pragma once
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace regather::meshes {

/// The whole word as a number: an optional sign, digits with or without a point, an optional exponent, "nan"
/// and "inf"; the nearest double. One too small for a double is 0; one too large, and any other word, is
/// none.
inline std::optional<double> real_number(std::string_view word) {
    if (!word.empty() && word.front() == '+') {
        word.remove_prefix(1);
        if (!word.empty() && (word.front() == '-' || word.front() == '+')) return std::nullopt;
    }
    double value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (word.empty() || end != last) return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        const std::size_t exponent = word.find_first_of("eE");
        const bool is_small =
            exponent != word.npos && exponent + 1 < word.size() && word[exponent + 1] == '-';
        return is_small ? std::optional<double>(0.0) : std::nullopt;
    }
    if (error != std::errc{}) return std::nullopt;
    return value;
}

/// The same as a float; none when it is not finite as such.
inline std::optional<float> finite_float(std::string_view word) {
    const std::optional<double> value = real_number(word);
    if (!value || !std::isfinite(static_cast<float>(*value))) return std::nullopt;
    return static_cast<float>(*value);
}

/// The whole word as a whole number with an optional sign; none for any other word, and beyond 64 bits.
inline std::optional<std::int64_t> whole_number(std::string_view word) {
    if (!word.empty() && word.front() == '+') {
        word.remove_prefix(1);
        if (!word.empty() && word.front() == '-') return std::nullopt;
    }
    std::int64_t value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (word.empty() || end != last || error != std::errc{}) return std::nullopt;
    return value;
}

}  // namespace regather::meshes
