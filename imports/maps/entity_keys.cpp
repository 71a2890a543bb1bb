#include "imports/maps/entity_keys.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

#include "imports/maps/tour.h"

namespace regather::imports {

namespace {

// Between blanks; empty for a class that is not used.
std::string_view used_keys(std::string_view entity_class) {
    if (entity_class == "worldspawn") return " classname message ";
    if (entity_class == "light") return " classname origin light _color ";
    if (is_spawn_point(entity_class)) return " classname origin angle ";
    if (is_item(entity_class)) return " classname origin ";
    return {};
}

}  // namespace

std::optional<trace::Vec3> triple_in(std::string_view text) {
    trace::Vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
        while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result[axis]);
        if (error != std::errc{} || !(std::abs(result[axis]) <= 1e6f)) return std::nullopt;
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    return result;
}

void count_left_out(std::span<const BspEntity> entities, LeftOut& left_out) {
    for (const BspEntity& entity : entities) {
        const std::string_view name = entity.value("classname");
        const bool has_faces = entity.value("model").starts_with('*');
        const std::string_view used = used_keys(name);
        if (used.empty() && !has_faces) {
            left_out.add("of entities", name.empty() ? "without a classname" : name);
            continue;
        }
        const std::string kind = used.empty() ? std::string("of moving parts")
                                              : fmt::format("of entity {}", is_item(name) ? "items" : name);
        for (const auto& [key, value] : entity.pairs) {
            const std::string word = fmt::format(" {} ", key);
            const bool of_part = has_faces && (key == "model" || key == "origin" || key == "classname");
            if (!of_part && used.find(word) == std::string_view::npos) left_out.add(kind, key);
        }
    }
}

}  // namespace regather::imports
