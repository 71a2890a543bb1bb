#include "meshes/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "meshes/faces.h"
#include "meshes/notes.h"
#include "meshes/ply_body.h"
#include "meshes/ply_header.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::meshes {

namespace {

constexpr std::array<std::string_view, 6> numbers_of_a_vertex{"x", "y", "z", "nx", "ny", "nz"};
constexpr std::uint32_t restart = ~0u;  // -1 in a triangle strip.

bool names_vertices(const PlyProperty& property) {
    return property.name == "vertex_indices" || property.name == "vertex_index";
}

class PlyReader {
public:
    explicit PlyReader(const Source& source)
        : source_(source),
          header_(read_ply_header(source.bytes, source.file)),
          body_(source.bytes, header_) {}

    Mesh read() {
        const PlyElement* vertex = element("vertex");
        if (vertex == nullptr) fail("no element \"vertex\"", "one");
        if (element("face") == nullptr && element("tristrips") == nullptr)
            fail("no element \"face\"", "one: a cloud of points has no surface");
        if (vertex->count > most_vertices)
            fail(fmt::format("{} vertices", vertex->count), fmt::format("at most {}", most_vertices));
        vertices_declared_ = vertex->count;
        for (const PlyElement& one : header_.elements) {
            require_room(one);
            if (one.name == "vertex")
                read_vertices(one);
            else if (one.name == "face" || one.name == "tristrips")
                read_faces(one);
            else
                pass_over(one);
        }
        note_what_is_left();
        make_surface();
        mesh_.notes = notes_.lines();
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw trace::DataError(fmt::format("{}: found {}, expected {}", source_.file, found, expected));
    }
    [[noreturn]] void fail_here(const std::string& found, const std::string& expected) const {
        throw trace::DataError(
            fmt::format("{}: {}: found {}, expected {}", source_.file, body_.place(), found, expected));
    }
    // `what`: "the property x", "a length".
    [[noreturn]] void fail_at(const PlyElement& element, std::uint64_t row, std::string_view what) const {
        fail_here(body_.found(),
                  fmt::format("{} of {} {} of {}", what, trace::shown(element.name), row + 1, element.count));
    }

    const PlyElement* element(std::string_view name) const {
        for (const PlyElement& one : header_.elements)
            if (one.name == name) return &one;
        return nullptr;
    }

    // A file that declares more than it can hold is refused before anything is made.
    void require_room(const PlyElement& element) const {
        if (element.properties.empty() || element.count == 0) return;
        const auto smallest = std::min_element(element.properties.begin(), element.properties.end(),
                                               [](const PlyProperty& a, const PlyProperty& b) {
                                                   return (a.length ? a.length : a.value)->bytes <
                                                          (b.length ? b.length : b.value)->bytes;
                                               });
        const PlyType& type = *(smallest->length ? smallest->length : smallest->value);
        if (element.count > ~0ull / element.properties.size() ||
            !body_.may_hold(element.count * element.properties.size(), type))
            fail(fmt::format("{} bytes for {} times {}", body_.left().size(), element.count,
                             trace::in_quotes(element.name)),
                 "a file that holds what its header declares");
    }

    double number(const PlyElement& element, std::uint64_t row, const PlyProperty& property) {
        const std::optional<double> value = body_.next(*property.value);
        if (!value || !std::isfinite(static_cast<float>(*value)))
            fail_at(element, row, fmt::format("a finite number for {}", trace::in_quotes(property.name)));
        return *value;
    }

    std::uint64_t length(const PlyElement& element, std::uint64_t row, const PlyProperty& property) {
        const std::optional<double> length = body_.next(*property.length);
        if (!length || !(*length >= 0) || *length != std::floor(*length) || *length > 4294967295.0)
            fail_at(element, row, fmt::format("the length of the list {}", trace::in_quotes(property.name)));
        const auto values = static_cast<std::uint64_t>(*length);
        if (!body_.may_hold(values, *property.value))
            fail_here(fmt::format("a list of {} for {} bytes", values, body_.left().size()),
                      fmt::format("what is there of {} {} of {}", trace::shown(element.name), row + 1,
                                  element.count));
        return values;
    }

