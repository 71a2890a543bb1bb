#include "imports/homes/furniture.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>

#include "imports/homes/java3d_materials.h"
#include "imports/texture_colour.h"
#include "meshes/mesh.h"
#include "meshes/obj.h"
#include "meshes/weld.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::imports {

using scenes::Mesh;
using scenes::MtlTerms;
using scenes::ObjContents;
using trace::DataError;

namespace {

namespace fs = std::filesystem;

constexpr float most_reflected = 0.9f;  // No paint reflects more.
constexpr double crease_degrees = 40;
constexpr float pane_thickness = 0.004f;  // [m] Of glass that is a sheet in the model.
constexpr double least_size = 1e-6;       // Of a model's box, as a share of its largest extent.

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (fs::temp_directory_path() / "regather-model-XXXXXX").string();
        if (!::mkdtemp(pattern.data()))
            throw std::runtime_error(fmt::format("{}: cannot create a folder", pattern));
        path_ = pattern;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

std::string text_of(const std::vector<std::uint8_t>& bytes) {
    return {bytes.begin(), bytes.end()};
}

template <class See>
void each_line(std::string_view text, See see) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        see(line);
    }
}

// "g sweethome3d_window_pane_2" -> pane_material; "" for other groups.
std::string_view special_group(std::string_view line) {
    for (const std::string_view name : {pane_material, mirror_material})
        if (line.find(name) != std::string_view::npos) return name;
    return "";
}

// The same model in which groups of panes and mirrors have those materials.
std::string with_group_materials(std::string_view text) {
    if (special_group(text).empty()) return std::string(text);
    std::string result;
    std::string_view special, last_material;
    each_line(text, [&](std::string_view line) {
        if (line.starts_with("usemtl")) {
            last_material = line;
            if (!special.empty()) return;
        }
        result.append(line) += '\n';
        if (!line.starts_with("g ") && !line.starts_with("o ")) return;
        const std::string_view before = special;
        special = special_group(line);
        if (!special.empty())
            result.append("usemtl ").append(special) += '\n';
        else if (!before.empty() && !last_material.empty())
            result.append(last_material) += '\n';
    });
    return result;
}

// What a library says of a material beyond what meshes/mesh.h reads.
struct Defined {
    std::string texture;  // map_Kd, "" for none
};
using DefinedMaterials = std::map<std::string, Defined, std::less<>>;

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

DefinedMaterials defined_materials(std::string_view library) {
    DefinedMaterials materials;
    Defined* last = nullptr;
    each_line(library, [&](std::string_view line) {
        line = trimmed(line);
        if (line.starts_with("newmtl ")) last = &materials[std::string(trimmed(line.substr(7)))];
        if (last && line.starts_with("map_Kd ")) last->texture = std::string(trimmed(line.substr(7)));
    });
    return materials;
}

bool is_readable_image(const std::string& name) {
    std::string ending = fs::path(name).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".jpg" || ending == ".png" || ending == ".tga";
}

// A texture is its mean colour here. Glass stays clear.
void take_texture(Material& material, const Defined& defined, const Zip& zip, const std::string& folder) {
    if (defined.texture.empty() || !is_readable_image(defined.texture)) return;
    if (material.kind != MaterialKind::diffuse && material.kind != MaterialKind::glossy) return;
    const std::string entry = folder + defined.texture;
    material.diffuse =
        mean_colour(zip.read(entry, most_model_bytes), fmt::format("{}: {}", zip.archive(), entry));
}

Material own(const Material& read, const DefinedMaterials& defined) {
    if (read.name == pane_material)
        return {.name = "pane", .kind = MaterialKind::dielectric, .diffuse = {}, .index_of_refraction = 1.5f};
    if (read.name == mirror_material)
        return {
            .name = "mirror", .kind = MaterialKind::mirror, .diffuse = {}, .specular = {0.9f, 0.9f, 0.9f}};
    if (!defined.contains(read.name))
        if (const MtlTerms* terms = java3d_material(read.name)) return material_of(read.name, *terms);
    return read;
}

// A 3 x 3 matrix by rows.
using Matrix = std::array<double, 9>;

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return c;
}

using Point = std::array<double, 3>;
Point times(const Matrix& m, Point p) {
    return {m[0] * p[0] + m[1] * p[1] + m[2] * p[2], m[3] * p[0] + m[4] * p[1] + m[5] * p[2],
            m[6] * p[0] + m[7] * p[1] + m[8] * p[2]};
}

