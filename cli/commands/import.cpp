// `regather import KIND FILE... -o DIR`: scenes of others as scene files.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "cli/commands.h"
#include "imports/catalogue.h"
#include "imports/scene_file.h"
#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::cli {

namespace {

using imports::ImportedScene, imports::Importer;
using trace::UsageError;

const Importer& importer_of(const std::string& word) {
    std::vector<std::string_view> names;
    for (const Importer& importer : imports::catalogue()) {
        if (importer.kind == word) return importer;
        names.push_back(importer.kind);
    }
    const std::string_view kind = imports::kind_of_file(word);
    if (!kind.empty())
        throw UsageError(
            fmt::format("KIND: found the file {}, expected a kind before it: regather import {} {} -o DIR",
                        trace::in_quotes(word), kind, trace::shown(word, 200)));
    if (std::filesystem::path(word).has_extension()) {
        std::string kinds;
        for (const Importer& importer : imports::catalogue())
            kinds += fmt::format("{}{} ({})", kinds.empty() ? "" : ", ", importer.kind,
                                 fmt::join(importer.endings, ", "));
        throw UsageError(
            fmt::format("KIND: found the file {}, which no kind reads, expected a kind and a file: {}",
                        trace::in_quotes(word), kinds));
    }
    throw UsageError(fmt::format("KIND: found '{}', expected {} (known: {})", trace::shown(word),
                                 trace::alternatives(trace::nearest_words(word, names)),
                                 trace::listed(names)));
}

void refuse_options_of_others(const Command& command, const Importer& importer) {
    std::string options;
    for (const std::string_view option : importer.takes) options += fmt::format("--{} ", option);
    for (const std::string_view option : {"home", "map", "up", "size"}) {
        const std::string name = fmt::format("--{}", option);
        if (command.given(name) &&
            std::find(importer.takes.begin(), importer.takes.end(), option) == importer.takes.end())
            throw UsageError(fmt::format("{}: found with the kind {}, expected {}", name, importer.kind,
                                         options.empty() ? "no option of that kind" : options));
    }
}

std::string import_footer() {
    std::string text = "Kinds:\n";
    for (const Importer& importer : imports::catalogue())
        text += fmt::format("  {:<13}{}\n", importer.kind, importer.summary);
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
        imports::Request request;
        std::filesystem::path folder;
        bool force = false;
    };
    auto options = std::make_shared<Options>();
    imports::Request& request = options->request;
    command.argument("KIND", options->kind, "which importer: see below").required();
    command.arguments("FILE", request.files, "what to read");
    command.option("-o,--output", options->folder, "folder for scene.json and meshes/");
    command.option("--home", request.home, "which home of the archive (sweethome3d)");
    command.option("--map", request.map, "which map of the archives (openarena)");
    command.choice("--up", request.up, {"x", "y", "z"}, "the file's axis that points up (mesh)");
    command.option("--size", request.size, {.least = 0, .above = true},
                   "the object's largest extent in metres (mesh)");
    command.flag("--force", options->force, "replace an imported scene");
    command.footer(import_footer());
    command.action(options, [&command](const Options& asked, const Console& console) {
        const Importer& importer = importer_of(asked.kind);
        refuse_options_of_others(command, importer);
        if (asked.request.files.empty())
            throw UsageError(fmt::format(
                "FILE: found none, expected what to read: regather import {} FILE -o DIR", importer.kind));
        if (asked.folder.empty())
            throw UsageError("--output: found none, expected the folder of the scene: -o DIR");
        imports::check_scene_folder(asked.folder, asked.force);
        const ImportedScene scene = importer.import(asked.request);
        imports::write_scene(scene, asked.folder, asked.force);
        console.print("{}", imports::summary_of(scene));
        if (importer.kind == "mesh")
            console.print("up       {} of the file{}\n", asked.request.up,
                          command.given("--up") ? "" : ", by default: see --up");
        console.note(scene.notes);
        console.print("written  {}\n", (asked.folder / "scene.json").string());
    });
}

}  // namespace regather::cli
