// imports/model.h -- an object of triangles and materials, and how it is put into a scene.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "imports/material_table.h"
#include "imports/scene_file.h"
#include "meshes/affine.h"
#include "trace/vec.h"

namespace regather::imports {

/// In its own coordinates: x right, y up, z towards the viewer.
struct Model {
    struct Part {
        Material material;
        Surface surface;
    };
    std::vector<Part> parts;
    std::vector<std::string> notes;  ///< What is in its file and not taken over, a line a kind.
    std::uint64_t triangles() const;
};

/// The triangles of a mesh whose tag (one a triangle) is `tag`, with their own vertices.
Surface triangles_with(const Surface& all, const std::vector<std::uint32_t>& tags, std::uint32_t tag);

using meshes::Affine, meshes::Matrix3;

/// Where and how a model stands [m, radians], by the conventions of Sweet Home 3D (its class ModelManager):
/// the model is turned by `model_rotation` about the middle of its box, its box then scaled to size and
/// mirrored left to right; turned by `pitch` about its x axis, then by `roll` about its z axis; then the
/// middle of the box that it has so is put above `foot`, the lowest point at its height; then it is turned by
/// `angle` about that vertical, clockwise on the plan.
struct Placement {
    double width = 1, depth = 1, height = 1, angle = 0, pitch = 0, roll = 0;
    bool mirrored = false;
    std::optional<Matrix3> model_rotation;
    bool centred = true;  ///< False: after `model_rotation` the middle of the unturned box stays the middle.
    trace::Vec3d foot;    ///< z up.
};

/// From before to the scene's coordinates: x right, y up on the plan, z up.
struct Pose {
    Affine of_model;  ///< Of the model's own coordinates.
    Affine of_box;  ///< Of a cube of edge 1 about the origin (x right, y up, z front) that is scaled to size
                    ///< as the model is.
};
Pose pose_of(const Model& model, const Placement& placement);

/// The parts in the scene's coordinates.
std::vector<Model::Part> placed(const Model& model, const Placement& placement);

/// Appends the parts: normals smoothed, glass made solid.
void add_parts(std::vector<Model::Part> parts, MaterialTable& table, ImportedScene& scene);

}  // namespace regather::imports
