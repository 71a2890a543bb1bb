#include "experiment/replays.h"

#include <fmt/format.h>

#include <set>

#include "experiment/address_sweep.h"
#include "replay/layouts/catalogue.h"
#include "results/benefit.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::experiment {

std::vector<results::Row> through_caches(Measurement& measurement, std::span<const std::string> layouts,
                                         std::span<const reorder::ParsedOrdering> orderings,
                                         std::span<const cachesim::CacheConfig> caches, const Method& method,
                                         const ProgressListener& progress) {
    std::set<std::uint32_t> lines;
    for (const cachesim::CacheConfig& cache : caches) lines.insert(cache.line_bytes);
    std::vector<replay::Layout> laid_out;
    std::set<std::string, std::less<>> names;
    const std::vector<trace::Vec3> positions = measurement.record_positions();
    if (layouts.empty()) laid_out.push_back(replay::usual_layout(measurement.walks().structure()));
    for (const std::string& spec : layouts) {
        laid_out.push_back(replay::make_layout(spec, measurement.walks().structure(), positions));
        if (!names.emplace(laid_out.back().name()).second)
            throw trace::UsageError(fmt::format("layout {}: found {} twice, expected each layout once",
                                                trace::shown(spec), laid_out.back().name()));
    }
    std::vector<results::Row> rows;
    for (replay::Layout& layout : laid_out) {
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

std::vector<results::MachineRow> through_machines(const Measurement& measurement,
                                                  std::span<const reorder::ParsedOrdering> orderings,
                                                  std::span<const cachesim::Machine> machines,
                                                  const std::string& scene,
                                                  const ProgressListener& progress) {
    std::vector<results::MachineRow> rows;
    for (const reorder::ParsedOrdering& parsed : orderings) {
        std::vector<cachesim::Hierarchy> systems;
        for (const cachesim::Machine& machine : machines) systems.push_back(machine.hierarchy());
        measurement.through(
            measurement.order(*parsed.ordering), systems,
            listening(progress, "replaying " + parsed.spec.text, "queries", measurement.queries()));
        for (std::size_t m = 0; m < machines.size(); ++m)
            for (results::MachineRow& row : machine_rows(machines[m], systems[m])) {
                row.scene = scene;
                row.ordering = parsed.spec.name;
                row.parameters = parsed.spec.text;
                rows.push_back(std::move(row));
            }
    }
    return rows;
}

}  // namespace regather::experiment