    void skip(const PlyElement& element, std::uint64_t row, const PlyProperty& property) {
        const std::uint64_t values = property.length != nullptr ? length(element, row, property) : 1;
        for (std::uint64_t v = 0; v < values; ++v)
            if (!body_.skip(*property.value))
                fail_at(element, row, fmt::format("a value for {}", trace::in_quotes(property.name)));
    }

    void pass_over(const PlyElement& element) {
        if (!element.properties.empty())
            for (std::uint64_t row = 0; row < element.count; ++row)
                for (const PlyProperty& property : element.properties) skip(element, row, property);
        notes_.add(fmt::format("elements {} are not read", trace::in_quotes(element.name)), element.count);
    }

    void note_properties(const PlyElement& element, std::string_view nouns,
                         const std::vector<std::string>& names) {
        std::string list;
        for (std::size_t i = 0; i < names.size() && i < 12; ++i) list += (i > 0 ? ", " : "") + names[i];
        if (names.size() > 12) list += ", ...";
        if (!names.empty())
            notes_.add(
                fmt::format("the properties {} of {} are not read", trace::in_quotes(list, 120), nouns),
                element.count);
    }

    void read_vertices(const PlyElement& element) {
        std::vector<int> slots;  // Of each property: its place among numbers_of_a_vertex, -1 for none.
        std::array<bool, 6> there{};
        std::vector<std::string> others;
        for (const PlyProperty& property : element.properties) {
            const auto found =
                std::find(numbers_of_a_vertex.begin(), numbers_of_a_vertex.end(), property.name);
            const bool is_read = found != numbers_of_a_vertex.end();
            if (is_read && property.length != nullptr)
                fail(fmt::format("a list {} of a vertex", trace::in_quotes(property.name)), "a single value");
            slots.push_back(is_read ? static_cast<int>(found - numbers_of_a_vertex.begin()) : -1);
            if (is_read)
                there[static_cast<std::size_t>(slots.back())] = true;
            else
                others.push_back(property.name);
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!there[axis])
                fail("no property " + trace::in_quotes(numbers_of_a_vertex[axis]) + " of vertex",
                     "x, y and z");
        const bool has_normals = there[3] && there[4] && there[5];
        for (std::size_t axis = 3; axis < 6 && !has_normals; ++axis)
            if (there[axis]) others.emplace_back(numbers_of_a_vertex[axis]);
        note_properties(element, "vertices", others);

        Surface& surface = mesh_.surface;
        surface.vertices.reserve(element.count);
        surface.normals.reserve(element.count);
        for (std::uint64_t row = 0; row < element.count; ++row) {
            std::array<float, 6> numbers{};
            for (std::size_t p = 0; p < slots.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (slots[p] < 0 || (slots[p] >= 3 && !has_normals))
                    skip(element, row, property);
                else if (slots[p] < 3)
                    numbers[static_cast<std::size_t>(slots[p])] =
                        static_cast<float>(number(element, row, property));
                else
                    numbers[static_cast<std::size_t>(slots[p])] = normal_part(element, row, property);
            }
            surface.vertices.push_back({numbers[0], numbers[1], numbers[2]});
            const Vec3 normal = trace::normalize(Vec3{numbers[3], numbers[4], numbers[5]});
            surface.normals.push_back(trace::is_finite(normal) ? normal : Vec3{});
        }
    }

    // A normal that is not finite is none.
    float normal_part(const PlyElement& element, std::uint64_t row, const PlyProperty& property) {
        const std::optional<double> value = body_.next(*property.value);
        if (!value) fail_at(element, row, fmt::format("a number for {}", trace::in_quotes(property.name)));
        return static_cast<float>(*value);
    }

