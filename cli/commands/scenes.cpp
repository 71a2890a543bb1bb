// `regather scenes [NAME|FILE]`: what there is to light, as tables on stdout, or as a contact sheet of small
// renderings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "capture/images/contact_sheet.h"
#include "capture/visibility.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "results/table.h"
#include "scenes/catalogue.h"
#include "scenes/loader.h"
#include "scenes/needs.h"
#include "scenes/summary.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/text.h"

namespace regather::cli {

namespace {

using scenes::Scene;
using trace::Vec3;

std::string in_words(Vec3 v) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z);
}

std::string bounds_of(const Scene& scene) {
    const trace::Bounds3 bounds = scene.bounds();
    return fmt::format("{} to {}", in_words(bounds.min), in_words(bounds.max));
}

std::string in_percent(double share) {
    return fmt::format("{:.1f} %", 100 * share);
}

std::string frames_of(const Scene& scene) {
    return scene.camera_path.empty() ? "-" : fmt::format("{}", scene.frames);
}

void print_all(const Console& console) {
    using results::Align;
    results::Table all({{"name", Align::left},
                        {"triangles"},
                        {"materials", Align::left},
                        {"lights"},
                        {"power [W] (R G B)", Align::left},
                        {"bounds [m]", Align::left},
                        {"seen"},
                        {"frames"}});
    for (const scenes::EmbeddedScene& entry : scenes::catalogue()) {
        const Scene scene = scenes::load_scene(entry.name);
        all.add({scene.name, fmt::format("{}", scene.triangles.size()), scenes::kinds_of(scene.materials),
                 fmt::format("{}", scene.lights.size()), in_words(scenes::total_power(scene)),
                 bounds_of(scene), in_percent(capture::share_seen(scene)), frames_of(scene)});
    }
    console.print("{}", results::text_of(all));
}

void write_thumbnails(const std::filesystem::path& file, std::vector<std::string> names, bool force,
                      const Console& console) {
    if (file.extension() != ".png")
        throw trace::UsageError(fmt::format("--thumbnails: found {}, expected a .png file",
                                            trace::in_quotes(file.string(), trace::most_shown_path)));
    trace::refuse_to_overwrite(std::array{file}, force);
    if (names.empty())
        for (const scenes::EmbeddedScene& entry : scenes::catalogue()) names.emplace_back(entry.name);
    std::vector<Scene> all;
    for (const std::string& name : names) {
        all.push_back(scenes::load_scene(name));
        console.note(all.back().notes);
    }
    Progress progress(console);
    const capture::Image sheet = capture::contact_sheet(all, {}, [&](std::string_view, std::size_t done) {
        progress.update("thumbnails", "scenes", done, all.size());
    });
    capture::write_png(file, sheet, 1, capture::Tone::linear);
}

void print_details(const std::string& name_or_path, const Console& console) {
    const Scene scene = scenes::load_scene(name_or_path);
    console.note(scene.notes);
    const auto line = [&](std::string_view label, const std::string& text) {
        console.print("{:<22}{}\n", label, trace::shown(text, 500));
    };
    line("name", scene.name);
    for (const scenes::EmbeddedScene& entry : scenes::catalogue())
        if (entry.name == name_or_path) line("what", std::string(entry.summary));
    if (!scene.origin.empty()) line("origin", scene.origin);
    if (!scene.licence.empty()) line("licence", scene.licence);
    line("triangles", fmt::format("{}", scene.triangles.size()));
    line("vertices", fmt::format("{}", scene.vertices.size()));
    line("faces without area", fmt::format("{} dropped", scene.degenerate_faces_dropped));
    line("materials", scenes::kinds_of(scene.materials));
    line("lights", fmt::format("{}", scene.lights.size()));
    line("power [W] (R G B)", in_words(scenes::total_power(scene)));
    line("bounds [m]", bounds_of(scene));
    const scenes::Camera& camera = scene.camera;
    line("camera [m]",
         fmt::format("{} towards {}, up {}, {:.4g} degrees high", in_words(camera.position),
                     in_words(camera.target), in_words(camera.up), camera.vertical_fov_degrees));
    line("seen by the camera", in_percent(capture::share_seen(scene)) + " of the surface");
    if (!scene.camera_path.empty())
        line("camera path",
             fmt::format("{} frames, {} key frames, {} of the surface seen", scene.frames,
                         scene.camera_path.size(), in_percent(capture::share_seen_over_path(scene))));
    if (const auto& [x, y, z] = scene.recentred_by; x != 0 || y != 0 || z != 0)
        line("recentred", fmt::format("all coordinates of the file less {:.15g} {:.15g} {:.15g} m", x, y, z));
    console.print("\nneeds of a capture\n");
    const scenes::Needs needs = scenes::needs_of(scene);
    for (const scenes::Need* need : needs.list())
        line(fmt::format("  {}", need->part),
             fmt::format("{}: {}", need->needed ? "yes" : "no ", need->reason));
    if (scene.lights.empty()) return;
    console.print("\nlights\n");
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const scenes::AreaLight& light = scene.lights[i];
        if (light.is_mesh()) {
            line(fmt::format("  {}", i),
                 fmt::format("{:.4g} m^2, {} triangles, radiance {} W/(m^2 sr)", light.area(),
                             light.triangle_count, in_words(light.radiance)));
            continue;
        }
        line(fmt::format("  {}", i),
             fmt::format("{:.4g} m^2 at {} m, facing {}, radiance {} W/(m^2 sr)", light.area(),
                         in_words(light.corner), in_words(light.normal()), in_words(light.radiance)));
    }
}

}  // namespace

void add_scenes(Command& command) {
    struct Options {
        std::vector<std::string> names;
        std::filesystem::path thumbnails;
        bool force = false;
    };
    auto options = std::make_shared<Options>();
    command.arguments("SCENE", options->names,
                      "an embedded scene's name, or a JSON file; several with --thumbnails");
    command.option(
        "--thumbnails", options->thumbnails,
        "write small renderings of the scenes (without any: the embedded ones) with their names to this PNG");
    command.flag("--force", options->force, "overwrite the PNG");
    command.needs("--force", {"--thumbnails"});
    command.footer(
        "Examples:\n"
        "  regather scenes                 the embedded scenes\n"
        "  regather scenes room            one of them: size, materials, lights, what a capture needs\n"
        "  regather scenes my_scene.json   a scene file (docs/scene_format.md): checked, then shown\n"
        "  regather scenes --thumbnails sheet.png room house my_scene.json");
    command.action(options, [](const Options& asked, const Console& console) {
        if (!asked.thumbnails.empty())
            return write_thumbnails(asked.thumbnails, asked.names, asked.force, console);
        if (asked.names.empty()) return print_all(console);
        if (asked.names.size() > 1)
            throw trace::UsageError(
                fmt::format("SCENE: found '{}' after '{}', expected nothing more without --thumbnails",
                            trace::shown(asked.names[1]), trace::shown(asked.names[0])));
        print_details(asked.names[0], console);
    });
}

}  // namespace regather::cli
