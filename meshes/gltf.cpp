#include "meshes/gltf.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scenes/document.h"
#include "scenes/loader.h"
#include "scenes/mesh_material.h"
#include "trace/error.h"

namespace regather::scenes {

using nlohmann::json;
using trace::DataError;

namespace {

constexpr std::uintmax_t most_file_bytes = 1ull << 30, most_json_bytes = 1ull << 28;

std::string bytes_of(const std::filesystem::path& file, const std::string& expected) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw DataError(fmt::format("{}: found no file, expected {}", file.string(), expected));
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error || size > most_file_bytes)
        throw DataError(
            fmt::format("{}: found {} bytes, expected at most {}", file.string(), size, most_file_bytes));
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string from_base64(std::string_view text) {
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+'             ? 62
                          : c == '/'             ? 63
                                                 : -1;
        if (value < 0) break;  // The buffer is then shorter than it says, and refused.
        bits = (bits << 6) | static_cast<std::uint32_t>(value);
        if ((count += 6) >= 8) bytes.push_back(static_cast<char>(bits >> (count -= 8)));
    }
    return bytes;
}

/// Rows of an affine map, in doubles.
using Affine = std::array<std::array<double, 4>, 3>;
constexpr Affine identity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

Affine product(const Affine& a, const Affine& b) {
    Affine c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
            if (j == 3) c[i][j] += a[i][3];
        }
    return c;
}

Vec3 moved(const Affine& a, Vec3 p, double w) {
    Vec3 q;
    for (int i = 0; i < 3; ++i) {
        const auto& row = a[static_cast<std::size_t>(i)];
        q[i] = static_cast<float>(row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3] * w);
    }
    return q;
}

// Normals go by the transposed inverse; its cofactors do, for the length does not matter.
Affine cofactors(const Affine& a, double& determinant) {
    Affine c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
        }
    determinant = a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2];
    return c;
}

class Reader {
public:
    explicit Reader(const std::filesystem::path& file) : file_(file) {}

