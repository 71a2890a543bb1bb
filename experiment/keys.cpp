#include "experiment/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trace/error.h"
#include "trace/word.h"

namespace regather::experiment {

Object::Object(const nlohmann::json& value, std::span<const std::string_view> known, std::string file,
               std::string where)
    : value_(value), file_(std::move(file)), where_(std::move(where)) {
    if (!value.is_object())
        throw trace::DataError(fmt::format("{}: {}: found {}, expected an object", file_,
                                           where_.empty() ? "the file" : where_, value.type_name()));
    for (const auto& [key, unused] : value.items())
        if (std::find(known.begin(), known.end(), key) == known.end())
            throw trace::DataError(
                fmt::format("{}: {}: found an unknown key, expected {} (known keys: {})", file_, place(key),
                            trace::alternatives(trace::nearest_words(key, known)), trace::listed(known)));
}

std::string Object::place(std::string_view key) const {
    return where_.empty() ? std::string(key) : fmt::format("{}.{}", where_, key);
}

void Object::refuse(std::string_view key, const std::string& found, const std::string& expected) const {
    throw trace::DataError(fmt::format("{}: {}: found {}, expected {}", file_, place(key), found, expected));
}

std::string Object::text(std::string_view key) const {
    if (!has(key)) refuse(key, "nothing", "a text");
    const nlohmann::json& value = value_.at(std::string(key));
    if (!value.is_string()) refuse(key, value.dump(), "a text");
    return value.get<std::string>();
}

std::uint64_t Object::number(std::string_view key, std::uint64_t fallback, std::uint64_t least,
                             std::uint64_t most) const {
    if (!has(key)) return fallback;
    const nlohmann::json& value = value_.at(std::string(key));
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() < least ||
        value.get<std::uint64_t>() > most)
        refuse(key, value.dump(), fmt::format("a whole number from {} to {}", least, most));
    return value.get<std::uint64_t>();
}

double Object::real(std::string_view key, double fallback) const {
    if (!has(key)) return fallback;
    const nlohmann::json& value = value_.at(std::string(key));
    if (!value.is_number() || !std::isfinite(value.get<double>()) || value.get<double>() < 0)
        refuse(key, value.dump(), "a number that is not negative");
    return value.get<double>();
}

bool Object::flag(std::string_view key, bool fallback) const {
    if (!has(key)) return fallback;
    const nlohmann::json& value = value_.at(std::string(key));
    if (!value.is_boolean()) refuse(key, value.dump(), "true or false");
    return value.get<bool>();
}

std::vector<std::string> Object::list(std::string_view key, std::vector<std::string> fallback) const {
    if (!has(key)) return fallback;
    const nlohmann::json& value = value_.at(std::string(key));
    std::vector<std::string> texts;
    const auto add = [&](const nlohmann::json& item) {
        if (item.is_string()) {
            texts.push_back(item.get<std::string>());
        } else if (item.is_number_unsigned()) {
            texts.push_back(item.dump());
        } else {
            refuse(key, item.dump(), "a text or a whole number, or a list of them");
        }
    };
    if (value.is_array()) {
        for (const nlohmann::json& item : value) add(item);
    } else {
        add(value);
    }
    if (texts.empty()) refuse(key, "[]", "at least one value");
    return texts;
}

const nlohmann::json& Object::array(std::string_view key) const {
    if (!has(key)) refuse(key, "nothing", "a list");
    const nlohmann::json& value = value_.at(std::string(key));
    if (!value.is_array() || value.empty()) refuse(key, value.dump(), "a list with at least one entry");
    return value;
}

}  // namespace regather::experiment
