#include "experiment/replays.h"

#include <fmt/format.h>

#include <set>

#include "experiment/address_sweep.h"
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

std::vector<results::Row> through_caches(Measurement& measurement, std::span<const std::string> layouts,
                                         std::span<const reorder::ParsedOrdering> orderings,
                                         std::span<const cachesim::CacheConfig> caches, const Method& method,
                                         const ProgressListener& progress) {
    std::set<std::uint32_t> lines;
    for (const cachesim::CacheConfig& cache : caches) lines.insert(cache.line_bytes);
    std::vector<results::Row> rows;
    for (replay::Layout& layout : laid_out(measurement, layouts)) {
        const std::string on = layouts.size() > 1 ? fmt::format(" on {}", layout.name()) : "";
        measurement.lay_out(std::move(layout));
        measurement.find_compulsory(std::vector<std::uint32_t>(lines.begin(), lines.end()));
        measurement.prepare(
            caches, method,
            listening(progress, "counting what no order changes" + on, "queries", measurement.queries()));
        std::vector<results::Row> of_layout;
        for (const reorder::ParsedOrdering& parsed : orderings)
            for (results::Row& row :
                 measurement.rows(parsed, measurement.order(*parsed.ordering), caches,
                                  listening(progress, "replaying " + parsed.spec.text + on, "queries",
                                            measurement.queries())))
                of_layout.push_back(std::move(row));
        results::fill_net_benefit(of_layout);
        rows.insert(rows.end(), of_layout.begin(), of_layout.end());
    }
    return rows;
}

std::vector<results::MachineRow> through_machines(Measurement& measurement,
                                                  std::span<const std::string> layouts,
                                                  std::span<const reorder::ParsedOrdering> orderings,
                                                  std::span<const cachesim::Machine> machines,
                                                  const ProgressListener& progress) {
    std::vector<results::MachineRow> rows;
    for (replay::Layout& layout : laid_out(measurement, layouts)) {
        const std::string on = layouts.size() > 1 ? fmt::format(" on {}", layout.name()) : "";
        measurement.lay_out(std::move(layout));
        for (const reorder::ParsedOrdering& parsed : orderings) {
            std::vector<cachesim::Hierarchy> systems;
            for (const cachesim::Machine& machine : machines) systems.push_back(machine.hierarchy());
            measurement.through(
                measurement.order(*parsed.ordering), systems,
                listening(progress, "replaying " + parsed.spec.text + on, "queries", measurement.queries()));
            for (std::size_t m = 0; m < machines.size(); ++m)
                for (results::MachineRow& row : machine_rows(machines[m], systems[m].counts())) {
                    row.scene = measurement.info().scene;
                    row.structure = measurement.structure_name();
                    row.layout = measurement.layout().name();
                    row.ordering = parsed.spec.name;
                    row.parameters = parsed.spec.text;
                    rows.push_back(std::move(row));
                }
        }
    }
    return rows;
}

}  // namespace regather::experiment
