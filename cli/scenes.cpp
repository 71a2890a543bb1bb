// `regather scenes [NAME|FILE]`: what there is to light, as tables on stdout.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "scenes/catalogue.h"
#include "scenes/loader.h"
#include "scenes/needs.h"

namespace regather::cli {

namespace {

using scenes::Scene;
using trace::Vec3;

constexpr std::array<std::string_view, 4> kind_names{"diffuse", "glossy", "mirror", "dielectric"};

std::string in_words(Vec3 v) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z);
}

std::string materials_of(const Scene& scene) {
    std::array<std::size_t, kind_names.size()> counts{};
    for (const scenes::Material& material : scene.materials)
        ++counts[static_cast<std::size_t>(material.kind)];
    std::string text;
    for (std::size_t kind = 0; kind < counts.size(); ++kind)
        if (counts[kind] > 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[kind], kind_names[kind]);
    return text;
}

Vec3 total_power(const Scene& scene) {
    Vec3 power;
    for (const scenes::AreaLight& light : scene.lights) power += light.power();
    return power;
}

std::string bounds_of(const Scene& scene) {
    const trace::Bounds3 bounds = scene.bounds();
    return fmt::format("{} to {}", in_words(bounds.min), in_words(bounds.max));
}

void print_table(const std::vector<std::array<std::string, 7>>& rows) {
    std::array<std::size_t, 7> widths{};
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            line += row[c];
            if (c + 1 < row.size()) line += std::string(widths[c] - row[c].size() + 2, ' ');
        }
        fmt::print("{}\n", line);
    }
}

void print_all() {
    std::vector<std::array<std::string, 7>> rows{
        {"name", "triangles", "materials", "lights", "power [W] (R G B)", "bounds [m]", "camera [m]"}};
    for (const scenes::EmbeddedScene& entry : scenes::catalogue()) {
        const Scene scene = scenes::load_scene(entry.name);
        rows.push_back({scene.name, fmt::format("{}", scene.triangles.size()), materials_of(scene),
                        fmt::format("{}", scene.lights.size()), in_words(total_power(scene)),
                        bounds_of(scene), in_words(scene.camera.position)});
    }
    print_table(rows);
}

void print_details(const std::string& name_or_path) {
    const Scene scene = scenes::load_scene(name_or_path);
    const auto line = [](std::string_view label, const std::string& text) {
        fmt::print("{:<22}{}\n", label, text);
    };
    line("name", scene.name);
    for (const scenes::EmbeddedScene& entry : scenes::catalogue())
        if (entry.name == name_or_path) line("what", std::string(entry.summary));
    line("triangles", fmt::format("{}", scene.triangles.size()));
    line("vertices", fmt::format("{}", scene.vertices.size()));
    line("faces without area", fmt::format("{} dropped", scene.degenerate_faces_dropped));
    line("materials", materials_of(scene));
    line("lights", fmt::format("{}", scene.lights.size()));
    line("power [W] (R G B)", in_words(total_power(scene)));
    line("bounds [m]", bounds_of(scene));
    const scenes::Camera& camera = scene.camera;
    line("camera [m]",
         fmt::format("{} towards {}, up {}, {:.4g} degrees high", in_words(camera.position),
                     in_words(camera.target), in_words(camera.up), camera.vertical_fov_degrees));
    fmt::print("\nneeds of a capture\n");
    const scenes::Needs needs = scenes::needs_of(scene);
    for (const scenes::Need* need : needs.list())
        line(fmt::format("  {}", need->part),
             fmt::format("{}: {}", need->needed ? "yes" : "no ", need->reason));
    if (scene.lights.empty()) return;
    fmt::print("\nlights\n");
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const scenes::AreaLight& light = scene.lights[i];
        line(fmt::format("  {}", i),
             fmt::format("{:.4g} m^2 at {} m, facing {}, radiance {} W/(m^2 sr)", light.area(),
                         in_words(light.corner), in_words(light.normal()), in_words(light.radiance)));
    }
}

}  // namespace

void add_scenes(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("scenes", "Lists the embedded scenes, or shows one scene in detail");
    command->footer(
        "Examples:\n"
        "  regather scenes                 the embedded scenes\n"
        "  regather scenes room            one of them: size, materials, lights, what a capture needs\n"
        "  regather scenes my_scene.json   a scene file (docs/scene_format.md): checked, then shown");
    auto scene = std::make_shared<std::string>();
    command->add_option("SCENE", *scene, "an embedded scene's name, or a JSON file");
    command->callback([scene] { scene->empty() ? print_all() : print_details(*scene); });
}

}  // namespace regather::cli
