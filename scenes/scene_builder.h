// scenes/scene_builder.h -- a scene file's JSON as a scene in memory, relative to a given origin.
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "scenes/keys.h"
#include "scenes/scene.h"

namespace regather::scenes {

/// Mesh files, each read once.
class MeshStore {
public:
    explicit MeshStore(std::filesystem::path directory) : directory_(std::move(directory)) {}
    /// Throws trace::DataError like meshes::read_mesh.
    const meshes::Mesh& get(const std::string& name);
    /// Of all meshes read so far, each behind its file's name.
    const std::vector<std::string>& notes() const { return notes_; }

private:
    std::filesystem::path directory_;
    std::map<std::string, meshes::Mesh> meshes_;
    std::vector<std::string> notes_;
};

struct BuiltScene {
    Scene scene;
    /// The refusal of the first shape that has triangles without area in floats; near another origin it may
    /// have none.
    std::optional<std::string> flat_shape;
};

/// All points less `origin` [m], which goes into Scene::recentred_by. Throws trace::DataError for anything
/// else that is wrong.
BuiltScene build_scene(const Field& root, const std::array<double, 3>& origin, MeshStore& meshes);

}  // namespace regather::scenes
