#include "experiment/experiment.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "cachesim/cache_list.h"
#include "experiment/capture_job.h"
#include "experiment/frames.h"
#include "experiment/keys.h"
#include "experiment/measurement.h"
#include "reorder/shared_library.h"
#include "scenes/loader.h"
#include "scenes/needs.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/size.h"

namespace regather::experiment {
namespace {

using nlohmann::json;

/// Runs `make`, whose usage errors are this file's bad data.
template <class Make>
auto at(const Object& object, std::string_view key, const Make& make) {
    try {
        return make();
    } catch (const trace::UsageError& error) {
        throw trace::DataError(fmt::format("{}: {}: {}", object.file(), object.place(key), error.what()));
    }
}

std::vector<cachesim::CacheConfig> listed_caches(const Object& owner) {
    static constexpr std::array<std::string_view, 3> keys{"size", "line", "ways"};
    std::vector<cachesim::CacheConfig> caches;
    const json& list = owner.array("caches");
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Object entry(list[i], keys, owner.file(), owner.place(fmt::format("caches[{}]", i)));
        for (const std::string& size : entry.list("size", {"128K"}))
            for (const std::string& line : entry.list("line", {"128"}))
                for (const std::string& ways : entry.list("ways", {"8"}))
                    for (const cachesim::CacheConfig& cache : at(owner, fmt::format("caches[{}]", i), [&] {
                             return cachesim::parse_caches(fmt::format("{}:{}:{}", size, line, ways));
                         }))
                        caches.push_back(cache);
    }
    return caches;
}

/// "name:a=1,b=2" for each combination of the lists of values.
std::vector<std::string> specs(const json& entry, const Object& object, const std::string& name) {
    std::vector<std::string> all{name};
    bool first = true;
    for (const auto& [key, unused] : entry.items()) {
        if (key == "ordering" || key == "caches") continue;
        std::vector<std::string> longer;
        for (const std::string& spec : all)
            for (const std::string& value : object.list(key, {}))
                longer.push_back(fmt::format("{}{}{}={}", spec, first ? ":" : ",", key, value));
        all = std::move(longer);
        first = false;
    }
    return all;
}

/// XXH3-64 of the bytes of a user's library; empty for an ordering of ours.
std::string library_digest(const reorder::Ordering& ordering) {
    const auto* library = dynamic_cast<const reorder::SharedLibrary*>(&ordering);
    if (!library) return {};
    const std::string bytes = trace::read_file(library->path());
    return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

/// An ordering through a cache is a row: each may be asked for once.
void refuse_repeated_rows(const std::vector<Trial>& trials, const Object& in) {
    std::set<std::string> seen;
    for (const Trial& trial : trials)
        for (const cachesim::CacheConfig& cache : trial.caches)
            if (!seen.insert(trial.ordering.spec.text + ' ' + cachesim::cache_text(cache)).second)
                in.refuse("orderings",
                          fmt::format("{} through the cache {} twice", trial.ordering.spec.text,
                                      cachesim::cache_text(cache)),
                          "each once");
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& path) {
    std::ifstream stream(path);
    if (!stream)
        throw trace::DataError(fmt::format("{}: found no such file, expected an experiment", path.string()));
    json root;
    try {
        // A key that stands twice in an object would silently lose its first value.
        std::vector<std::set<std::string>> open_objects;
        root = json::parse(stream, [&](int, json::parse_event_t event, json& value) {
            if (event == json::parse_event_t::object_start) open_objects.emplace_back();
            if (event == json::parse_event_t::object_end) open_objects.pop_back();
            if (event == json::parse_event_t::key &&
                !open_objects.back().insert(value.get<std::string>()).second)
                throw trace::DataError(
                    fmt::format("{}: {}: found the key twice in one object, expected it once", path.string(),
                                value.get<std::string>()));
            return true;
        });
    } catch (const json::exception& error) {
        throw trace::DataError(fmt::format("{}: found no valid JSON ({})", path.string(), error.what()));
    }
    static constexpr std::array<std::string_view, 9> keys{
        "scene", "capture", "orderings", "caches", "onchip", "classes", "buffers", "sample", "sample_seed"};
    const Object in(root, keys, path.string(), "");
    Experiment experiment;
    experiment.scene = in.text("scene");
    // A scene file is named relative to the experiment that uses it.
    if (experiment.scene.ends_with(".json") && std::filesystem::path(experiment.scene).is_relative())
        experiment.scene = (path.parent_path() / experiment.scene).string();
    const scenes::Scene scene = at(in, "scene", [&] { return scenes::load_scene(experiment.scene); });
    if (in.has("capture")) experiment.capture = capture_options(root["capture"], path.string());
    at(in, "capture", [&] { return experiment.capture.config(); });
    if (!experiment.capture.frames.empty())
        at(in, "capture.frames", [&] { return parse_frames(experiment.capture.frames, frames_of(scene)); });
    at(in, "capture.keep", [&] {
        scenes::Needs needs = scenes::needs_of(scene);
        needs.keep(experiment.capture.config().keep);
        return needs;
    });
    if (in.has("onchip")) {
        const std::vector<std::string> sizes = in.list("onchip", {});
        if (sizes.size() != 1) in.refuse("onchip", root["onchip"].dump(), "one size");
        experiment.onchip_bytes = at(in, "onchip", [&] { return trace::parse_size(sizes.front()); });
    }
    const std::vector<cachesim::CacheConfig> caches =
        in.has("caches") ? listed_caches(in) : std::vector<cachesim::CacheConfig>{cachesim::CacheConfig{}};

    experiment.method.classes = in.flag("classes", false);
    experiment.method.buffers = in.flag("buffers", false);
    if (const std::uint64_t one_of = in.number("sample", 1, 1, 1024); one_of != 1) {
        for (const auto& [key, asked] :
             {std::pair{"classes", experiment.method.classes}, {"buffers", experiment.method.buffers}})
            if (asked) in.refuse(key, "true beside \"sample\"", "one of them");
        experiment.method.sampling = replay::Sampling{static_cast<std::uint32_t>(one_of),
                                                      in.number("sample_seed", 1, 0, ~std::uint64_t{0})};
    }

    const json& list = in.array("orderings");
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string place = fmt::format("orderings[{}]", i);
        const json entry = list[i].is_string() ? json{{"ordering", list[i]}} : list[i];
        std::vector<std::string_view> known;
        if (entry.is_object())
            for (const auto& [key, unused] : entry.items())
                known.push_back(key);  // the ordering knows its own keys
        const Object object(entry, known, path.string(), place);
        const std::string name = object.text("ordering");
        for (const std::string& spec : specs(entry, object, name)) {
            reorder::ParsedOrdering parsed = at(in, place, [&] { return reorder::parse_ordering(spec); });
            std::string digest = library_digest(*parsed.ordering);
            experiment.trials.push_back({std::move(parsed),
                                         object.has("caches") ? listed_caches(object) : caches,
                                         std::move(digest)});
        }
        if (experiment.method.sampling)
            at(in, "sample", [&] {
                replay::SetSample::check(experiment.trials.back().caches, *experiment.method.sampling);
                return 0;
            });
    }
    refuse_repeated_rows(experiment.trials, in);
    return experiment;
}

reorder::Reads reads(const Experiment& experiment) {
    reorder::Reads all;
    for (const Trial& trial : experiment.trials) all |= trial.ordering.ordering->reads();
    return all;
}

}  // namespace regather::experiment
