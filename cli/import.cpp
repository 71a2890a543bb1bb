// `regather import KIND FILE... -o DIR`: scenes of others as scene files. One importer a kind, each in
// imports/.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "cli/commands.h"
#include "imports/furniture/demonstration.h"
#include "imports/homes/sweethome3d.h"
#include "imports/maps/openarena.h"
#include "imports/mesh.h"
#include "imports/scene_file.h"
#include "meshes/mesh.h"
#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::cli {

namespace {

using imports::ImportedScene;
using trace::UsageError;

/// What the command line says; which options a kind takes stands in the table.
struct Request {
    std::vector<std::filesystem::path> files;
    std::string home, map, up = "y";
    double size = 1;
};

const std::filesystem::path& one_file(const Request& request) {
    if (request.files.size() != 1)
        throw UsageError(fmt::format("FILE: found {} files, expected one", request.files.size()));
    return request.files.front();
}

ImportedScene import_home(const Request& request) {
    return imports::import_sweethome3d(one_file(request), request.home);
}

ImportedScene import_glassware(const Request& request) {
    return imports::import_furniture(request.files);
}

ImportedScene import_one_mesh(const Request& request) {
    using Up = imports::MeshImportOptions::Up;
    const Up up = request.up == "x" ? Up::x : request.up == "y" ? Up::y : Up::z;
    return imports::import_mesh(one_file(request), {.up = up, .size = request.size});
}

ImportedScene import_map(const Request& request) {
    return imports::import_openarena(request.files, {.map = request.map});
}

struct ImportKind {
    std::string_view name, summary, options;  ///< Options by name, each with a space behind it.
    ImportedScene (*import)(const Request&);
};

constexpr std::array kinds{
    ImportKind{"sweethome3d", "a home of Sweet Home 3D: .sh3d file, or sweethome3d.jar with --home NAME",
               "--home ", import_home},
    ImportKind{"furniture",
               "glassware and chess on a table, from the catalogues of sweethome3d-furniture (folder or "
               ".sh3f files)",
               "", import_glassware},
    ImportKind{"mesh", "an OBJ, PLY or glTF file, on a floor under a light; --up x|y|z, --size METRES",
               "--up --size ", import_one_mesh},
    ImportKind{"openarena", "a map of OpenArena or Quake III Arena: its .pk3 archives, with --map NAME",
               "--map ", import_map},
};

// Which kind reads files with such a name; "" for none.
std::string_view kind_of_file(const std::string& name) {
    const std::filesystem::path path(name);
    if (meshes::format_of(path)) return "mesh";
    const std::string extension = path.extension().string();
    if (extension == ".sh3d" || extension == ".jar") return "sweethome3d";
    if (extension == ".sh3f") return "furniture";
    return extension == ".pk3" ? "openarena" : "";
}

const ImportKind& kind_of(const std::string& word) {
    std::vector<std::string_view> names;
    for (const ImportKind& kind : kinds) {
        if (kind.name == word) return kind;
        names.push_back(kind.name);
    }
    const std::string_view kind = kind_of_file(word);
    if (!kind.empty())
        throw UsageError(
            fmt::format("KIND: found the file {}, expected a kind before it: regather import {} {} -o DIR",
                        trace::in_quotes(word), kind, trace::shown(word, 200)));
    throw UsageError(fmt::format("KIND: found '{}', expected {} (known: {})", word,
                                 trace::alternatives(trace::nearest_words(word, names)),
                                 trace::listed(names)));
}

void refuse_options_of_others(const Command& command, const ImportKind& kind) {
    for (const std::string_view option : {"--home", "--map", "--up", "--size"})
        if (command.given(option) && kind.options.find(std::string(option) + " ") == std::string_view::npos)
            throw UsageError(fmt::format("{}: found with the kind {}, expected {}", option, kind.name,
                                         kind.options.empty() ? "no option of that kind" : kind.options));
}

std::string summary_of(const ImportedScene& scene) {
    constexpr std::array<std::string_view, 4> names{"diffuse", "glossy", "mirror", "dielectric"};
    std::array<std::size_t, names.size()> counts{};
    for (const scenes::Material& material : scene.materials)
        ++counts[static_cast<std::size_t>(material.kind)];
    std::string materials;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (counts[i] > 0)
            materials += fmt::format("{}{} {}", materials.empty() ? "" : ", ", counts[i], names[i]);
    return fmt::format(
        "{}: {} triangles; {} materials ({}); {} lights; {} frames\norigin   {}\nlicence  {}\n", scene.name,
        scene.triangle_count(), scene.materials.size(), materials, scene.lights.size(), scene.frames,
        scene.origin, scene.licence);
}

std::string footer() {
    std::string text = "Kinds:\n";
    for (const ImportKind& kind : kinds)
        text += fmt::format("  {}{}{}\n", kind.name, std::string(13 - kind.name.size(), ' '), kind.summary);
    return text +
           "Examples:\n"
           "  regather import sweethome3d /usr/share/sweethome3d/sweethome3d.jar --home 2BedroomApartment -o "
           "out/apartment\n"
           "  regather import furniture /usr/share/sweethome3d/furniture -o out/glassware\n"
           "  regather import mesh teapot.obj -o out/teapot\n"
           "  regather import openarena /usr/share/games/openarena/baseoa/*.pk3 --map oa_shouse -o "
           "out/shouse\n"
           "  regather capture out/apartment/scene.json -o out/apartment-capture\n"
           "What is taken over, and what is not: docs/import.md.";
}

}  // namespace

void add_import(Command& command) {
    struct Options {
        std::string kind;
        Request request;
        std::filesystem::path folder;
        bool force = false;
    };
    auto options = std::make_shared<Options>();
    Request& request = options->request;
    command.argument("KIND", options->kind, "which importer: see below").required();
    command.arguments("FILE", request.files, "what to read");
    command.option("-o,--output", options->folder, "folder for scene.json and meshes/");
    command.option("--home", request.home, "which home of the archive (sweethome3d)");
    command.option("--map", request.map, "which map of the archives (openarena)");
    command.choice("--up", request.up, {"x", "y", "z"}, "the file's axis that points up (mesh)");
    command.option("--size", request.size, {.least = 0, .above = true},
                   "the object's largest extent in metres (mesh)");
    command.flag("--force", options->force, "replace an imported scene");
    command.footer(footer());
    command.action(options, [&command](const Options& asked, const Console& console) {
        const ImportKind& kind = kind_of(asked.kind);
        refuse_options_of_others(command, kind);
        if (asked.request.files.empty())
            throw UsageError(fmt::format(
                "FILE: found none, expected what to read: regather import {} FILE -o DIR", kind.name));
        if (asked.folder.empty())
            throw UsageError("--output: found none, expected the folder of the scene: -o DIR");
        imports::check_scene_folder(asked.folder, asked.force);
        const ImportedScene scene = kind.import(asked.request);
        imports::write_scene(scene, asked.folder, asked.force);
        console.print("{}", summary_of(scene));
        if (kind.name == "mesh")
            console.print("up       {} of the file{}\n", asked.request.up,
                          command.given("--up") ? "" : ", by default: see --up");
        console.note(scene.notes);
        console.print("written  {}\n", (asked.folder / "scene.json").string());
    });
}

}  // namespace regather::cli
