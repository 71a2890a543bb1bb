#include "trace/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <limits>
#include <utility>

#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::trace {
namespace {

std::vector<std::string_view> names_of(std::span<const Parameter> known) {
    std::vector<std::string_view> names;
    for (const Parameter& parameter : known) names.push_back(parameter.name);
    return names;
}

}  // namespace

Parameters::Parameters(std::string_view owner, std::span<const Parameter> known, std::string_view text)
    : owner_(owner), known_(known) {
    for (const Parameter& parameter : known) values_.emplace_back(parameter.default_value);
    std::vector<bool> set(known.size());
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        const std::string_view item = text.substr(0, comma);
        const bool last = comma == text.size();
        text.remove_prefix(last ? comma : comma + 1);
        const std::size_t equals = std::min(item.find('='), item.size());
        const std::string_view name = item.substr(0, equals);
        const std::vector<std::string_view> names = names_of(known);
        if (names.empty())
            throw UsageError(fmt::format("{}: parameter {} found, it takes none", owner, in_quotes(item)));
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            throw UsageError(fmt::format("{}: unknown parameter {}; nearest: {}; known: {}", owner,
                                         in_quotes(name), nearest_words(name, names).front(), listed(names)));
        const auto index = static_cast<std::size_t>(found - names.begin());
        if (set[index]) throw UsageError(fmt::format("{}: parameter {} is given twice", owner, name));
        if (equals + 1 >= item.size())
            throw UsageError(
                fmt::format("{}: parameter {} has no value, expected {}=...", owner, name, name));
        if (!last && text.empty())
            throw UsageError(fmt::format("{}: nothing after the comma, expected a parameter", owner));
        set[index] = true;
        values_[index] = item.substr(equals + 1);
    }
}

std::string& Parameters::value(std::string_view name) {
    return const_cast<std::string&>(std::as_const(*this).value(name));
}

const std::string& Parameters::value(std::string_view name) const {
    const auto found = std::find_if(known_.begin(), known_.end(),
                                    [name](const Parameter& known) { return known.name == name; });
    assert(found != known_.end());
    return values_[static_cast<std::size_t>(found - known_.begin())];
}

bool Parameters::knows(std::string_view name) const {
    return std::any_of(known_.begin(), known_.end(),
                       [name](const Parameter& known) { return known.name == name; });
}

std::optional<std::uint64_t> Parameters::given(std::string_view name) const {
    const std::string& text = value(name);
    if (text.empty()) return {};
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool one_spelling = text == "0" || text.front() != '0';  // equal orderings have equal specs
    if (error != std::errc{} || end != text.data() + text.size() || !one_spelling)
        throw UsageError(
            fmt::format("{}: {} is {}, expected a whole number below 2^64", owner_, name, in_quotes(text)));
    return number;
}

std::uint64_t Parameters::number(std::string_view name) const {
    return given(name).value();
}

std::optional<std::uint32_t> Parameters::given_count(std::string_view name) const {
    const std::optional<std::uint64_t> number = given(name);
    if (!number) return {};
    if (*number > std::numeric_limits<std::uint32_t>::max())
        throw UsageError(fmt::format("{}: {} is {}, expected less than 2^32", owner_, name, *number));
    return static_cast<std::uint32_t>(*number);
}

std::uint32_t Parameters::count(std::string_view name) const {
    return given_count(name).value();
}

std::uint32_t Parameters::count_or(std::string_view name, std::uint32_t fallback) {
    if (value(name).empty()) value(name) = fmt::format("{}", fallback);
    return count(name);
}

std::size_t Parameters::choice(std::string_view name, std::initializer_list<std::string_view> words) const {
    const auto found = std::find(words.begin(), words.end(), std::string_view(value(name)));
    if (found == words.end())
        throw UsageError(fmt::format("{}: {} is {}; nearest: {}; known: {}", owner_, name,
                                     in_quotes(value(name)),
                                     nearest_words(value(name), {words.begin(), words.size()}).front(),
                                     listed({words.begin(), words.size()})));
    return static_cast<std::size_t>(found - words.begin());
}

std::string Parameters::text() const {
    std::string text;
    for (std::size_t i = 0; i < known_.size(); ++i)
        if (!values_[i].empty())
            text += fmt::format("{}{}={}", text.empty() ? "" : ",", known_[i].name, values_[i]);
    return text;
}

}  // namespace regather::trace
