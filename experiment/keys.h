// experiment/keys.h -- one object of an experiment file, read key by key; a key that nobody knows is an
// error.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace regather::experiment {

/// Errors are trace::DataError: "FILE: WHERE.KEY: found X, expected Y".
class Object {
public:
    /// Refuses keys that are not `known`, naming the nearest. `where` is the object's place in the file, ""
    /// for the root.
    Object(const nlohmann::json& value, std::span<const std::string_view> known, std::string file,
           std::string where);

    bool has(std::string_view key) const { return value_.contains(key); }
    std::string text(std::string_view key) const;  ///< Required.
    std::uint64_t number(std::string_view key, std::uint64_t fallback, std::uint64_t least,
                         std::uint64_t most) const;
    double real(std::string_view key, double fallback) const;  ///< Finite, not negative.
    bool flag(std::string_view key, bool fallback) const;
    /// A value or a list of values, each a text or a number, as texts; `fallback` when the key is missing.
    std::vector<std::string> list(std::string_view key, std::vector<std::string> fallback) const;
    const nlohmann::json& array(std::string_view key) const;  ///< Required, not empty.

    [[noreturn]] void refuse(std::string_view key, const std::string& found,
                             const std::string& expected) const;
    std::string place(std::string_view key) const;
    const std::string& file() const { return file_; }

private:
    const nlohmann::json& value_;
    std::string file_, where_;
};

}  // namespace regather::experiment
