// `regather import KIND FILE... -o DIR`: scenes of others as scene files. One importer a kind:
// scenes/import_*.h.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "imports/furniture/demonstration.h"
#include "imports/homes/sweethome3d.h"
#include "imports/maps/openarena.h"
#include "imports/mesh.h"
#include "imports/scene_file.h"
#include "trace/error.h"
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

struct Imported {
    ImportedScene scene;
    std::vector<std::string> notes;  ///< What was guessed or left out, a line each.
};

const std::filesystem::path& one_file(const Request& request) {
    if (request.files.size() != 1)
        throw UsageError(fmt::format("FILE: found {} files, expected one", request.files.size()));
    return request.files.front();
}

Imported import_home(const Request& request) {
    return {imports::import_sweethome3d(one_file(request), request.home), {}};
}

Imported import_glassware(const Request& request) {
    return {imports::import_furniture(request.files), {}};
}

Imported import_one_mesh(const Request& request) {
    if (request.up != "y" && request.up != "z")
        throw UsageError(fmt::format("--up: found '{}', expected y or z", request.up));
    return {imports::import_mesh(one_file(request), {.up = up_of(request.up), .size = request.size}), {}};
}

Imported import_map(const Request& request) {
    imports::OpenArenaMap map = imports::import_openarena(request.files, {.map = request.map});
    return {std::move(map.scene), std::move(map.notes)};
}

struct ImportKind {
    std::string_view name, summary, options;  ///< Options by name, each with a space behind it.
    Imported (*import)(const Request&);
};

constexpr std::array kinds{
    ImportKind{"sweethome3d", "a home of Sweet Home 3D: .sh3d file, or sweethome3d.jar with --home NAME",
               "--home ", import_home},
    ImportKind{"furniture",
               "glassware and chess on a table, from the catalogues of sweethome3d-furniture (folder or "
               ".sh3f files)",
               "", import_glassware},
    ImportKind{"mesh", "an OBJ, PLY or glTF file, on a floor under a light; --up y|z, --size METRES",
               "--up --size ", import_one_mesh},
    ImportKind{"openarena", "a map of OpenArena or Quake III Arena: its .pk3 archives, with --map NAME",
               "--map ", import_map},
};

const ImportKind& kind_of(const std::string& word) {
    std::vector<std::string_view> names;
    for (const ImportKind& kind : kinds) {
        if (kind.name == word) return kind;
        names.push_back(kind.name);
    }
    throw UsageError(fmt::format("KIND: found '{}', expected {} (known: {})", word,
                                 trace::alternatives(trace::nearest_words(word, names)),
                                 trace::listed(names)));
}

void refuse_options_of_others(const CLI::App& command, const ImportKind& kind) {
    for (const std::string_view option : {"--home", "--map", "--up", "--size"})
        if (command.count(std::string(option)) > 0 &&
            kind.options.find(std::string(option) + " ") == std::string_view::npos)
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

void add_import(CLI::App& app) {
    struct Options {
        std::string kind;
        Request request;
        std::filesystem::path folder;
        bool force = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("import", "Makes a scene of a home, a map, furniture or a mesh of others");
    command->add_option("KIND", options->kind, "which importer: see below")->required();
    command->add_option("FILE", options->request.files, "what to read")->required();
    command->add_option("-o,--output", options->folder, "folder for scene.json and meshes/")->required();
    command->add_option("--home", options->request.home, "which home of the archive (sweethome3d)");
    command->add_option("--map", options->request.map, "which map of the archives (openarena)");
    command->add_option("--up", options->request.up,
                        "the file's axis that points up, y or z (mesh; default y)");
    command->add_option("--size", options->request.size,
                        "the object's largest extent in metres (mesh; default 1)");
    command->add_flag("--force", options->force, "replace an imported scene");
    command->footer(footer());
    command->callback([options, command] {
        const ImportKind& kind = kind_of(options->kind);
        refuse_options_of_others(*command, kind);
        imports::check_scene_folder(options->folder, options->force);
        const Imported imported = kind.import(options->request);
        imports::write_scene(imported.scene, options->folder, options->force);
        fmt::print("{}", summary_of(imported.scene));
        for (const std::string& note : imported.notes) fmt::print("note     {}\n", note);
        fmt::print("written  {}\n", (options->folder / "scene.json").string());
    });
}

}  // namespace regather::cli
