#include "imports/furniture/demonstration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "imports/archived_model.h"
#include "imports/furniture/furniture_catalogue.h"
#include "imports/orbit.h"
#include "meshes/weld.h"
#include "trace/error.h"

namespace regather::imports {

using scenes::Quad;
using trace::DataError;
using trace::UsageError;

namespace {

namespace fs = std::filesystem;

constexpr double table_top = 0.741;  // [m] Of the oak table.
constexpr double room_half = 2, room_height = 2.6;
constexpr float watts = 140;
constexpr std::uint32_t frames = 36;

/// One model, in metres and degrees, and its material that is glass although its library does not say so.
struct Item {
    std::string_view model;
    double width, depth, height, x, y, z, degrees;
    std::string_view glass;
    float cell;  ///< [m] The model is simplified to details of that size; 0: not.
};

// A board of 126,000 triangles would outnumber all else: 2 mm are below a pixel at the distance it is seen
// from.
constexpr std::array items{
    Item{"blendswap-cc-0/oakTable/oakTable.obj", 1.24, 1.24, table_top, 0, 0, 0, 0, "", 0},
    Item{"blendswap-cc-by/chessboard/chessboard.obj", 0.42, 0.42, 0.112, -0.06, 0.05, table_top, 12, "",
         0.0020f},
    Item{"blendswap-cc-0/beerGlass/beerGlass.obj", 0.154, 0.102, 0.165, 0.30, -0.12, table_top, 200, "", 0},
    Item{"blendswap-cc-by/glass/glass.obj", 0.075, 0.074, 0.195, -0.36, -0.20, table_top, 0, "", 0},
    Item{"blendswap-cc-by/glass/glass.obj", 0.075, 0.074, 0.195, -0.27, -0.30, table_top, 90, "", 0},
    Item{"blendswap-cc-by/cocktailGlass/cocktailGlass.obj", 0.083, 0.083, 0.131, 0.06, -0.33, table_top, 0,
         "", 0},
    Item{"katorlegaz/highball-glass/highball-glass.obj", 0.06, 0.06, 0.121, 0.24, 0.24, table_top, 0, "", 0},
    Item{"katorlegaz/red-wine-bottle-01/red-wine-bottle-01.obj", 0.085, 0.085, 0.30, 0.36, 0.14, table_top,
         40, "bottle_glass_green", 0},
};

std::vector<FurnitureCatalogue> open_all(std::span<const fs::path> files) {
    std::vector<FurnitureCatalogue> catalogues;
    for (const fs::path& file : files) {
        std::error_code error;
        if (!fs::is_directory(file, error)) {
            catalogues.emplace_back(file);
            continue;
        }
        std::set<fs::path> sorted;
        for (const fs::directory_entry& entry : fs::directory_iterator(file))
            if (entry.path().extension() == ".sh3f") sorted.insert(entry.path());
        if (sorted.empty())
            throw DataError(
                fmt::format("{}: found no .sh3f file, expected furniture catalogues", file.string()));
        for (const fs::path& one : sorted) catalogues.emplace_back(one);
    }
    return catalogues;
}

Placement placement_of(const Item& item) {
    Placement placement;
    placement.width = item.width;
    placement.depth = item.depth;
    placement.height = item.height;
    placement.angle = item.degrees * std::numbers::pi / 180;
    placement.foot = {item.x, item.y, item.z};
    return placement;
}

void add_room(MaterialTable& table, ImportedScene& scene) {
    const auto h = static_cast<float>(room_half), top = static_cast<float>(room_height);
    const auto wall = [&](const Material& material, Vec3 corner, Vec3 u, Vec3 v) {
        scene.meshes.push_back({table.index_of(material), tessellate(Quad{corner, u, v, {8, 8}})});
    };
    const Material white{.name = "room_white", .diffuse = {0.75f, 0.74f, 0.72f}};
    const Material floor{.name = "room_floor", .diffuse = {0.35f, 0.27f, 0.2f}};
    const Material red{.name = "room_red", .diffuse = {0.6f, 0.12f, 0.1f}};
    const Material blue{.name = "room_blue", .diffuse = {0.12f, 0.2f, 0.5f}};
    wall(floor, {-h, -h, 0}, {2 * h, 0, 0}, {0, 2 * h, 0});
    wall(white, {-h, -h, top}, {0, 2 * h, 0}, {2 * h, 0, 0});
    wall(red, {-h, -h, 0}, {0, 2 * h, 0}, {0, 0, top});
    wall(blue, {h, -h, 0}, {0, 0, top}, {0, 2 * h, 0});
    wall(white, {-h, h, 0}, {2 * h, 0, 0}, {0, 0, top});
    wall(white, {-h, -h, 0}, {0, 0, top}, {2 * h, 0, 0});
}

void add_light(ImportedScene& scene) {
    ImportedLight light;
    light.corner = {0.1f, -0.9f, 2.55f};
    light.edge_u = {0, 0.6f, 0};
    light.edge_v = {0.6f, 0, 0};
    light.power = {watts, 0.95f * watts, 0.85f * watts};
    scene.lights.push_back(light);
}

}  // namespace

ImportedScene import_furniture(std::span<const fs::path> files) {
    const std::vector<FurnitureCatalogue> catalogues = open_all(files);
    ImportedScene scene;
    MaterialTable table(scene.materials);
    add_room(table, scene);
    add_light(scene);
    LeftOut left_out;
    std::vector<std::string> credits, licences;
    const auto add_once = [](std::vector<std::string>& list, std::string text) {
        if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(std::move(text));
    };
    for (const Item& item : items) {
        const auto found = std::find_if(catalogues.begin(), catalogues.end(),
                                        [&](const FurnitureCatalogue& c) { return c.has(item.model); });
        if (found == catalogues.end())
            throw DataError(fmt::format("{}: found no entry {}, expected it in one of {} catalogues",
                                        files.empty() ? "furniture" : files.front().string(), item.model,
                                        catalogues.size()));
        const std::string model(item.model);
        const Model read = read_model(found->zip(), model);
        for (const std::string& note : read.notes) left_out.add_note_of_model(note);
        std::vector<Model::Part> parts = placed(read, placement_of(item));
        for (Model::Part& part : parts) {
            if (part.material.name == item.glass)
                part.material = {.name = part.material.name, .kind = MaterialKind::dielectric, .diffuse = {}};
            if (item.cell > 0) part.surface = simplified(part.surface, item.cell);
        }
        add_parts(std::move(parts), table, scene);
        const std::size_t slash = model.rfind('/') + 1;
        add_once(credits, fmt::format("{} by {}", model.substr(slash, model.size() - slash - 4),
                                      found->creator_of(model)));
        add_once(licences, fmt::format("{}: {}", found->value("name"), found->value("license")));
    }
    const auto joined = [](const std::vector<std::string>& list) {
        std::string text;
        for (const std::string& one : list) text += (text.empty() ? "" : "; ") + one;
        return text;
    };
    std::size_t models = 0;
    for (const FurnitureCatalogue& catalogue : catalogues) {
        models += catalogue.models();
        catalogue.count_left_out(left_out);
    }
    scene.notes.push_back(
        fmt::format("{} of {} models of {} catalogues", std::size(items) - 1, models, catalogues.size()));
    for (std::string& line : left_out.lines()) scene.notes.push_back(std::move(line));
    scene.name = "glassware";
    scene.origin = "Sweet Home 3D furniture: " + joined(credits);
    scene.licence = joined(licences);
    Orbit orbit{.center = {0, -0.05f, 0.8f},
                .distance = 0.95,
                .height = 0.42,
                .from_degrees = -150,
                .to_degrees = -20,
                .frames = frames};
    scene.camera_path = keys_of(orbit);
    scene.frames = frames;
    orbit.from_degrees = -95;
    const KeyFrame front = keys_of(orbit).front();
    scene.camera = {front.position, front.target, front.up, 42};
    return scene;
}

}  // namespace regather::imports
