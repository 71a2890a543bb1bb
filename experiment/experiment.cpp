#include "experiment/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "cachesim/cache_list.h"
#include "experiment/frames.h"
#include "experiment/measurement.h"
#include "experiment/traces/capture_job.h"
#include "reorder/shared_library.h"
#include "replay/layouts/catalogue.h"
#include "scenes/loader.h"
#include "scenes/needs.h"
#include "spatial/photons/left_balanced.h"
#include "spatial/photons/photon_kd.h"
#include "spatial/photons/structures.h"
#include "trace/digest.h"
#include "trace/field.h"
#include "trace/file.h"
#include "trace/size.h"

namespace regather::experiment {
namespace {

using trace::Field, trace::Kind;

constexpr std::uint64_t most_experiment_bytes = 16 << 20;

const Kind experiment_kind{"experiment",
                           {{"scene", true, "the name of a scene, or a scene file"},
                            {"capture", false, "an object"},
                            {"orderings", true, "a list of orderings"},
                            {"caches", false, "a list of caches"},
                            {"structures", false, "a list of structures"},
                            {"layouts", false, "a list of layouts"},
                            {"onchip", false, "one size"},
                            {"classes", false, "true or false"},
                            {"buffers", false, "true or false"},
                            {"sample", false, "a whole number from 1 to 1024"},
                            {"sample_seed", false, "a whole number"}}};
const Kind cache_kind{"cache",
                      {{"size", false, "a size or a list of sizes"},
                       {"line", false, "a size or a list of sizes"},
                       {"ways", false, "a number of ways or a list of them"}}};

/// The list at a key, which is not empty.
std::vector<Field> entries(const Field& owner, std::string_view key) {
    const std::vector<Field> all = owner[key].elements("a list with at least one entry");
    if (all.empty()) owner[key].fail("an empty list", "a list with at least one entry");
    return all;
}

std::vector<std::string> texts(const Field& owner, std::string_view key, const char* otherwise) {
    const std::optional<Field> field = owner.get(key);
    return field ? field->texts() : std::vector<std::string>{otherwise};
}

std::vector<cachesim::CacheConfig> listed_caches(const Field& owner) {
    std::vector<cachesim::CacheConfig> caches;
    for (const Field& entry : entries(owner, "caches")) {
        entry.check(cache_kind);
        for (const std::string& size : texts(entry, "size", "128K"))
            for (const std::string& line : texts(entry, "line", "128"))
                for (const std::string& ways : texts(entry, "ways", "8"))
                    for (const cachesim::CacheConfig& cache : entry.checked([&] {
                             return cachesim::parse_caches(fmt::format("{}:{}:{}", size, line, ways));
                         }))
                        caches.push_back(cache);
    }
    return caches;
}

/// An entry of a list, a name by itself or an object that has it at `what` beside parameters and, at `own`,
/// what it has in place of the experiment's: "name:a=1,b=2" for each combination of the lists of values, the
/// keys in alphabetical order.
std::vector<std::string> specs(const Field& entry, std::string_view what, std::string_view own) {
    if (entry.value().text() != nullptr) return {entry.text()};
    const std::string article = what == "ordering" ? "an" : "a";
    if (!entry.value().is_object())
        entry.fail(entry.found(), fmt::format("the name of {} {}, or an object", article, what));
    std::map<std::string, std::vector<std::string>> parameters;
    for (const auto& [key, field] : entry.members())
        if (key != what && key != own) parameters[key] = field.texts();
    std::vector<std::string> all{entry[what].text(fmt::format("the name of {} {}", article, what))};
    for (const auto& [key, values] : parameters) {
        std::vector<std::string> longer;
        for (const std::string& spec : all)
            for (const std::string& value : values)
                longer.push_back(
                    fmt::format("{}{}{}={}", spec, key == parameters.begin()->first ? ":" : ",", key, value));
        all = std::move(longer);
    }
    return all;
}

/// Whether an entry of a list is an object with this key.
bool has(const Field& entry, std::string_view key) {
    return entry.value().is_object() && entry.has(key);
}

/// A small one of a structure, for what can be told before a capture.
class Specimen {
public:
    explicit Specimen(const spatial::StructureSpec& spec) {
        constexpr std::uint32_t photons = 256, k = 8;  // more than any leaf holds
        for (std::uint32_t i = 0; i < photons; ++i) {
            trace::Photon photon;
            photon.position = {static_cast<float>(i), static_cast<float>(i * 37 % 101),
                               static_cast<float>(i * i % 89)};
            heap_.push_back(photon);
            positions_.push_back(photon.position);
        }
        heap_ = spatial::left_balanced(heap_);
        search_ = spatial::build(spec, heap_, k, std::numeric_limits<float>::infinity());
    }
    replay::Layout layout(std::string_view spec) const {
        return replay::make_layout(spec, *search_->structure(), positions_);
    }
    std::string default_layout() const { return replay::default_layout(*search_->structure()); }

private:
    std::vector<trace::Photon> heap_;
    std::vector<trace::Vec3> positions_;
    std::unique_ptr<spatial::PhotonSearch> search_;
};

/// One structure with the layouts at the key "layouts" of `owner`; each of them suits it.
Searched searched(const spatial::StructureSpec& spec, const Field& entry, const Field& owner) {
    const Specimen specimen = entry.checked([&] { return Specimen(spec); });
    Searched all{spec.text, {}};
    if (!has(owner, "layouts")) {
        all.layouts.push_back(specimen.default_layout());
        return all;
    }
    for (const Field& layout : entries(owner, "layouts")) {
        const std::string& text = layout.text("the name of a layout");
        const std::string name = layout.checked([&] { return std::string(specimen.layout(text).name()); });
        if (std::find(all.layouts.begin(), all.layouts.end(), name) != all.layouts.end())
            layout.fail(fmt::format("{} a second time", name), "each layout once");
        all.layouts.push_back(name);
    }
    return all;
}

std::vector<Searched> all_searched(const Field& in) {
    if (!in.has("structures"))
        return {searched(spatial::parse_structure(spatial::LeftBalanced::structure_name), in, in)};
    std::vector<Searched> all;
    bool common = false;  // whether any has none of its own
    for (const Field& entry : entries(in, "structures"))
        for (const std::string& text : specs(entry, "structure", "layouts")) {
            const spatial::StructureSpec spec = entry.checked([&] { return spatial::parse_structure(text); });
            for (const Searched& before : all)
                if (before.structure == spec.text)
                    entry.fail(fmt::format("{} a second time", spec.text), "each structure once");
            all.push_back(searched(spec, entry, has(entry, "layouts") ? entry : in));
            common |= !has(entry, "layouts");
        }
    if (!common && in.has("layouts"))
        in["layouts"].refuse("found beside layouts of each structure, expected one or the other");
    return all;
}

/// XXH3-64 of the bytes of a user's library; empty for an ordering of ours.
std::string library_digest(const reorder::Ordering& ordering) {
    const auto* library = dynamic_cast<const reorder::SharedLibrary*>(&ordering);
    if (!library) return {};
    return trace::digest_of(trace::read_file(library->path()));
}

/// An ordering through a cache is a row: each may be asked for once.
void refuse_repeated_rows(const std::vector<Trial>& trials, const Field& orderings) {
    std::set<std::string> seen;
    for (const Trial& trial : trials)
        for (const cachesim::CacheConfig& cache : trial.caches)
            if (!seen.insert(trial.ordering.spec.text + ' ' + cachesim::cache_text(cache)).second)
                orderings.fail(fmt::format("{} through the cache {} twice", trial.ordering.spec.text,
                                           cachesim::cache_text(cache)),
                               "each once");
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& path) {
    const trace::Document document(trace::read_file(path, most_experiment_bytes), path.string());
    const Field in = document.root();
    in.check(experiment_kind);
    Experiment experiment;
    experiment.scene = in["scene"].text();
    // A scene file is named relative to the experiment that uses it.
    if (experiment.scene.ends_with(".json") && std::filesystem::path(experiment.scene).is_relative())
        experiment.scene = (path.parent_path() / experiment.scene).string();
    const scenes::Scene scene = in["scene"].checked([&] { return scenes::load_scene(experiment.scene); });
    if (const std::optional<Field> asked = in.get("capture")) {
        experiment.capture = capture_options(*asked);
        const capture::CaptureConfig config = asked->checked([&] { return experiment.capture.config(); });
        if (const std::optional<Field> frames = asked->get("frames"))
            frames->checked([&] { return parse_frames(experiment.capture.frames, frames_of(scene)); });
        if (const std::optional<Field> keep = asked->get("keep"))
            keep->checked([&] {
                scenes::Needs needs = scenes::needs_of(scene);
                needs.keep(config.keep);
            });
    }
    if (const std::optional<Field> onchip = in.get("onchip")) {
        const std::vector<std::string> sizes = onchip->texts();
        if (sizes.size() != 1) onchip->fail(onchip->found(), "one size");
        experiment.onchip_bytes = onchip->checked([&] { return trace::parse_size(sizes.front()); });
    }
    const std::vector<cachesim::CacheConfig> caches =
        in.has("caches") ? listed_caches(in) : std::vector<cachesim::CacheConfig>{cachesim::CacheConfig{}};

    experiment.searched = all_searched(in);

    const auto flag = [&](std::string_view key) { return in.has(key) && in[key].truth(); };
    experiment.method.classes = flag("classes");
    experiment.method.buffers = flag("buffers");
    const std::uint32_t one_of = in.has("sample") ? in["sample"].whole(1, 1024) : 1;
    const std::uint64_t sample_seed =
        in.has("sample_seed") ? in["sample_seed"].whole<std::uint64_t>(0, ~std::uint64_t{0}) : 1;
    if (in.has("sample_seed") && !in.has("sample"))
        in["sample_seed"].refuse("found without \"sample\", expected both or none");
    if (one_of != 1) {
        for (const char* const key : {"classes", "buffers"})
            if (flag(key)) in[key].fail("true beside \"sample\"", "one of them");
        experiment.method.sampling = replay::Sampling{one_of, sample_seed};
    }

    bool common = false;  // whether any has no caches of its own
    for (const Field& entry : entries(in, "orderings")) {
        common |= !has(entry, "caches");
        for (const std::string& spec : specs(entry, "ordering", "caches")) {
            reorder::ParsedOrdering parsed =
                entry.checked([&] { return reorder::parse_ordering(spec, path.parent_path()); });
            std::string digest = library_digest(*parsed.ordering);
            experiment.trials.push_back(
                {std::move(parsed), has(entry, "caches") ? listed_caches(entry) : caches, std::move(digest)});
        }
        if (experiment.method.sampling)
            in["sample"].checked([&] {
                replay::SetSample::check(experiment.trials.back().caches, *experiment.method.sampling);
            });
    }
    if (!common && in.has("caches"))
        in["caches"].refuse("found beside caches of each ordering, expected one or the other");
    refuse_repeated_rows(experiment.trials, in["orderings"]);
    return experiment;
}

reorder::Reads reads(const Experiment& experiment) {
    reorder::Reads all;
    for (const Trial& trial : experiment.trials) all |= trial.ordering.ordering->reads();
    return all;
}

}  // namespace regather::experiment
