#include "scenes/mesh.h"

#include <assimp/BaseImporter.h>
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

#include "scenes/ply.h"
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
        if (face.mNumIndices == 3)
            surface.triangles.push_back(
                {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
        else
            ++mesh.degenerate_faces;
    }
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != ".obj" && extension != ".ply")
        throw DataError(
            fmt::format("{}: found the extension \"{}\", expected .obj or .ply", name, extension));
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw DataError(fmt::format("{}: found no file, expected an OBJ or PLY mesh", name));
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error || bytes > most_file_bytes)
        throw DataError(fmt::format("{}: found {} bytes, expected at most {}", name, bytes, most_file_bytes));

    if (extension == ".ply") {
        std::ifstream stream(file, std::ios::binary);
        const std::string content{std::istreambuf_iterator<char>(stream), {}};
        if (const std::string damage = ply_damage(content); !damage.empty())
            throw DataError(fmt::format("{}: found {}, expected a whole PLY file", name, damage));
    }

    Assimp::Importer importer;
    keep_only(importer, extension.substr(1));
    // Validation comes first and refuses indices beyond the vertices, before anything follows them.
    const aiScene* scene = importer.ReadFile(
        name, aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_JoinIdenticalVertices);
    if (scene == nullptr) throw DataError(fmt::format("{}: found damaged data ({})", name, reason(importer)));

    Mesh mesh;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) append(mesh, *scene->mMeshes[m]);
    for (const Vec3 p : mesh.surface.vertices)
        if (!trace::is_finite(p))
            throw DataError(fmt::format("{}: found a vertex that is not finite, expected numbers", name));
    mesh.degenerate_faces += drop_degenerate(mesh.surface);
    if (mesh.surface.triangles.empty())
        throw DataError(fmt::format("{}: found no triangle with an area, expected at least one", name));
    return mesh;
}

}  // namespace regather::scenes
