// trace/parameters.h -- the parameters of an ordering, a layout or a structure as its spec writes them:
// "tile=16,bits=16".
#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace regather::trace {

struct Parameter {
    std::string_view name;
    std::string_view default_value;  ///< "" when there is none, or when it follows from others (see help).
    std::string_view help;
};

class Parameters {
public:
    /// Throws trace::UsageError (unknown, twice, without value) that names the nearest and lists the known
    /// ones.
    Parameters(std::string_view owner, std::span<const Parameter> known, std::string_view text);

    bool knows(std::string_view name) const;                          ///< Whether there is such a parameter.
    std::optional<std::uint64_t> given(std::string_view name) const;  ///< Nothing when it has no value.
    std::uint64_t number(std::string_view name) const;                ///< It has a value.
    /// As number(), but at most 2^32 - 1.
    std::uint32_t count(std::string_view name) const;
    std::optional<std::uint32_t> given_count(std::string_view name) const;
    /// As count(); a parameter without value gets `fallback`.
    std::uint32_t count_or(std::string_view name, std::uint32_t fallback);
    /// As it was written; empty when it has no value.
    std::string_view written(std::string_view name) const { return value(name); }
    /// Which of `words` the value is.
    std::size_t choice(std::string_view name, std::initializer_list<std::string_view> words) const;

    /// Every parameter that has a value, as it is now, in the order of the table.
    std::string text() const;

private:
    std::string& value(std::string_view name);
    const std::string& value(std::string_view name) const;

    std::string owner_;
    std::span<const Parameter> known_;
    std::vector<std::string> values_;  // beside known_
};

}  // namespace regather::trace
