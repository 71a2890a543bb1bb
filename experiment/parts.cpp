#include "experiment/parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <set>
#include <span>

#include "cachesim/cache_list.h"
#include "experiment/kept.h"
#include "experiment/measurement.h"
#include "experiment/revisits.h"
#include "results/csv.h"
#include "trace/digest.h"
#include "trace/error.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_bytes = std::uint64_t{4} << 30;  // of permutations held: 4 bytes a query each

/// A part's file, and what it depends on.
struct Part {
    std::string key;
    fs::path path;
};

/// One of a trace as the measurement has it laid out.
Part part(const PartStore& store, const char* kind, const trace::TraceReader& trace,
          const Measurement& measurement, const std::string& what) {
    std::string key = fmt::format("{} {} {} {} {} {}", kind, store.revision, trace.checksum(),
                                  trace.info().structure, measurement.layout().name(), what);
    fs::path path = store.folder / fmt::format("{}-{}.part", kind, trace::digest_of(key));
    return {std::move(key), std::move(path)};
}

std::string method_text(const Method& method) {
    if (method.sampling) return fmt::format("1/{} seed {}", method.sampling->one_of, method.sampling->seed);
    return fmt::format("exact{}{}", method.classes ? " classes" : "", method.buffers ? " buffers" : "");
}

std::string cache_texts(std::span<const cachesim::CacheConfig> caches) {
    std::string text;
    for (const cachesim::CacheConfig& cache : caches) text += ' ' + cachesim::cache_text(cache);
    return text;
}

/// Where the queries were searched and how that lies in memory, for people.
std::string place(const Measurement& measurement) {
    return fmt::format("{} in {}", measurement.structure_name(), measurement.layout().name());
}

/// Each once, in the order of the trials.
std::vector<cachesim::CacheConfig> all_caches(const Experiment& experiment) {
    std::vector<cachesim::CacheConfig> caches;
    std::set<std::string> seen;
    for (const Trial& trial : experiment.trials)
        for (const cachesim::CacheConfig& cache : trial.caches)
            if (seen.insert(cachesim::cache_text(cache)).second) caches.push_back(cache);
    return caches;
}

void find_compulsory(Measurement& measurement, const Experiment& experiment, const PartStore& store,
                     const trace::TraceReader& trace) {
    std::set<std::uint32_t> sizes;
    for (const cachesim::CacheConfig& cache : all_caches(experiment)) sizes.insert(cache.line_bytes);
    const std::vector<std::uint32_t> lines(sizes.begin(), sizes.end());
    const Part kept = part(store, "compulsory", trace, measurement, fmt::format("{}", fmt::join(lines, " ")));
    if (const auto text = read_kept(kept.path, kept.key)) {
        for (const results::Row& row : results::from_csv(*text, kept.path.string()))
            measurement.compulsory_bytes[static_cast<std::uint32_t>(row.line_bytes.value_or(0))] =
                row.compulsory_bytes.value_or(0);
        return;
    }
    measurement.find_compulsory(lines);
    std::vector<results::Row> rows;
    for (const auto& [line, bytes] : measurement.compulsory_bytes) {
        results::Row& row = rows.emplace_back();
        row.scene = trace.info().scene;
        row.ordering = "any";
        row.line_bytes = line;
        row.compulsory_bytes = bytes;
    }
    write_kept(kept.path, kept.key, results::to_csv(rows));
}

/// What the replays of all trials share; kept when it is exact.
void prepare(Measurement& measurement, const Experiment& experiment, const PartStore& store,
             const trace::TraceReader& trace, std::size_t missing, const ProgressListener& progress) {
    const std::vector<cachesim::CacheConfig> caches = all_caches(experiment);
    Method method = experiment.method;
    method.several_orders = experiment.trials.size() > 1;
    const Part kept = part(store, "revisits", trace, measurement,
                           fmt::format("{}{}{}", method_text(method), cache_texts(caches),
                                       method.several_orders ? " several orders" : ""));
    const bool exact = !method.sampling;
    const auto listener = [&](const char* stage) {
        return listening(progress, fmt::format(fmt::runtime(stage), place(measurement)), "queries",
                         measurement.queries());
    };
    if (const auto text = exact ? read_kept(kept.path, kept.key) : std::nullopt) {
        measurement.prepare(revisits_in(*text, kept.path), method);
    } else {
        measurement.prepare(caches, method, listener("counting what no order of {} changes"));
        if (exact) write_kept(kept.path, kept.key, text_of(measurement.revisits()));
    }
    if (exact && missing > 1) measurement.hold_first_touches(caches, listener("finding first touches of {}"));
}

