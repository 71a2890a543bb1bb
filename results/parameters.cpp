#include "results/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

namespace regather::results {
namespace {

/// The words "name=value" of a spec.
std::vector<std::string_view> assignments(std::string_view spec) {
    std::vector<std::string_view> out;
    for (std::size_t at = 0; at <= spec.size();) {
        const std::size_t end = std::min(spec.find_first_of(":,+ ", at), spec.size());
        const std::string_view word = spec.substr(at, end - at);
        if (word.find('=') != word.npos) out.push_back(word);
        at = end + 1;
    }
    return out;
}

}  // namespace

std::string other_parameters(const Row& row) {
    std::string out;
    for (const std::string_view word : assignments(row.parameters)) {
        if (word.starts_with("tile=") || word.starts_with("bins=") || word.starts_with("strata=")) continue;
        // A pass for each bin is what is meant when nothing is said.
        if (row.bins && word == fmt::format("passes={}", *row.bins * *row.bins)) continue;
        fmt::format_to(std::back_inserter(out), "{}{}", out.empty() ? "" : ", ", word);
    }
    return out;
}

Count parameter(std::string_view spec, std::string_view name) {
    for (const std::string_view word : assignments(spec)) {
        if (!word.starts_with(name) || word[name.size()] != '=') continue;
        std::uint64_t value = 0;
        const std::string_view digits = word.substr(name.size() + 1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (error == std::errc{} && end == digits.data() + digits.size() && value > 0) return value;
    }
    return {};
}

}  // namespace regather::results