Matrix about_x(double a) {
    return {1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a)};
}
Matrix about_y(double a) {
    return {std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a)};
}
Matrix about_z(double a) {
    return {std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1};
}

struct ModelBox {
    Point min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};
    void include(const Point& p) {
        for (std::size_t i = 0; i < 3; ++i) {
            min[i] = std::min(min[i], p[i]);
            max[i] = std::max(max[i], p[i]);
        }
    }
    double middle(std::size_t i) const { return (min[i] + max[i]) / 2; }
    double size(std::size_t i) const { return max[i] - min[i]; }
};

ModelBox box_of(const FurnitureModel& model, const Matrix& turn) {
    ModelBox box;
    for (const FurnitureModel::Part& part : model.parts)
        for (const Vec3 p : part.surface.vertices) box.include(times(turn, {p.x, p.y, p.z}));
    return box;
}

// The inverse of a diagonal or rotation matrix, transposed: what normals are turned with. By cofactors.
Matrix for_normals(const Matrix& m) {
    return {m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6],
            m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6], m[1] * m[6] - m[0] * m[7],
            m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3]};
}

}  // namespace

Surface triangles_with(const Surface& all, const std::vector<std::uint32_t>& tags, std::uint32_t tag) {
    Surface part;
    std::vector<std::uint32_t> index(all.vertices.size(), ~0u);
    for (std::size_t t = 0; t < all.triangles.size(); ++t) {
        if (tags[t] != tag) continue;
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = all.triangles[t][c];
            if (index[v] == ~0u) {
                index[v] = static_cast<std::uint32_t>(part.vertices.size());
                part.vertices.push_back(all.vertices[v]);
                part.normals.push_back(v < all.normals.size() ? all.normals[v] : Vec3{});
            }
            triangle[c] = index[v];
        }
        part.triangles.push_back(triangle);
    }
    return part;
}

std::uint64_t FurnitureModel::triangles() const {
    std::uint64_t count = 0;
    for (const Part& part : parts) count += part.surface.triangles.size();
    return count;
}

