// imports/homes/furniture.h -- models of furniture in archives, and how a piece of furniture stands in a
// scene. OBJ models are read by meshes/mesh.h from a temporary folder; materials that no library describes
// are Java 3D's (imports/homes/java3d_materials.h).
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "imports/archive.h"
#include "imports/homes/home.h"
#include "imports/scene_file.h"

namespace regather::imports {

/// More is refused: bytes of a model or a library in the archive, triangles of all pieces together.
inline constexpr std::uint64_t most_model_bytes = 64u << 20;
inline constexpr std::uint64_t most_piece_triangles = 20'000'000;

/// Groups of a model whose faces are window panes or mirrors (Sweet Home 3D names groups so) get these
/// materials.
inline constexpr std::string_view pane_material = "sweethome3d_window_pane",
                                  mirror_material = "sweethome3d_window_mirror";

/// In the model's own coordinates: x right, y up, z towards the viewer.
struct FurnitureModel {
    struct Part {
        Material material;
        Surface surface;
    };
    std::vector<Part> parts;
    std::uint64_t triangles() const;
};

/// The triangles of a mesh whose tag (one a triangle) is `tag`, with their own vertices.
Surface triangles_with(const Surface& all, const std::vector<std::uint32_t>& tags, std::uint32_t tag);

/// Entry `name` (.obj) of the archive with its libraries. Throws trace::DataError that names archive and
/// entry.
FurnitureModel read_furniture(const Zip& zip, const std::string& name);

/// The materials of a scene in the making, by their values: equal ones are one.
class MaterialTable {
public:
    explicit MaterialTable(std::vector<Material>& materials) : materials_(materials) {}
    /// `material` with a name that nothing else has; no more than 0.9 of the light is reflected.
    std::uint32_t index_of(Material material);

private:
    std::vector<Material>& materials_;
    std::map<std::string, std::uint32_t> by_value_;
    std::map<std::string, int> uses_of_name_;
};

/// Linear light of an sRGB colour, in [0, 1].
Vec3 linear(Rgb8 color);

/// The material of a surface of that colour; shiny from a shininess of 0.05 on.
Material painted(const std::string& name, Rgb8 color, double shininess);

/// Where and how a model stands [m, radians]: its box is scaled to size, turned about its own axes (roll,
/// pitch), then about the vertical by `angle` as on the plan (clockwise from above), and put with the middle
/// of its foot at `foot`.
struct Placement {
    double width = 1, depth = 1, height = 1, angle = 0, pitch = 0, roll = 0;
    bool mirrored = false;
    std::optional<std::array<double, 9>> model_rotation;
    std::array<double, 3> foot{};  ///< z up.
};

/// The parts in the scene's coordinates: x right, y up on the plan, z up.
std::vector<FurnitureModel::Part> placed(const FurnitureModel& model, const Placement& placement);

/// Appends the parts: normals smoothed, glass made solid.
void add_parts(std::vector<FurnitureModel::Part> parts, MaterialTable& table, ImportedScene& scene);

}  // namespace regather::imports
