// regather converge -- error against run time: renders a ladder of settings for a while and measures each
// against a reference.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "capture/image_strip.h"
#include "capture/reference.h"
#include "charts/chart.h"
#include "charts/convergence.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "scenes/camera_path.h"
#include "scenes/loader.h"
#include "scenes/needs.h"
#include "study/convergence.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;

constexpr double reference_share = 0.4;  // of the time, when there is none yet

struct Options {
    std::string scene;
    fs::path folder, reference, ladder;
    double seconds = 120;
    std::optional<std::uint32_t> width, height, frame;
    std::uint32_t seeds = 4, shadow_rays = 16;
    bool force = false;
};

/// The given one, or the folder's own, rendered when there is none.
capture::Reference reference_of(const scenes::Scene& scene, const Options& options) {
    const fs::path folder = options.reference.empty() ? options.folder / "reference" : options.reference;
    const std::uint32_t width = options.width.value_or(64), height = options.height.value_or(width);
    if (!options.reference.empty() || capture::holds_reference(folder)) {
        capture::Reference found = capture::load_reference(folder);
        if (found.key.scene_checksum != capture::checksum(scene))
            throw trace::UsageError(
                fmt::format("{}: found a reference of another scene or camera ({}), expected one of {}",
                            folder.string(), found.key.scene, scene.name));
        if ((options.width && *options.width != found.key.width) ||
            ((options.width || options.height) && height != found.key.height))
            throw trace::UsageError(
                fmt::format("{}: found a reference of {} x {} pixels, expected {} x {} as asked for",
                            folder.string(), found.key.width, found.key.height, width, height));
        if (found.samples < 2)
            throw trace::UsageError(fmt::format(
                "{}: found {} samples a pixel, expected at least 2, to know the reference's error",
                folder.string(), found.samples));
        return found;
    }
    capture::Reference reference({scene.name, capture::checksum(scene), width, height, 1});
    const capture::RayCaster caster(scene);
    const capture::LightSampler lights(scene);
    const capture::PathTracer tracer(scene, caster, lights, {.width = width, .height = height, .seed = 1});
    const double until = reference_share * options.seconds;
    Progress progress;
    for (std::uint32_t run = 2; reference.samples < 2 || reference.seconds < until;) {
        reference.add(tracer, run);
        progress.update("path tracing the reference", "ms",
                        static_cast<std::uint64_t>(1000 * std::min(reference.seconds, until)),
                        static_cast<std::uint64_t>(1000 * until));
        const double each = reference.seconds / reference.samples;
        run = static_cast<std::uint32_t>(
            std::clamp(std::min(1.0, until - reference.seconds) / std::max(each, 1e-6), 1.0, 65536.0));
    }
    capture::save(reference, folder);
    capture::write_images(reference, folder);
    return reference;
}

std::vector<study::Setting> ladder_of(const scenes::Scene& scene, const Options& options) {
    if (!options.ladder.empty())
        return study::parse_ladder(trace::read_file(options.ladder), options.ladder.string());
    const trace::Bounds3 box = scene.bounds();
    return study::default_ladder(static_cast<double>(trace::length(box.max - box.min)),
                                 capture::has_caustic_map(scene, capture::CaptureConfig()));
}

std::string strip_title(const study::Setting& setting) {
    const bool direct = setting.mode == capture::Visualisation::direct;
    return fmt::format("{}n={} k={}", direct ? "" : fmt::format("rays={} ", setting.gather_rays),
                       setting.photons, setting.k);
}

/// Strips of the quickest and of the slowest setting of each ladder; settings come in rising cost.
void write_strips(const fs::path& folder, const study::Setting& setting, const capture::Image& image,
                  const capture::Image& reference) {
    fs::create_directories(folder);
    const capture::Picture strip =
        capture::image_strip(image, reference, {strip_title(setting), "reference"});
    const fs::path quickest = folder / fmt::format("{}-quickest.png", setting.ladder);
    if (!fs::exists(quickest)) capture::write_strip(quickest, strip);
    capture::write_strip(folder / fmt::format("{}-slowest.png", setting.ladder), strip);
}

std::vector<results::ConvergenceRow> known_rows(const fs::path& csv, const study::Convergence& convergence,
                                                bool force) {
    if (force || !fs::exists(csv)) return {};
    const auto rows = results::read_csv<results::ConvergenceRow>(csv);
    for (const results::ConvergenceRow& row : rows)
        if (!convergence.belongs(row))
            throw trace::UsageError(
                fmt::format("{}: holds rows of another scene, reference, size, number of seeds or shadow "
                            "rays; give another folder, or "
                            "--force to begin again",
                            csv.string()));
    return rows;
}