FurnitureModel read_furniture(const Zip& zip, const std::string& name) {
    std::string entry = name;
    while (!entry.empty() && entry.front() == '/') entry.erase(0, 1);
    const std::string folder = entry.substr(0, entry.rfind('/') + 1);  // npos + 1 = 0
    const std::string text = with_group_materials(text_of(zip.read(entry, most_model_bytes)));
    const auto fail = [&](std::string_view found, std::string_view expected) {
        throw DataError(fmt::format("{}: {}: found {}, expected {}", zip.archive(), entry, found, expected));
    };
    const ObjContents contents = scenes::check_obj(text);
    if (!contents.damage.empty()) fail(contents.damage, "a whole OBJ model");

    const TemporaryFolder temporary;
    trace::write_whole(temporary.path() / "model.obj", text);
    DefinedMaterials defined;
    for (const std::string& library : contents.libraries) {
        const fs::path path(library);
        if (path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
            fail(fmt::format("the material library {}", library), "one beside the model");
        if (!zip.has(folder + library)) continue;
        const std::string bytes = text_of(zip.read(folder + library, most_model_bytes));
        trace::write_whole(temporary.path() / path, bytes);
        defined.merge(defined_materials(bytes));
    }
    Mesh mesh;
    try {
        mesh = scenes::read_mesh(temporary.path() / "model.obj");
    } catch (const DataError& error) {
        std::string_view why = error.what();  // the temporary folder's name says nothing to anybody
        const std::size_t found = why.find(": ");
        if (found != std::string_view::npos) why.remove_prefix(found + 2);
        throw DataError(fmt::format("{}: {}: {}", zip.archive(), entry, why));
    }
    FurnitureModel model;
    for (std::uint32_t m = 0; m < mesh.materials.size(); ++m) {
        Surface surface = triangles_with(mesh.surface, mesh.triangle_material, m);
        if (surface.triangles.empty()) continue;
        Material material = own(mesh.materials[m], defined);
        if (const auto found = defined.find(mesh.materials[m].name); found != defined.end())
            take_texture(material, found->second, zip, folder);
        model.parts.push_back({std::move(material), std::move(surface)});
    }
    return model;
}

std::uint32_t MaterialTable::index_of(Material material) {
    for (int channel = 0; channel < 3; ++channel) {
        const float sum = material.diffuse[channel] + material.specular[channel];
        if (sum <= most_reflected) continue;
        material.diffuse[channel] *= most_reflected / sum;
        material.specular[channel] *= most_reflected / sum;
    }
    material.name = plain_name(material.name.substr(0, 40));
    const std::string value = fmt::format(
        "{} {} {} {} {} {} {} {} {} {}", material.name, static_cast<int>(material.kind), material.diffuse.x,
        material.diffuse.y, material.diffuse.z, material.specular.x, material.specular.y, material.specular.z,
        material.exponent, material.index_of_refraction);
    const auto [entry, is_new] = by_value_.emplace(value, static_cast<std::uint32_t>(materials_.size()));
    if (!is_new) return entry->second;
    if (const int uses = uses_of_name_[material.name]++; uses > 0)
        material.name += fmt::format("~{}", uses + 1);
    materials_.push_back(std::move(material));
    return entry->second;
}

Vec3 linear(Rgb8 color) {
    Vec3 light;
    for (int channel = 0; channel < 3; ++channel) {
        const double value = color[static_cast<std::size_t>(channel)] / 255.0;
        light[channel] =
            static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
    }
    return light;
}

Material painted(const std::string& name, Rgb8 color, double shininess) {
    Material material{.name = name, .diffuse = linear(color)};
    if (shininess < 0.05) return material;
    const auto specular = static_cast<float>(0.25 * shininess);
    material.kind = MaterialKind::glossy;
    material.diffuse = material.diffuse * (1 - specular);
    material.specular = {specular, specular, specular};
    material.exponent = static_cast<float>(std::max(1.0, 128 * shininess));
    return material;
}

std::vector<FurnitureModel::Part> placed(const FurnitureModel& model, const Placement& placement) {
    constexpr Matrix identity{1, 0, 0, 0, 1, 0, 0, 0, 1};
    const Matrix first = placement.model_rotation.value_or(identity);
    const ModelBox box = box_of(model, first);
    const double largest = std::max({box.size(0), box.size(1), box.size(2)});
    const auto factor = [&](std::size_t axis, double size) {
        return box.size(axis) > least_size * largest ? size / box.size(axis) : 1;
    };
    const double x = factor(0, placement.width) * (placement.mirrored ? -1 : 1);
    const Matrix scale{x, 0, 0, 0, factor(1, placement.height), 0, 0, 0, factor(2, placement.depth)};
    const Matrix turn =
        product(about_y(-placement.angle), product(about_x(-placement.pitch), about_z(-placement.roll)));
    const Matrix shape = product(scale, first);
    const Matrix all = product(turn, shape);
    const Matrix normals = for_normals(all);
    const ModelBox turned = box_of(model, all);

    std::vector<FurnitureModel::Part> parts = model.parts;
    for (FurnitureModel::Part& part : parts) {
        for (Vec3& p : part.surface.vertices) {
            const Point q = times(all, {p.x, p.y, p.z});
            p = {static_cast<float>(q[0] - turned.middle(0) + placement.foot[0]),
                 static_cast<float>(turned.middle(2) - q[2] + placement.foot[1]),
                 static_cast<float>(q[1] - turned.min[1] + placement.foot[2])};
        }
        for (Vec3& n : part.surface.normals) {
            if (n == Vec3{}) continue;
            const Point q = times(normals, {n.x, n.y, n.z});
            const double size = std::hypot(q[0], q[1], q[2]) * (placement.mirrored ? -1 : 1);
            n = size != 0 ? Vec3{static_cast<float>(q[0] / size), static_cast<float>(-q[2] / size),
                                 static_cast<float>(q[1] / size)}
                          : Vec3{};
        }
        if (placement.mirrored)
            for (auto& triangle : part.surface.triangles) std::swap(triangle[1], triangle[2]);
    }
    return parts;
}

void add_parts(std::vector<FurnitureModel::Part> parts, MaterialTable& table, ImportedScene& scene) {
    for (FurnitureModel::Part& part : parts) {
        if (part.material.kind == MaterialKind::dielectric)
            part.surface = as_solid(part.surface, pane_thickness);
        const std::uint32_t material = table.index_of(std::move(part.material));
        scene.meshes.push_back({material, with_smooth_normals(part.surface, crease_degrees)});
    }
}

}  // namespace regather::imports
