#include "imports/archived_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "imports/java3d_materials.h"
#include "imports/texture_colour.h"
#include "meshes/mesh.h"
#include "scenes/mesh_material.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {

using scenes::MtlTerms;
using trace::DataError;

namespace {

namespace fs = std::filesystem;

std::string text_of(const std::vector<std::uint8_t>& bytes) {
    return {bytes.begin(), bytes.end()};
}

// "sweethome3d_window_pane_2" -> pane_material; "" for other groups.
std::string_view special_group(std::string_view group) {
    for (const std::string_view name : {pane_material, mirror_material})
        if (group.find(name) != std::string_view::npos) return name;
    return "";
}

bool is_readable_image(const std::string& name) {
    std::string ending = fs::path(name).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".jpg" || ending == ".png" || ending == ".tga";
}

// A texture is its mean colour here. Glass stays clear.
void take_texture(Material& material, const std::string& texture, const Zip& zip, const std::string& folder) {
    if (texture.empty() || !is_readable_image(texture)) return;
    if (material.kind != MaterialKind::diffuse && material.kind != MaterialKind::glossy) return;
    const std::string entry = folder + texture;
    material.diffuse = mean_colour(zip.read(entry, most_model_bytes),
                                   fmt::format("{}: {}", zip.archive(), trace::shown(entry, 200)));
}

Material special_material(std::string_view group) {
    if (group == pane_material)
        return {.name = "pane", .kind = MaterialKind::dielectric, .diffuse = {}, .index_of_refraction = 1.5f};
    return {.name = "mirror", .kind = MaterialKind::mirror, .diffuse = {}, .specular = {0.9f, 0.9f, 0.9f}};
}

Material own(const meshes::Material& read) {
    if (!read.is_described)
        if (const MtlTerms* terms = java3d_material(read.name)) return scenes::material_of(read.name, *terms);
    return scenes::material_of(read);
}

// Those of the mesh; of the materials that no library describes only those that Java 3D does not describe
// either.
std::vector<std::string> notes_of(const meshes::Mesh& mesh) {
    constexpr std::string_view grey = "materials that no library describes are grey";
    std::vector<std::string> notes;
    for (const std::string& note : mesh.notes)
        if (!note.starts_with(grey)) notes.push_back(note);
    const auto count =
        std::count_if(mesh.materials.begin(), mesh.materials.end(), [](const meshes::Material& m) {
            return !m.is_described && java3d_material(m.name) == nullptr && special_group(m.name).empty();
        });
    if (count > 0) notes.push_back(fmt::format("{}: {}", grey, count));
    return notes;
}

}  // namespace

Model read_model(const Zip& zip, const std::string& name) {
    std::string entry = name;
    while (!entry.empty() && entry.front() == '/') entry.erase(0, 1);
    const std::string folder = entry.substr(0, entry.rfind('/') + 1);  // npos + 1 = 0
    const std::string text = text_of(zip.read(entry, most_model_bytes));
    const std::string file = fmt::format("{}: {}", zip.archive(), trace::shown(entry, 200));
    const auto path_of = [&](const std::string& library) {
        const fs::path path(library);
        if (path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
            throw DataError(fmt::format("{}: found the material library {}, expected one beside the model",
                                        file, trace::in_quotes(library)));
        return folder + library;
    };
    const meshes::Mesh mesh = meshes::parse_mesh(
        meshes::Format::obj,
        {.bytes = text,
         .file = file,
         .stem = {},
         .has_beside = [&](const std::string& library) { return zip.has(path_of(library)); },
         .read_beside = [&](const std::string& library) -> meshes::Neighbour {
             return {fmt::format("{}: {}", zip.archive(), trace::shown(path_of(library), 200)),
                     text_of(zip.read(path_of(library), most_model_bytes))};
         }});

    // The faces of special groups have their group's material: a tag each behind those of the materials.
    const auto materials = static_cast<std::uint32_t>(mesh.materials.size());
    std::vector<std::uint32_t> tags = mesh.triangle_material;
    for (std::size_t t = 0; t < tags.size(); ++t)
        if (const std::string_view special = special_group(mesh.groups[mesh.triangle_group[t]]);
            !special.empty())
            tags[t] = materials + (special == pane_material ? 0 : 1);
    Model model;
    model.notes = notes_of(mesh);
    const auto unread = std::count_if(
        mesh.materials.begin(), mesh.materials.end(),
        [](const meshes::Material& m) { return !m.texture.empty() && !is_readable_image(m.texture); });
    if (unread > 0)
        model.notes.push_back(
            fmt::format("textures that are neither .jpg, .png nor .tga are not read: {}", unread));
    for (std::uint32_t tag = 0; tag < materials + 2; ++tag) {
        Surface surface = triangles_with(mesh.surface, tags, tag);
        if (surface.triangles.empty()) continue;
        Material material = tag < materials
                                ? own(mesh.materials[tag])
                                : special_material(tag == materials ? pane_material : mirror_material);
        if (tag < materials) take_texture(material, mesh.materials[tag].texture, zip, folder);
        model.parts.push_back({std::move(material), std::move(surface)});
    }
    return model;
}

}  // namespace regather::imports