void run(const Options& options) {
    if (!(options.seconds > 0))
        throw trace::UsageError(fmt::format("--seconds: found {}, expected more than 0", options.seconds));
    scenes::Scene scene = scenes::load_scene(options.scene);
    if (options.frame) scene.camera = scenes::camera_at(scene, *options.frame);
    const std::vector<study::Setting> ladder = ladder_of(scene, options);
    fs::create_directories(options.folder);
    const capture::Reference reference = reference_of(scene, options);
    const double left = options.reference.empty() ? options.seconds * (1 - reference_share) : options.seconds;

    study::ConvergenceConfig config;
    config.width = reference.key.width;
    config.height = reference.key.height;
    config.seeds = options.seeds;
    config.shadow_rays = options.shadow_rays;
    const study::Convergence convergence(scene, study::truth_of(reference), config);
    const fs::path csv = options.folder / "converge.csv";
    std::vector<results::ConvergenceRow> rows = known_rows(csv, convergence, options.force);
    const std::vector<results::ConvergenceRow> known = rows;
    const nlohmann::json of{{"reference_samples", reference.samples},
                            {"reference_rmse", convergence.reference_rmse()},
                            {"scene_checksum", reference.key.scene_checksum}};

    std::vector<study::Setting> skipped;
    {
        Progress progress;
        const auto told = [&](const study::Setting&, double share) {
            progress.update(fmt::format("converging {}", scene.name), "steps",
                            static_cast<std::uint64_t>(10000 * share), 10000);
        };
        const auto measured = [&](const study::Setting& setting, const study::Measured& found) {
            rows.push_back(found.row);
            results::write_csv<results::ConvergenceRow>(
                csv, rows);  // at each step: a run that is stopped goes on from here
            results::write_provenance(csv, {command_line(), version(), git_revision(), ""}, of);
            write_strips(options.folder / "strips", setting, found.first, reference.mean());
        };
        skipped = study::run(convergence, config, {ladder, known, left, told, measured});
    }

    const double mean = convergence.mean_radiance();
    fmt::print("{}, {} x {} pixels, {} seeds; % of the mean radiance {:.4g} W / (m^2 sr)\n", scene.name,
               config.width, config.height, config.seeds, mean);
    fmt::print("reference: {} samples a pixel in {:.1f} s, own RMSE {:.3g} %; no error below it is told\n",
               reference.samples, reference.seconds,
               100 * convergence.reference_rmse() / (mean > 0 ? mean : 1));
    fmt::print("{}\n{}", charts::convergence_table(rows), charts::time_table(rows));
    if (!known.empty()) fmt::print("{} of {} settings were there already\n", known.size(), rows.size());
    if (!skipped.empty())
        fmt::print("{} of {} settings did not fit into the time; the same command goes on with them\n",
                   skipped.size(), ladder.size());
    for (const auto& drawn : charts::write_charts(options.folder / "charts", {{}, {}, {}, {}, rows}, {}, {}))
        fmt::print("{}\n", drawn.files.empty() ? fmt::format("{}: not drawn: {}", drawn.kind, drawn.skipped)
                                               : drawn.files.back().string());
    fmt::print("strips: {}\nrows: {}\n", (options.folder / "strips").string(), csv.string());
}

}  // namespace

void add_converge(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("converge", "measure error against run time over a ladder of settings");
    command->add_option("scene", options->scene, "an embedded scene's name or a scene file")->required();
    command
        ->add_option("-o,--output", options->folder,
                     "folder for converge.csv, charts/, strips/ and reference/")
        ->required();
    command
        ->add_option("--seconds", options->seconds,
                     "about how long it may take; two fifths are for the reference when there is none")
        ->capture_default_str();
    command->add_option("--width", options->width, "image width [pixels]; without: the reference's, or 64")
        ->check(CLI::Range(1u, 4096u));
    command->add_option("--height", options->height, "image height [pixels]; without: the width")
        ->check(CLI::Range(1u, 4096u));
    command->add_option("--reference", options->reference,
                        "a folder of `regather reference`; without: one is rendered");
    command->add_option("--ladder", options->ladder,
                        "a CSV of settings (docs/converge.md); without: the built-in ladders");
    command->add_option("--seeds", options->seeds, "images of each setting")
        ->check(CLI::Range(1u, 1000u))
        ->capture_default_str();
    command->add_option("--shadow-rays", options->shadow_rays, "per light and shaded point")
        ->check(CLI::Range(0u, 1u << 20))
        ->capture_default_str();
    command->add_option("--frame", options->frame,
                        "of the scene's camera path; without: the standing camera");
    command->add_flag("--force", options->force, "measure again what the folder holds");
    command->footer(
        "A setting that is in the folder's CSV already is not measured again.\nExamples:\n"
        "  regather converge box -o out/box-converge --seconds 120\n"
        "  regather converge room -o out/room-converge --width 128 --reference out/room-reference --seconds "
        "600");
    command->callback([options] { run(*options); });
}

}  // namespace regather::cli
