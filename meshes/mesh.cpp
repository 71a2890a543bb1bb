#include "meshes/mesh.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <fmt/format.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "meshes/gltf.h"
#include "meshes/obj.h"
#include "meshes/ply.h"
#include "scenes/document.h"
#include "scenes/mesh_material.h"
#include "trace/error.h"

namespace regather::scenes {

using trace::DataError;

namespace {

constexpr std::uintmax_t most_file_bytes = 1ull << 30;

// Assimp guesses by content too: with the other importers gone, a .ply is a PLY file or refused.
void keep_only(Assimp::Importer& importer, const std::string& extension) {
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        Assimp::BaseImporter* one = importer.GetImporter(i);
        std::set<std::string> extensions;
        one->GetExtensionList(extensions);
        if (extensions.count(extension) == 0) {
            importer.UnregisterLoader(one);
            delete one;
        }
    }
}

// Assimp's reason in one line.
std::string reason(const Assimp::Importer& importer) {
    std::string text = importer.GetErrorString();
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 32) c = ' ';
    return text.empty() ? "no reason given" : text;
}

// Opens what has been checked, and nothing else: a library's name may lead anywhere.
class CheckedFiles : public Assimp::DefaultIOSystem {
public:
    void allow(const std::filesystem::path& file) { allowed_.insert(file.lexically_normal()); }
    bool Exists(const char* file) const override { return is_allowed(file) && DefaultIOSystem::Exists(file); }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        return is_allowed(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
    }

private:
    bool is_allowed(const char* file) const {
        return allowed_.count(std::filesystem::path(file).lexically_normal()) > 0;
    }
    std::set<std::filesystem::path> allowed_;
};

std::string content_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error || bytes > most_file_bytes)
        throw DataError(
            fmt::format("{}: found {} bytes, expected at most {}", file.string(), bytes, most_file_bytes));
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// Refuses a damaged OBJ or library; tells the first library that is not there.
std::string check_obj_and_libraries(const std::filesystem::path& file, CheckedFiles& files) {
    const ObjContents contents = check_obj(content_of(file));
    if (!contents.damage.empty())
        throw DataError(
            fmt::format("{}: found {}, expected a whole OBJ file", file.string(), contents.damage));
    std::string missing;
    for (const std::string& name : contents.libraries) {
        std::filesystem::path library = file.parent_path() / name;
        std::error_code error;
        if (!std::filesystem::is_regular_file(library, error)) {
            // Assimp looks there next.
            library = std::filesystem::path(file).replace_extension(".mtl");
            if (!std::filesystem::is_regular_file(library, error)) {
                if (missing.empty()) missing = name;
                continue;
            }
        }
        if (const std::string damage = mtl_damage(content_of(library)); !damage.empty())
            throw DataError(fmt::format("{}: found {}, expected a whole MTL file", library.string(), damage));
        files.allow(library);
    }
    return missing;
}

Vec3 color_of(const aiMaterial& from, const char* key, unsigned type, unsigned index, Vec3 otherwise) {
    aiColor3D color;
    return from.Get(key, type, index, color) == aiReturn_SUCCESS ? Vec3{color.r, color.g, color.b}
                                                                 : otherwise;
}

Material own_material(const aiMaterial& from) {
    aiString name;
    if (from.Get(AI_MATKEY_NAME, name) != aiReturn_SUCCESS ||
        std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME)
        return {.name = "default"};
    MtlTerms terms;
    terms.kd = color_of(from, AI_MATKEY_COLOR_DIFFUSE, terms.kd);
    terms.ks = color_of(from, AI_MATKEY_COLOR_SPECULAR, terms.ks);
    from.Get(AI_MATKEY_SHININESS, terms.ns);
    from.Get(AI_MATKEY_OPACITY, terms.d);
    from.Get(AI_MATKEY_REFRACTI, terms.ni);
    from.Get("$mat.illum", 0, 0, terms.illum);
    return material_of(name.C_Str(), terms);
}

void append(Mesh& mesh, const aiMesh& part) {
    Surface& surface = mesh.surface;
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
        const aiVector3D& p = part.mVertices[v];
        surface.vertices.push_back({p.x, p.y, p.z});
        Vec3 normal;
        if (part.HasNormals()) {
            const aiVector3D& n = part.mNormals[v];
            normal = trace::normalize({n.x, n.y, n.z});
            if (!trace::is_finite(normal)) normal = {};
        }
        surface.normals.push_back(normal);
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        const aiFace& face = part.mFaces[f];
        if (face.mNumIndices == 3) {
            surface.triangles.push_back(
                {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
            mesh.triangle_material.push_back(part.mMaterialIndex);
        } else {
            ++mesh.degenerate_faces;
        }
    }
}

Mesh read_by_assimp(const std::filesystem::path& file, const std::string& extension) {
    const std::string name = file.string();
    CheckedFiles* files = new CheckedFiles;  // The importer owns it.
    Assimp::Importer importer;
    importer.SetIOHandler(files);
    files->allow(file);
    Mesh mesh;
    if (extension == ".ply") {
        if (const std::string damage = ply_damage(content_of(file)); !damage.empty())
            throw DataError(fmt::format("{}: found {}, expected a whole PLY file", name, damage));
    } else {
        mesh.missing_library = check_obj_and_libraries(file, *files);
    }
    keep_only(importer, extension.substr(1));
    // Validation comes first and refuses indices beyond the vertices, before anything follows them.
    const aiScene* scene = importer.ReadFile(
        name, aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_JoinIdenticalVertices);
    if (scene == nullptr) throw DataError(fmt::format("{}: found damaged data ({})", name, reason(importer)));
    for (unsigned m = 0; m < scene->mNumMaterials; ++m)
        mesh.materials.push_back(own_material(*scene->mMaterials[m]));
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) append(mesh, *scene->mMeshes[m]);
    return mesh;
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool is_gltf = extension == ".gltf" || extension == ".glb";
    if (extension != ".obj" && extension != ".ply" && !is_gltf)
        throw DataError(fmt::format("{}: found the extension {}, expected .obj, .ply, .gltf or .glb", name,
                                    in_quotes(extension)));
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw DataError(fmt::format("{}: found no file, expected an OBJ, PLY or glTF mesh", name));
    Mesh mesh = is_gltf ? read_gltf(file) : read_by_assimp(file, extension);
    for (const Vec3 p : mesh.surface.vertices)
        if (!trace::is_finite(p))
            throw DataError(fmt::format("{}: found a vertex that is not finite, expected numbers", name));
    mesh.degenerate_faces += drop_degenerate(mesh.surface, &mesh.triangle_material);
    if (mesh.surface.triangles.empty())
        throw DataError(fmt::format("{}: found no triangle with an area, expected at least one", name));
    return mesh;
}

}  // namespace regather::scenes
