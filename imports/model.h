// imports/model.h -- an object of triangles and materials, and how it is put into a scene.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "imports/material_table.h"
#include "imports/scene_file.h"
#include "trace/vec3d.h"

namespace regather::imports {

/// In its own coordinates: x right, y up, z towards the viewer.
struct Model {
    struct Part {
        Material material;
        Surface surface;
    };
    std::vector<Part> parts;
    std::uint64_t triangles() const;
};

/// The triangles of a mesh whose tag (one a triangle) is `tag`, with their own vertices.
Surface triangles_with(const Surface& all, const std::vector<std::uint32_t>& tags, std::uint32_t tag);

/// Where and how a model stands [m, radians]: its box is scaled to size, turned about its own axes (roll,
/// pitch), then about the vertical by `angle` as on the plan (clockwise from above), and put with the middle
/// of its foot at `foot`.
struct Placement {
    double width = 1, depth = 1, height = 1, angle = 0, pitch = 0, roll = 0;
    bool mirrored = false;
    std::optional<std::array<double, 9>> model_rotation;
    trace::Vec3d foot;  ///< z up.
};

/// The parts in the scene's coordinates: x right, y up on the plan, z up.
std::vector<Model::Part> placed(const Model& model, const Placement& placement);

/// Appends the parts: normals smoothed, glass made solid.
void add_parts(std::vector<Model::Part> parts, MaterialTable& table, ImportedScene& scene);

}  // namespace regather::imports