/// Their orders are made before the replays, one by one, so that order_seconds is measured on a machine that
/// does nothing else.
void replay(const Measurement& measurement, const Experiment& experiment, std::span<const Part> parts,
            std::span<const std::size_t> missing, const ProgressListener& progress) {
    const std::string stage = fmt::format("replaying {} orderings of {}", missing.size(), place(measurement));
    const std::uint64_t total = missing.size() * measurement.queries();
    std::atomic<std::uint64_t> done{0};
    const auto tell = [&](std::uint64_t more) {
        const std::uint64_t all = done += more;
        if (progress) progress(stage, "queries", all, total);
    };
    const std::uint64_t fitting = most_bytes / (4 * std::max<std::uint64_t>(measurement.queries(), 1));
    const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
    const std::size_t at_once = std::clamp<std::uint64_t>(fitting, 1, threads);
    for (std::size_t first = 0; first < missing.size(); first += at_once) {
        const std::span<const std::size_t> group =
            missing.subspan(first, std::min(at_once, missing.size() - first));
        std::vector<reorder::Ordered> ordered;
        for (const std::size_t t : group) {
            tell(0);
            ordered.push_back(measurement.order(*experiment.trials[t].ordering.ordering));
        }
        tbb::task_group replays;
        for (std::size_t i = 0; i < group.size(); ++i)
            replays.run([&, i] {
                const Trial& trial = experiment.trials[group[i]];
                std::uint64_t before = 0;
                const auto rows =
                    measurement.rows(trial.ordering, ordered[i], trial.caches, [&](std::uint64_t now) {
                        tell(now - before);
                        before = now;
                    });
                write_kept(parts[group[i]].path, parts[group[i]].key, results::to_csv(rows));
            });
        replays.wait();
    }
}

/// The rows of all trials in the measurement's layout.
std::vector<results::Row> rows_in_layout(Measurement& measurement, trace::TraceReader& trace,
                                         const Experiment& experiment, const PartStore& store,
                                         const ProgressListener& progress) {
    find_compulsory(measurement, experiment, store, trace);
    std::vector<Part> parts;
    std::vector<std::optional<std::string>> texts;
    std::vector<std::size_t> missing;
    for (std::size_t t = 0; t < experiment.trials.size(); ++t) {
        const Trial& trial = experiment.trials[t];
        parts.push_back(part(
            store, "rows", trace, measurement,
            fmt::format("{} {} {} {}{}", trial.ordering.spec.text, trial.library_digest,
                        experiment.onchip_bytes, method_text(experiment.method), cache_texts(trial.caches))));
        texts.push_back(read_kept(parts[t].path, parts[t].key));
        if (!texts[t]) missing.push_back(t);
    }
    if (!missing.empty()) {
        prepare(measurement, experiment, store, trace, missing.size(), progress);
        replay(measurement, experiment, parts, missing, progress);
    }
    std::vector<results::Row> rows;
    for (std::size_t t = 0; t < parts.size(); ++t) {
        if (!texts[t]) texts[t] = read_kept(parts[t].path, parts[t].key);
        if (!texts[t])
            throw trace::DataError(
                fmt::format("{}: found another file than was written a moment ago, expected it to stay",
                            parts[t].path.string()));
        for (results::Row& row : results::from_csv(*texts[t], parts[t].path.string()))
            rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace

std::vector<results::Row> rows_of(trace::TraceReader& trace, std::span<const std::string> layouts,
                                  const Experiment& experiment, const PartStore& store,
                                  const ProgressListener& progress) {
    Measurement measurement(trace, reads(experiment), experiment.onchip_bytes);
    fs::create_directories(store.folder);
    std::vector<results::Row> rows;
    for (const std::string& layout : layouts) {
        measurement.lay_out(layout);
        for (results::Row& row : rows_in_layout(measurement, trace, experiment, store, progress))
            rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace regather::experiment
