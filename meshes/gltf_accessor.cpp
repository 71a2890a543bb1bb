#include "meshes/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "trace/text.h"

namespace regather::meshes {

using trace::Field;
using trace::in_quotes;

namespace {

// A small file may ask for the same elements any number of times.
constexpr std::uint64_t most_elements_read = 1ull << 31;

enum Component : std::uint32_t {
    byte_ = 5120,
    ubyte = 5121,
    short_ = 5122,
    ushort_ = 5123,
    uint_ = 5125,
    float_ = 5126
};

std::size_t bytes_of(std::uint32_t component) {
    return component == byte_ || component == ubyte ? 1 : component == short_ || component == ushort_ ? 2 : 4;
}

std::uint32_t bits_at(const char* data, std::size_t bytes) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < bytes; ++i)
        bits |= std::uint32_t{static_cast<unsigned char>(data[i])} << (8 * i);
    return bits;
}

// Section 3.11: normalized integers as floats.
float value_at(const char* data, std::uint32_t component, bool normalized) {
    const std::uint32_t bits = bits_at(data, bytes_of(component));
    switch (component) {
        case byte_: {
            const auto x = static_cast<float>(static_cast<std::int8_t>(bits));
            return normalized ? std::max(x / 127.0f, -1.0f) : x;
        }
        case ubyte:
            return normalized ? static_cast<float>(bits) / 255.0f : static_cast<float>(bits);
        case short_: {
            const auto x = static_cast<float>(static_cast<std::int16_t>(bits));
            return normalized ? std::max(x / 32767.0f, -1.0f) : x;
        }
        case ushort_:
            return normalized ? static_cast<float>(bits) / 65535.0f : static_cast<float>(bits);
        default:
            return std::bit_cast<float>(bits);
    }
}

std::uint64_t bytes_in(const Field& object, const char* key) {
    const auto field = object.get(key);
    return field ? field->whole<std::uint64_t>(0, ~0ull, "a number of bytes") : 0;
}

std::uint32_t component_of(const Field& object) {
    return object["componentType"].whole<std::uint32_t>(0, 1u << 20, "a component type");
}

}  // namespace

std::uint64_t GltfAccessors::count(const Field& index) const {
    return file_.element("accessors", index)["count"].whole<std::uint64_t>(0, ~0ull, "a number of elements");
}

GltfAccessors::Elements GltfAccessors::elements(const Field& accessor, std::string_view type,
                                                std::size_t element_bytes) const {
    if (accessor["type"].text() != type)
        accessor["type"].fail(in_quotes(accessor["type"].text()), in_quotes(type));
    const auto view_index = accessor.get("bufferView");
    if (!view_index) accessor.fail("an accessor without a bufferView", "one with its values in a buffer");
    const Field& view = file_.element("bufferViews", *view_index);
    const std::string_view bytes = file_.view(view);
    const std::uint64_t start = bytes_in(accessor, "byteOffset");
    const auto count = accessor["count"].whole<std::uint64_t>(0, ~0ull, "a number of elements");
    std::uint64_t stride = element_bytes;
    if (const auto given = view.get("byteStride"))
        stride = given->whole<std::uint64_t>(element_bytes, 1024, fmt::format("{} to 1024", element_bytes));
    if (count > 0 && (start > bytes.size() || bytes.size() - start < element_bytes ||
                      count - 1 > (bytes.size() - start - element_bytes) / stride))
        accessor["count"].fail(
            fmt::format("{} elements of {} bytes from byte {} on", count, element_bytes, start),
            fmt::format("what fits the {} bytes of its bufferView", bytes.size()));
    return {count > 0 ? bytes.data() + start : nullptr, count, stride};
}

void GltfAccessors::spend(const Field& accessor, std::uint64_t elements) {
    if (elements > most_elements_read - spent_)
        accessor.fail(
            fmt::format("more than {} elements, counted as often as they are named", most_elements_read),
            "at most as many");
    spent_ += elements;
}

