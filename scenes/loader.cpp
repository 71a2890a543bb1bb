#include "scenes/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "meshes/mesh.h"
#include "scenes/catalogue.h"
#include "scenes/coordinates.h"
#include "scenes/scene_builder.h"
#include "trace/error.h"
#include "trace/field.h"
#include "trace/file.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::scenes {

using trace::DataError;
using trace::UsageError;

namespace {

constexpr std::uint64_t most_scene_bytes = 256u << 20;
// A scene farther from its origin than this many of its sizes is recentred: 10 of a float's 24 bits are then
// lost.
constexpr double far_in_sizes = 64;

double size_of(const Bounds3& bounds) {
    const Vec3 extent = bounds.extent();
    return std::max({double{extent.x}, double{extent.y}, double{extent.z}});
}

// [m] The bounds' middle in the file's coordinates, to a multiple of a power of two about as large as the
// scene: the doubles less it are exact.
std::array<double, 3> rounded_middle(const Scene& scene) {
    const Bounds3 bounds = scene.bounds();
    const double grain = std::exp2(std::ceil(std::log2(std::max(size_of(bounds), 1e-9))));
    std::array<double, 3> middle{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        middle[k] = scene.recentred_by[k] + (static_cast<double>(bounds.min[axis]) + bounds.max[axis]) / 2;
        middle[k] = std::round(middle[k] / grain) * grain;
    }
    return middle;
}

bool is_far(const Scene& scene) {
    const Bounds3 bounds = scene.bounds();
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double middle = (static_cast<double>(bounds.min[axis]) + bounds.max[axis]) / 2;
        most = std::max(most, std::abs(scene.recentred_by[static_cast<std::size_t>(axis)] + middle));
    }
    return most > far_in_sizes * size_of(bounds);
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file, const std::filesystem::path& directory) {
    const trace::Document document(text, file, "scene");
    const Field root = document.root();
    MeshStore meshes(directory);
    BuiltScene built = build_scene(root, {}, meshes);
    if (is_far(built.scene)) {
        // In floats the scene may have lost its size: near its middle it has it, and is far or not.
        const BuiltScene near = build_scene(root, rounded_middle(built.scene), meshes);
        if (is_far(near.scene)) built = build_scene(root, rounded_middle(near.scene), meshes);
    }
    if (built.flat_shape) throw DataError(*built.flat_shape);
    if (const double size = size_of(built.scene.bounds()); size > 2 * most_metres)
        root.fail(fmt::format("a size of {:.6g} m", size), fmt::format("at most {:.6g}", 2 * most_metres));
    built.scene.notes = meshes.notes();
    return std::move(built.scene);
}

Scene load_scene(std::string_view name_or_path) {
    std::vector<std::string_view> names;
    for (const EmbeddedScene& scene : catalogue()) {
        if (scene.name == name_or_path)
            return parse_scene(scene.text, fmt::format("{} (embedded)", scene.name), std::filesystem::path{});
        names.push_back(scene.name);
    }
    const std::string file(name_or_path);
    const std::filesystem::path path(file);
    if (meshes::format_of(path))
        throw UsageError(
            fmt::format("scene: found the mesh {}, expected a scene: make one of it by `regather import mesh "
                        "{} -o DIR` and give DIR/scene.json",
                        trace::in_quotes(file), trace::shown(file, 200)));
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        if (file.find('/') == std::string::npos && !path.has_extension())
            throw UsageError(fmt::format(
                "scene: found {}, expected {} or a JSON file (embedded scenes: {})", trace::in_quotes(file),
                trace::alternatives(trace::nearest_words(file, names)), trace::listed(names)));
        throw DataError(
            fmt::format("{}: found no file, expected a JSON scene or one of the embedded scenes {}",
                        trace::shown(file, trace::most_shown_path), trace::listed(names)));
    }
    return parse_scene(trace::read_file(path, most_scene_bytes), file, path.parent_path());
}

}  // namespace regather::scenes
