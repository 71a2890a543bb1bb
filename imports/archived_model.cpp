#include "imports/archived_model.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>

#include "imports/java3d_materials.h"
#include "imports/texture_colour.h"
#include "meshes/mesh.h"
#include "meshes/obj.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::imports {

using scenes::Mesh;
using scenes::MtlTerms;
using scenes::ObjContents;
using trace::DataError;

namespace {

namespace fs = std::filesystem;

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

}  // namespace

Model read_model(const Zip& zip, const std::string& name) {
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
    Model model;
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

}  // namespace regather::imports