std::vector<Vec3> GltfAccessors::points(const Field& index) {
    const Field& accessor = file_.element("accessors", index);
    const std::uint32_t component = component_of(accessor);
    if (component != float_ && (component < byte_ || component > ushort_))
        accessor["componentType"].fail(fmt::format("{}", component),
                                       "5126 (floats), or 5120 to 5123 (bytes and shorts)");
    const auto normalized_field = accessor.get("normalized");
    const bool normalized = normalized_field && normalized_field->truth();
    const std::size_t bytes = bytes_of(component);
    const Elements all = elements(accessor, "VEC3", 3 * bytes);
    spend(accessor, all.count);
    std::vector<Vec3> points(all.count);
    for (std::size_t i = 0; i < all.count; ++i)
        for (int axis = 0; axis < 3; ++axis)
            points[i][axis] = value_at(all.data + i * all.stride + bytes * static_cast<std::size_t>(axis),
                                       component, normalized);
    if (const auto sparse = accessor.get("sparse")) replace_sparse(*sparse, component, normalized, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!trace::is_finite(points[i]))
            accessor.fail(fmt::format("element {} that is not finite", i), "numbers");
    return points;
}

void GltfAccessors::replace_sparse(const Field& sparse, std::uint32_t component, bool normalized,
                                   std::vector<Vec3>& points) const {
    const auto count =
        sparse["count"].whole<std::uint64_t>(0, points.size(), fmt::format("at most {}", points.size()));
    const Field where = sparse["indices"], what = sparse["values"];
    const std::uint32_t type = component_of(where);
    if (type != ubyte && type != ushort_ && type != uint_)
        where["componentType"].fail(fmt::format("{}", type), "5121, 5123 or 5125");
    const auto bytes_from = [&](const Field& part, std::size_t element_bytes) {
        std::string_view bytes = file_.view(file_.element("bufferViews", part["bufferView"]));
        bytes.remove_prefix(std::min<std::uint64_t>(bytes_in(part, "byteOffset"), bytes.size()));
        if (count > bytes.size() / element_bytes)
            part.fail(fmt::format("{} elements of {} bytes", count, element_bytes),
                      fmt::format("what fits the {} bytes that are there", bytes.size()));
        return bytes.data();
    };
    const std::size_t bytes = bytes_of(component);
    const char* indices = bytes_from(where, bytes_of(type));
    const char* values = bytes_from(what, 3 * bytes);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t at = bits_at(indices + i * bytes_of(type), bytes_of(type));
        if (at >= points.size())
            where.fail(fmt::format("the index {}", at), fmt::format("one below {}", points.size()));
        for (std::size_t axis = 0; axis < 3; ++axis)
            points[at][static_cast<int>(axis)] =
                value_at(values + (3 * i + axis) * bytes, component, normalized);
    }
}

std::vector<std::uint32_t> GltfAccessors::indices(const Field& index, std::size_t vertices) {
    const Field& accessor = file_.element("accessors", index);
    const std::uint32_t component = component_of(accessor);
    if (component != ubyte && component != ushort_ && component != uint_)
        accessor["componentType"].fail(fmt::format("{}", component), "5121, 5123 or 5125 for indices");
    if (accessor.has("sparse")) accessor["sparse"].fail("sparse indices", "plain ones");
    const std::size_t bytes = bytes_of(component);
    const Elements all = elements(accessor, "SCALAR", bytes);
    spend(accessor, all.count);
    std::vector<std::uint32_t> values(all.count);
    for (std::size_t i = 0; i < all.count; ++i) {
        values[i] = bits_at(all.data + i * all.stride, bytes);
        if (values[i] >= vertices)
            accessor.fail(fmt::format("the index {} at {}", values[i], i),
                          fmt::format("one of {} vertices", vertices));
    }
    return values;
}

}  // namespace regather::meshes