    void read_faces(const PlyElement& element) {
        const bool is_strip = element.name == "tristrips";
        const PlyProperty* list = nullptr;
        std::vector<std::string> others;
        for (const PlyProperty& property : element.properties) {
            if (!names_vertices(property)) {
                others.push_back(property.name);
            } else if (list != nullptr || property.length == nullptr) {
                fail(
                    fmt::format("{} {} of {}", list != nullptr ? "a second list" : "no list, a single value,",
                                trace::in_quotes(property.name), element.name),
                    "one list vertex_indices (or vertex_index)");
            } else {
                list = &property;
            }
        }
        if (list == nullptr && element.count > 0)
            fail("no list vertex_indices of " + element.name, "one (or vertex_index)");
        note_properties(element, is_strip ? "triangle strips" : "faces", others);
        for (std::uint64_t row = 0; row < element.count; ++row)
            for (const PlyProperty& property : element.properties) {
                if (&property != list) {
                    skip(element, row, property);
                } else if (is_strip) {
                    read_strip(element, row, property);
                } else {
                    const std::uint64_t corners = length(element, row, property);
                    for (std::uint64_t c = 0; c < corners; ++c)
                        faces_.corners.push_back(index(element, row, property, false));
                    end_face(element, row);
                }
            }
    }

    void end_face(const PlyElement& element, std::uint64_t row) {
        if (faces_.corners.size() > 3 * most_triangles)
            fail_at(element, row, fmt::format("at most {} corners before the end", 3 * most_triangles));
        faces_.ends.push_back(static_cast<std::uint32_t>(faces_.corners.size()));
    }

    std::uint32_t index(const PlyElement& element, std::uint64_t row, const PlyProperty& property,
                        bool may_restart) {
        const std::optional<double> value = body_.next(*property.value);
        if (may_restart && value && *value == -1) return restart;
        if (!value || *value != std::floor(*value))
            fail_at(element, row, fmt::format("a whole number in {}", trace::in_quotes(property.name)));
        if (!(*value >= 0 && *value < static_cast<double>(vertices_declared_)))
            fail_here(
                fmt::format("the vertex {} in {} {} of {}", *value, element.name, row + 1, element.count),
                vertices_declared_ > 0 ? fmt::format("0 to {}", vertices_declared_ - 1)
                                       : "none: there are none");
        return static_cast<std::uint32_t>(*value);
    }

    // Each vertex makes a triangle with the two before it; every second one is turned round. -1 begins a new
    // strip.
    void read_strip(const PlyElement& element, std::uint64_t row, const PlyProperty& property) {
        const std::uint64_t values = length(element, row, property);
        std::array<std::uint32_t, 2> before{};
        std::uint64_t in_strip = 0;
        const auto note_short = [&] {
            if (in_strip == 1 || in_strip == 2 || values == 0)
                notes_.add("triangle strips of fewer than three corners are left out");
        };
        for (std::uint64_t v = 0; v < values; ++v) {
            const std::uint32_t vertex = index(element, row, property, true);
            if (vertex == restart) {
                note_short();
                in_strip = 0;
                continue;
            }
            if (in_strip >= 2) {
                const bool is_turned = in_strip % 2 != 0;
                faces_.corners.insert(faces_.corners.end(), {before[is_turned], before[!is_turned], vertex});
                end_face(element, row);
            }
            before = {before[1], vertex};
            ++in_strip;
        }
        note_short();
    }

    void note_what_is_left() {
        std::string_view left = body_.left();
        left.remove_prefix(std::min(left.find_first_not_of(" \t\r\n\v\f"), left.size()));
        notes_.add("bytes behind the last element are not read", left.size());
        notes_.add("textures (comments TextureFile) are not read", header_.textures);
    }

    void make_surface() {
        const auto refuse = [&](std::size_t face, const std::string& found, const std::string& expected) {
            throw trace::DataError(fmt::format("{}: face {} of {}: found {}, expected {}", source_.file,
                                               face + 1, faces_.size(), found, expected));
        };
        FaceTriangles filled = triangles_of(faces_, mesh_.surface.vertices, refuse, notes_);
        mesh_.surface.triangles = std::move(filled.triangles);
        mesh_.degenerate_faces = filled.too_few_corners;
        mesh_.triangle_material.assign(mesh_.surface.triangles.size(), 0);
        mesh_.materials.push_back({.name = "default", .terms = MtlTerms{}, .emission = {}});
    }

    const Source& source_;
    PlyHeader header_;
    PlyBody body_;
    std::uint64_t vertices_declared_ = 0;
    Faces faces_;
    Notes notes_;
    Mesh mesh_;
};

}  // namespace

Mesh read_ply(const Source& source) {
    return PlyReader(source).read();
}

}  // namespace regather::meshes
