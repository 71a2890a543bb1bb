#include "meshes/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "meshes/gltf.h"
#include "meshes/obj.h"
#include "meshes/ply.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/text.h"

namespace regather::meshes {

using trace::DataError;

namespace {

constexpr std::uintmax_t most_file_bytes = 1ull << 30;

std::string shown(const std::filesystem::path& file) {
    return trace::shown(file.string(), trace::most_shown_path);
}

bool is_file(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

std::string content_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error || bytes > most_file_bytes)
        throw DataError(error ? fmt::format("{}: found a file that cannot be read", shown(file))
                              : fmt::format("{}: found {} bytes, expected at most {}", shown(file), bytes,
                                            most_file_bytes));
    return trace::read_file(file);
}

// How many they are. Keeps the groups beside the triangles.
std::uint64_t drop_triangles_without_area(Mesh& mesh) {
    if (mesh.triangle_group.empty()) return drop_degenerate(mesh.surface, &mesh.triangle_material);
    std::vector<std::uint32_t> kept(mesh.surface.triangles.size());
    for (std::uint32_t t = 0; t < kept.size(); ++t) kept[t] = t;
    const std::uint64_t dropped = drop_degenerate(mesh.surface, &kept);
    for (std::size_t t = 0; t < kept.size(); ++t) {
        mesh.triangle_material[t] = mesh.triangle_material[kept[t]];
        mesh.triangle_group[t] = mesh.triangle_group[kept[t]];
    }
    mesh.triangle_material.resize(kept.size());
    mesh.triangle_group.resize(kept.size());
    return dropped;
}

}  // namespace

Mesh parse_mesh(Format format, const Source& source) {
    Mesh mesh = format == Format::obj   ? read_obj(source)
                : format == Format::ply ? read_ply(source)
                                        : read_gltf(source);
    if (const std::uint64_t dropped = drop_triangles_without_area(mesh); dropped > 0) {
        mesh.degenerate_faces += dropped;
        mesh.notes.push_back(fmt::format("triangles without area are left out: {}", dropped));
    }
    drop_unused_vertices(mesh.surface);
    if (mesh.surface.triangles.empty())
        throw DataError(
            fmt::format("{}: found no triangle with an area, expected at least one", source.file));
    return mesh;
}

std::optional<Format> format_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (extension == ".obj") return Format::obj;
    if (extension == ".ply") return Format::ply;
    if (extension == ".gltf" || extension == ".glb") return Format::gltf;
    return std::nullopt;
}

Mesh read_mesh(const std::filesystem::path& file) {
    const std::optional<Format> format = format_of(file);
    if (!format)
        throw DataError(fmt::format("{}: found the extension {}, expected .obj, .ply, .gltf or .glb",
                                    shown(file), trace::in_quotes(file.extension().string())));
    if (!is_file(file))
        throw DataError(fmt::format("{}: found no file, expected an OBJ, PLY or glTF mesh", shown(file)));
    const std::string bytes = content_of(file);
    const std::filesystem::path folder = file.parent_path();
    return parse_mesh(*format, {.bytes = bytes,
                                .file = file.string(),
                                .stem = file.stem().string(),
                                .has_beside = [&](const std::string& name) { return is_file(folder / name); },
                                .read_beside = [&](const std::string& name) -> Neighbour {
                                    return {(folder / name).string(), content_of(folder / name)};
                                }});
}

}  // namespace regather::meshes