    Mesh read() {
        try {
            open();
            read_materials();
            walk_scene();
        } catch (const json::exception& error) {
            const std::string_view text = error.what();
            fail(fmt::format("damaged JSON ({})", text.substr(std::min(text.size(), text.find("] ") + 2))),
                 "a glTF 2.0 file");
        }
        return std::move(mesh_);
    }

private:
    struct View {
        const char* data;
        std::size_t count, stride;
    };

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw DataError(fmt::format("{}: found {}, expected {}", file_.string(), found, expected));
    }

    // --- JSON with limits ---
    std::uint64_t whole(const json& object, const char* key, std::uint64_t otherwise) const {
        if (!object.contains(key)) return otherwise;
        const json& value = object.at(key);
        if (!value.is_number_unsigned())
            fail(fmt::format("{} = {}", key, in_quotes(value.dump())), "a whole number");
        return value.get<std::uint64_t>();
    }
    double number(const json& object, const char* key, double otherwise) const {
        if (!object.contains(key)) return otherwise;
        const double x = object.at(key).get<double>();
        if (!std::isfinite(x)) fail(fmt::format("{} that is not finite", key), "a number");
        return x;
    }
    template <std::size_t n>
    std::array<double, n> numbers(const json& object, const char* key,
                                  std::array<double, n> otherwise) const {
        if (!object.contains(key)) return otherwise;
        const json& list = object.at(key);
        if (!list.is_array() || list.size() != n)
            fail(fmt::format("{} without {} numbers", key, n), "a list of them");
        for (std::size_t i = 0; i < n; ++i) otherwise[i] = list[i].get<double>();
        return otherwise;
    }
    const json& element(const char* list, std::uint64_t i) const {
        if (!root_.contains(list) || !root_.at(list).is_array() || i >= root_.at(list).size())
            fail(fmt::format("{} {}", list, i),
                 fmt::format("one of {}", root_.contains(list) ? root_.at(list).size() : 0));
        const json& one = root_.at(list)[i];
        if (!one.is_object()) fail(fmt::format("{} {} that is no object", list, i), "an object");
        return one;
    }

    // --- file and buffers ---
    void open() {
        content_ = bytes_of(file_, "a glTF file");
        std::string_view text = content_;
        if (text.substr(0, 4) == "glTF") text = json_chunk();
        if (text.size() > most_json_bytes)
            fail(fmt::format("{} bytes of JSON", text.size()), fmt::format("at most {}", most_json_bytes));
        root_ = json::parse(text.begin(), text.end());
        if (!root_.is_object() || !root_.contains("asset")) fail("no asset in its JSON", "a glTF 2.0 file");
        const std::string version = root_.at("asset").value("version", "");
        if (version.substr(0, 2) != "2.") fail("version " + in_quotes(version), "glTF 2.0");
        if (root_.contains("extensionsRequired"))
            for (const json& extension : root_.at("extensionsRequired")) {
                const std::string& name = extension.get_ref<const std::string&>();
                if (name.rfind("KHR_materials_", 0) != 0 && name != "KHR_texture_transform" &&
                    name.rfind("EXT_texture_", 0) != 0 && name != "KHR_texture_basisu" &&
                    name != "KHR_lights_punctual")
                    fail("the required extension " + in_quotes(name), "a file without it");
            }
        if (root_.contains("buffers"))
            for (std::size_t i = 0; i < root_.at("buffers").size(); ++i) open_buffer(i);
    }

    static std::uint32_t word(std::string_view bytes, std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
        return value;
    }

    // Of a .glb; sets chunk_ to its binary chunk.
    std::string_view json_chunk() {
        const std::string_view bytes = content_;
        if (bytes.size() < 20 || word(bytes, 4) != 2 || word(bytes, 8) > bytes.size() ||
            word(bytes, 16) != 0x4E4F534A || word(bytes, 12) > bytes.size() - 20)
            fail("a GLB header of another version or beyond the file's end", "a whole GLB file");
        const std::size_t length = word(bytes, 12), next = 20 + length;
        if (bytes.size() - next >= 8 && word(bytes, next + 4) == 0x004E4942) {
            if (word(bytes, next) > bytes.size() - next - 8)
                fail("a binary chunk beyond the file's end", "a whole GLB file");
            chunk_ = bytes.substr(next + 8, word(bytes, next));
        }
        return bytes.substr(20, length);
    }

    void open_buffer(std::size_t i) {
        const json& buffer = element("buffers", i);
        const std::uint64_t length = whole(buffer, "byteLength", 0);
        std::string bytes;
        if (!buffer.contains("uri")) {
            bytes = chunk_;
        } else {
            const std::string& uri = buffer.at("uri").get_ref<const std::string&>();
            if (uri.rfind("data:", 0) == 0) {
                const std::size_t mark = uri.find(";base64,");
                if (mark == std::string::npos) fail("a data URI that is not base64", "one that is");
                bytes = from_base64(std::string_view(uri).substr(mark + 8));
            } else {
                bytes = bytes_of(file_.parent_path() / decoded(uri), "a buffer of " + file_.string());
            }
        }
        if (bytes.size() < length)
            fail(fmt::format("buffer {} of {} bytes", i, bytes.size()),
                 fmt::format("the {} that it declares", length));
        total_bytes_ += bytes.size();
        if (total_bytes_ > most_file_bytes) fail("more than 2^30 bytes of buffers", "at most that");
        bytes.resize(length);
        buffers_.push_back(std::move(bytes));
    }

    static std::string decoded(const std::string& uri) {
        const auto digit = [](char c) {
            return c >= '0' && c <= '9'   ? c - '0'
                   : c >= 'a' && c <= 'f' ? c - 'a' + 10
                   : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                          : -1;
        };
        std::string text;
        for (std::size_t i = 0; i < uri.size(); ++i) {
            if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
                text.push_back(static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])));
                i += 2;
            } else {
                text.push_back(uri[i]);
            }
        }
        return text;
    }

    // --- accessors ---
    View view(std::uint64_t index, const char* type, std::size_t element_bytes) const {
        const json& accessor = element("accessors", index);
        const std::string what = fmt::format("accessor {}", index);
        if (accessor.value("type", "") != type)
            fail(what + " of type " + in_quotes(accessor.value("type", "")), type);
        if (accessor.contains("sparse") || !accessor.contains("bufferView"))
            fail(what + " without a bufferView, or sparse", "one with");
        const json& buffer_view = element("bufferViews", whole(accessor, "bufferView", 0));
        const std::uint64_t buffer = whole(buffer_view, "buffer", ~0ull);
        if (buffer >= buffers_.size())
            fail(fmt::format("buffer {}", buffer), fmt::format("one of {}", buffers_.size()));
        const std::uint64_t in_view = whole(accessor, "byteOffset", 0),
                            start = whole(buffer_view, "byteOffset", 0);
        const std::uint64_t length = whole(buffer_view, "byteLength", 0), count = whole(accessor, "count", 0);
        const std::uint64_t stride = whole(buffer_view, "byteStride", element_bytes);
        const std::uint64_t bytes = buffers_[buffer].size();
        if (start > bytes || length > bytes - start)
            fail(fmt::format("a bufferView of {} bytes at {}", length, start),
                 fmt::format("at most the buffer's {}", bytes));
        if (stride < element_bytes || stride > 1024)
            fail(fmt::format("byteStride {}", stride), fmt::format("{} to 1024", element_bytes));
        if (count > 0 && (in_view > length || length - in_view < element_bytes ||
                          count - 1 > (length - in_view - element_bytes) / stride))
            fail(fmt::format("{} of {} elements at byte {}", what, count, in_view),
                 fmt::format("what fits the {} bytes of its bufferView", length));
        return {buffers_[buffer].data() + start + in_view, count, stride};
    }

    std::vector<Vec3> points(std::uint64_t accessor) const {
        if (whole(element("accessors", accessor), "componentType", 0) != 5126)
            fail(fmt::format("accessor {} that is not float", accessor), "floats");
        const View all = view(accessor, "VEC3", 12);
        std::vector<Vec3> values(all.count);
        for (std::size_t i = 0; i < all.count; ++i)
            for (int c = 0; c < 3; ++c) {
                std::uint32_t bits = 0;
                std::memcpy(&bits, all.data + i * all.stride + 4 * static_cast<std::size_t>(c), 4);
                values[i][c] = std::bit_cast<float>(bits);
            }
        return values;
    }

    std::vector<std::uint32_t> indices(std::uint64_t accessor, std::size_t vertices) const {
        const std::uint64_t type = whole(element("accessors", accessor), "componentType", 0);
        const std::size_t bytes = type == 5121 ? 1 : type == 5123 ? 2 : type == 5125 ? 4 : 0;
        if (bytes == 0) fail(fmt::format("indices of component type {}", type), "5121, 5123 or 5125");
        const View all = view(accessor, "SCALAR", bytes);
        std::vector<std::uint32_t> values(all.count);
        for (std::size_t i = 0; i < all.count; ++i) {
            std::memcpy(&values[i], all.data + i * all.stride, bytes);
            if (values[i] >= vertices)
                fail(fmt::format("index {} of {} vertices", values[i], vertices), "one below");
        }
        return values;
    }

    // --- materials ---
    void read_materials() {
        if (!root_.contains("materials")) return;
        for (std::size_t i = 0; i < root_.at("materials").size(); ++i) {
            const json& material = element("materials", i);
            MetallicRoughness terms;
            const json none = json::object();
            const json& surface =
                material.contains("pbrMetallicRoughness") ? material.at("pbrMetallicRoughness") : none;
            const auto color = numbers<4>(surface, "baseColorFactor", {1, 1, 1, 1});
            terms.base_color = {static_cast<float>(color[0]), static_cast<float>(color[1]),
                                static_cast<float>(color[2])};
            if (material.value("alphaMode", "OPAQUE") == "BLEND") terms.alpha = static_cast<float>(color[3]);
            terms.metallic = static_cast<float>(number(surface, "metallicFactor", 1));
            terms.roughness = static_cast<float>(number(surface, "roughnessFactor", 1));
            const json& extensions = material.contains("extensions") ? material.at("extensions") : none;
            if (extensions.contains("KHR_materials_transmission"))
                terms.transmission = static_cast<float>(
                    number(extensions.at("KHR_materials_transmission"), "transmissionFactor", 0));
            if (extensions.contains("KHR_materials_ior"))
                terms.index_of_refraction =
                    static_cast<float>(number(extensions.at("KHR_materials_ior"), "ior", 1.5));
            mesh_.materials.push_back(
                material_of(material.value("name", fmt::format("material {}", i)), terms));
        }
    }

    std::uint32_t material(const json& primitive) {
        if (primitive.contains("material")) {
            const std::uint64_t index = whole(primitive, "material", 0);
            element("materials", index);
            return static_cast<std::uint32_t>(index);
        }
        if (!grey_) {
            grey_ = static_cast<std::uint32_t>(mesh_.materials.size());
            mesh_.materials.push_back({.name = "default"});
        }
        return *grey_;
    }

    // --- nodes ---
    void walk_scene() {
        const std::size_t count = root_.contains("nodes") ? root_.at("nodes").size() : 0;
        std::vector<char> visited(count);
        struct Visit {
            std::uint64_t node;
            Affine place;
        };
        std::vector<Visit> open;
        const json& scene = element("scenes", whole(root_, "scene", 0));
        const auto push = [&](const json& list, const Affine& place) {
            if (!list.is_array()) fail("nodes that are no list", "a list");
            for (std::size_t i = list.size(); i-- > 0;) {
                if (!list[i].is_number_unsigned())
                    fail("a node " + in_quotes(list[i].dump()), "a whole number");
                open.push_back({list[i].get<std::uint64_t>(), place});
            }
        };
        if (scene.contains("nodes")) push(scene.at("nodes"), identity);
        while (!open.empty()) {
            const Visit visit = open.back();
            open.pop_back();
            const json& node = element("nodes", visit.node);
            if (visited[visit.node])
                fail(fmt::format("node {} in two places", visit.node), "nodes that make trees");
            visited[visit.node] = 1;
            const Affine place = product(visit.place, place_of(node));
            if (node.contains("mesh")) add_mesh(element("meshes", whole(node, "mesh", 0)), place);
            if (node.contains("children")) push(node.at("children"), place);
        }
    }

    Affine place_of(const json& node) const {
        Affine place = identity;
        if (node.contains("matrix")) {
            const auto m = numbers<16>(node, "matrix", {});
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 4; ++j) place[i][j] = m[4 * j + i];
            return place;
        }
        const auto t = numbers<3>(node, "translation", {0, 0, 0});
        const auto s = numbers<3>(node, "scale", {1, 1, 1});
        const auto [x, y, z, w] = numbers<4>(node, "rotation", {0, 0, 0, 1});
        const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) place[i][j] = r[i][j] * s[j];
            place[i][3] = t[i];
        }
        return place;
    }

    void add_mesh(const json& mesh, const Affine& place) {
        for (const json& primitive : mesh.at("primitives")) {
            const std::uint64_t mode = whole(primitive, "mode", 4);
            if (mode < 4) continue;  // Points and lines.
            if (mode > 6) fail(fmt::format("mode {}", mode), "0 to 6");
            const json& attributes = primitive.at("attributes");
            if (!attributes.contains("POSITION")) continue;
            const std::vector<Vec3> vertices = points(whole(attributes, "POSITION", 0));
            std::vector<std::uint32_t> order;
            if (primitive.contains("indices")) {
                order = indices(whole(primitive, "indices", 0), vertices.size());
            } else {
                for (std::size_t i = 0; i < vertices.size(); ++i)
                    order.push_back(static_cast<std::uint32_t>(i));
            }
            std::vector<Vec3> normals;
            if (attributes.contains("NORMAL")) normals = points(whole(attributes, "NORMAL", 0));
            normals.resize(vertices.size());
            append(vertices, normals, order, mode, place, material(primitive));
        }
    }

    void append(const std::vector<Vec3>& vertices, const std::vector<Vec3>& normals,
                const std::vector<std::uint32_t>& order, std::uint64_t mode, const Affine& place,
                std::uint32_t material) {
        Surface& surface = mesh_.surface;
        const std::size_t count = mode == 4 ? order.size() / 3 : order.size() < 3 ? 0 : order.size() - 2;
        // Nodes may share a mesh and primitives an accessor: a small file can ask for any number of them.
        if (surface.triangles.size() + count > most_triangles ||
            surface.vertices.size() + vertices.size() > 3 * most_triangles)
            fail(fmt::format("more than {} triangles", most_triangles), "at most as many");
        double determinant = 0;
        const Affine turn = cofactors(place, determinant);
        const auto first = static_cast<std::uint32_t>(surface.vertices.size());
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            surface.vertices.push_back(moved(place, vertices[i], 1));
            Vec3 normal = moved(turn, normals[i], 0) * (determinant < 0 ? -1.0f : 1.0f);
            normal = trace::normalize(normal);
            surface.normals.push_back(trace::is_finite(normal) ? normal : Vec3{});
        }
        for (std::size_t t = 0; t < count; ++t) {
            std::array<std::size_t, 3> at{3 * t, 3 * t + 1, 3 * t + 2};
            if (mode == 5) at = t % 2 == 0 ? std::array{t, t + 1, t + 2} : std::array{t + 1, t, t + 2};
            if (mode == 6) at = {0, t + 1, t + 2};
            if (determinant < 0) std::swap(at[1], at[2]);
            surface.triangles.push_back({first + order[at[0]], first + order[at[1]], first + order[at[2]]});
            mesh_.triangle_material.push_back(material);
        }
    }

    std::filesystem::path file_;
    std::string content_;
    std::string_view chunk_;
    json root_;
    std::vector<std::string> buffers_;
    std::uintmax_t total_bytes_ = 0;
    std::optional<std::uint32_t> grey_;
    Mesh mesh_;
};

}  // namespace

Mesh read_gltf(const std::filesystem::path& file) {
    return Reader(file).read();
}

}  // namespace regather::scenes
