#include "experiment/replays.h"

#include <fmt/format.h>

#include <set>

#include "experiment/address_sweep.h"
#include "experiment/treelet_replay.h"
#include "replay/layouts/catalogue.h"
#include "results/benefit.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::experiment {

namespace {

/// The layouts that were asked for, each once; without one, the measurement's.
std::vector<replay::Layout> laid_out(const Measurement& measurement, std::span<const std::string> layouts) {
    std::vector<replay::Layout> all;
    std::set<std::string, std::less<>> names;
    const std::vector<trace::Vec3> positions = measurement.record_positions();
    if (layouts.empty()) all.push_back(measurement.layout());
    for (const std::string& spec : layouts) {
        all.push_back(replay::make_layout(spec, measurement.walks().structure(), positions));
        if (!names.emplace(all.back().name()).second)
            throw trace::UsageError(fmt::format("layout {}: found {} twice, expected each layout once",
                                                trace::shown(spec), all.back().name()));
    }
    return all;
}

}  // namespace

std::vector<results::Row> through_caches(Measurement& measurement, const Replays& replays,
                                         std::span<const cachesim::CacheConfig> caches, const Method& asked,
                                         const ProgressListener& progress) {
    if (!replays.treelets.empty()) replay::hierarchy_of(measurement.walks());
    Method method = asked;
    method.several_orders = replays.orderings.size() > 1;
    std::set<std::uint32_t> lines;
    for (const cachesim::CacheConfig& cache : caches) lines.insert(cache.line_bytes);
    std::vector<results::Row> rows;
    for (replay::Layout& layout : laid_out(measurement, replays.layouts)) {
        const std::string on = replays.layouts.size() > 1 ? fmt::format(" on {}", layout.name()) : "";
        measurement.lay_out(std::move(layout));
        measurement.find_compulsory(std::vector<std::uint32_t>(lines.begin(), lines.end()));
        measurement.prepare(
            caches, method,
            listening(progress, "counting what no order changes" + on, "queries", measurement.queries()));
        if (method.several_orders && !method.sampling)
            measurement.hold_first_touches(
                caches, listening(progress, "finding first touches" + on, "queries", measurement.queries()));
        std::vector<results::Row> of_layout;
        const auto add = [&](std::vector<results::Row> more) {
            for (results::Row& row : more) of_layout.push_back(std::move(row));
        };
        for (const reorder::ParsedOrdering& parsed : replays.orderings) {
            const reorder::Ordered ordered = measurement.order(*parsed.ordering);
            add(measurement.rows(
                parsed, ordered, caches,
                listening(progress, "replaying " + parsed.spec.text + on, "queries", measurement.queries())));
            for (const replay::TreeletConfig& treelets : replays.treelets)
                add(treelet_rows(
                    measurement, {parsed, ordered, treelets}, caches,
                    listening(progress, "queueing " + parsed.spec.text + on, "rays", measurement.queries())));
        }
        results::fill_net_benefit(of_layout);
        rows.insert(rows.end(), of_layout.begin(), of_layout.end());
    }
    return rows;
}

std::vector<results::MachineRow> through_machines(Measurement& measurement, const Replays& replays,
                                                  std::span<const cachesim::Machine> machines,
                                                  const ProgressListener& progress) {
    if (!replays.treelets.empty()) replay::hierarchy_of(measurement.walks());
    std::vector<results::MachineRow> rows;
    for (replay::Layout& layout : laid_out(measurement, replays.layouts)) {
        const std::string on = replays.layouts.size() > 1 ? fmt::format(" on {}", layout.name()) : "";
        measurement.lay_out(std::move(layout));
        const auto add = [&](const reorder::OrderingSpec& spec,
                             std::span<const cachesim::Hierarchy> systems) {
            for (std::size_t m = 0; m < machines.size(); ++m)
                for (results::MachineRow& row : machine_rows(machines[m], systems[m].counts())) {
                    row.scene = measurement.info().scene;
                    row.structure = measurement.structure_name();
                    row.layout = measurement.layout().name();
                    row.ordering = spec.name;
                    row.parameters = spec.text;
                    rows.push_back(std::move(row));
                }
        };
        const auto systems = [&] {
            std::vector<cachesim::Hierarchy> empty;
            for (const cachesim::Machine& machine : machines) empty.push_back(machine.hierarchy());
            return empty;
        };
        for (const reorder::ParsedOrdering& parsed : replays.orderings) {
            const reorder::Ordered ordered = measurement.order(*parsed.ordering);
            std::vector<cachesim::Hierarchy> plain = systems();
            measurement.through(
                ordered, plain,
                listening(progress, "replaying " + parsed.spec.text + on, "queries", measurement.queries()));
            add(parsed.spec, plain);
            for (const replay::TreeletConfig& treelets : replays.treelets) {
                std::vector<cachesim::Hierarchy> queued = systems();
                const TreeletFeed feed{parsed, ordered, treelets};
                through_treelets(
                    measurement, feed, queued,
                    listening(progress, "queueing " + parsed.spec.text + on, "rays", measurement.queries()));
                add(spec_of(feed), queued);
            }
        }
    }
    return rows;
}

}  // namespace regather::experiment
