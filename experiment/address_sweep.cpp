#include "experiment/address_sweep.h"

#include <fmt/format.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <set>

#include "cachesim/cache_list.h"
#include "cachesim/lru/family_sweep.h"
#include "cachesim/policies/policy_sweep.h"
#include "trace/error.h"

namespace regather::experiment {
namespace {

using cachesim::DramStats, cachesim::Hierarchy, cachesim::LevelStats, cachesim::Machine;

void tell(const cachesim::AddressTrace& trace, std::string_view stage, const SweepListeners& listeners) {
    const auto [done, total, unit] = trace.position();
    if (total != 0 && listeners.progress) listeners.progress(stage, unit, done, total);
}

void tell_notes(const cachesim::AddressTrace& trace, const SweepListeners& listeners) {
    if (!listeners.note) return;
    for (const std::string& note : trace.notes()) listeners.note(note);
}

/// The columns of a cache's shape and policy.
results::CacheRow row_of(const cachesim::PolicyConfig& config) {
    results::CacheRow row;
    row.policy = name_of(config.policy);
    row.size_bytes = config.geometry.size_bytes;
    row.line_bytes = config.geometry.line_bytes;
    row.ways = config.geometry.ways == cachesim::fully_associative ? 0 : config.geometry.ways;
    row.write = cachesim::write_policy_names[static_cast<std::size_t>(config.write)];
    row.write_miss = cachesim::write_miss_names[static_cast<std::size_t>(config.write_miss)];
    row.index = cachesim::set_index_names[static_cast<std::size_t>(config.index)];
    if (config.policy == cachesim::Policy::random) row.seed = config.seed;
    return row;
}

std::vector<results::CacheRow> rows_of(std::span<const cachesim::PolicyRow> simulated) {
    std::vector<results::CacheRow> rows;
    for (const auto& [config, stats, classes] : simulated) {
        results::CacheRow& row = rows.emplace_back(row_of(config));
        row.accesses = stats.accesses;
        row.hits = stats.hits();
        row.misses = stats.misses;
        if (classes) {
            row.compulsory = classes->compulsory;
            row.capacity = classes->capacity;
            row.conflict = classes->conflict;
        }
        row.writebacks = stats.writebacks;
        row.writes_through = stats.passed_writes;
        row.traffic_bytes = stats.traffic_bytes(config.geometry.line_bytes);
    }
    return rows;
}

bool took_part(const cachesim::HierarchyCounts& counts, std::size_t region) {
    return counts.dram[region] != DramStats{} ||
           std::any_of(counts.levels.begin(), counts.levels.end(),
                       [&](const auto& level) { return level[region] != LevelStats{}; });
}

}  // namespace

Combinations combinations(const CacheLists& lists) {
    Combinations all;
    std::set<std::string> seen;
    for (const cachesim::CacheConfig& geometry :
         cachesim::multiplied_out(lists.sizes, lists.lines, lists.ways))
        for (const std::string_view policy : cachesim::list_parts(lists.policies)) {
            const cachesim::PolicyConfig config{geometry,
                                                cachesim::parse_policy(policy),
                                                cachesim::parse_write_policy(lists.write),
                                                cachesim::parse_write_miss(lists.write_miss),
                                                cachesim::parse_set_index(lists.index),
                                                lists.seed};
            const std::string name =
                fmt::format("--size {} --line {} --ways {} --policy {}", geometry.size_bytes,
                            geometry.line_bytes, cachesim::ways_text(geometry.ways), policy);
            if (!seen.insert(name).second)
                throw trace::UsageError(fmt::format("{}: found twice, expected each cache once", name));
            try {
                check(config);
                all.caches.push_back(config);
            } catch (const trace::UsageError& error) {
                all.left_out.push_back(fmt::format("{}: {}", name, error.what()));
            }
        }
    if (all.caches.empty()) throw trace::UsageError(all.left_out.front());
    return all;
}

std::vector<results::CacheRow> sweep_policies(const cachesim::AddressFiles& files,
                                              std::span<const cachesim::PolicyConfig> configs,
                                              const cachesim::PolicySweepOptions& options,
                                              const SweepListeners& listeners) {
    cachesim::AddressTrace trace(files);
    cachesim::PolicySweep sweep(configs, options);
    for (auto records = trace.next(); !records.empty(); records = trace.next()) {
        sweep.access(records);
        tell(trace, "cachesim", listeners);
    }
    tell_notes(trace, listeners);
    return rows_of(sweep.finish([&](std::uint64_t done, std::uint64_t total) {
        if (listeners.progress) listeners.progress("cachesim: opt", "accesses", done, total);
    }));
}

std::vector<results::CacheRow> sweep_all_lru(const cachesim::AddressFiles& files,
                                             std::span<const std::uint32_t> line_sizes,
                                             std::uint32_t most_ways, bool classes,
                                             const SweepListeners& listeners) {
    cachesim::AddressTrace trace(files);
    cachesim::FamilySweep sweep(line_sizes, most_ways, classes);
    bool writes = false;
    for (auto records = trace.next(); !records.empty(); records = trace.next()) {
        sweep.access(records);
        for (const cachesim::ByteAccess& access : records)
            writes = writes || access.kind == cachesim::Access::write;
        tell(trace, "cachesim: all lru", listeners);
    }
    tell_notes(trace, listeners);
    std::vector<results::CacheRow> rows;
    for (const cachesim::FamilyRow& found : sweep.rows()) {
        cachesim::PolicyConfig config;
        config.geometry = found.config;
        results::CacheRow& row = rows.emplace_back(row_of(config));
        row.accesses = found.accesses;
        row.hits = found.accesses - found.misses;
        row.misses = found.misses;
        if (classes) {
            row.compulsory = found.compulsory;
            row.capacity = found.capacity;
            row.conflict = found.conflict;
        }
        if (writes) continue;
        row.writebacks = row.writes_through = 0;
        row.traffic_bytes = found.misses * found.config.line_bytes;
    }
    return rows;
}

std::vector<Machine> load_machines(std::string_view list) {
    std::vector<Machine> machines;
    for (const std::string_view name : cachesim::list_parts(list)) {
        machines.push_back(cachesim::load_machine(name));
        if (std::count_if(machines.begin(), machines.end(),
                          [&](const Machine& one) { return one.name == machines.back().name; }) > 1)
            throw trace::UsageError(
                fmt::format("--machine: found {} twice, expected each machine once", machines.back().name));
    }
    return machines;
}

std::vector<results::MachineRow> machine_rows(const Machine& machine,
                                              const cachesim::HierarchyCounts& counts) {
    std::vector<results::MachineRow> rows;
    const auto each_region = [&](std::string_view level, const auto& fill) {
        for (std::size_t r = 0; r < trace::region_count; ++r) {
            if (!took_part(counts, r)) continue;
            results::MachineRow& row = rows.emplace_back();
            row.machine = machine.name;
            row.level = level;
            row.region = trace::region_names[r];
            fill(row, r);
        }
    };
    for (std::size_t level = 0; level < counts.levels.size(); ++level)
        each_region(machine.levels[level].name, [&](results::MachineRow& row, std::size_t region) {
            const LevelStats& stats = counts.levels[level][region];
            row.accesses = stats.accesses;
            row.hits = stats.hits;
            row.misses = stats.misses;
            row.sector_misses = stats.sector_misses;
            row.victim_hits = stats.victim_hits;
            row.writebacks = stats.writebacks;
            row.clean_victims = stats.clean_victims;
            row.writes_through = stats.passed_writes;
            row.back_invalidations = stats.back_invalidations;
            row.prefetches = stats.prefetches;
            row.useful_prefetches = stats.useful_prefetches;
            row.bytes_in = stats.bytes_in;
            row.bytes_out = stats.bytes_out;
        });
    if (machine.dram)
        each_region("dram", [&](results::MachineRow& row, std::size_t region) {
            const DramStats& stats = counts.dram[region];
            row.bursts_read = stats.bursts_read;
            row.bursts_written = stats.bursts_written;
            row.row_hits = stats.row_hits;
            row.row_empty = stats.row_empty;
            row.row_conflicts = stats.row_conflicts;
            row.picojoules = cachesim::picojoules(*machine.dram, stats);
        });
    return rows;
}

std::vector<results::MachineRow> sweep_machines(std::span<const Machine> machines,
                                                const cachesim::AddressFiles& files,
                                                const SweepListeners& listeners) {
    cachesim::AddressTrace trace(files);
    std::vector<Hierarchy> hierarchies;
    for (const Machine& machine : machines) hierarchies.push_back(machine.hierarchy());
    for (auto records = trace.next(); !records.empty(); records = trace.next()) {
        tbb::parallel_for_each(
            hierarchies, [&](Hierarchy& hierarchy) { hierarchy.access(records, trace::Region::other); });
        tell(trace, "cachesim", listeners);
    }
    tell_notes(trace, listeners);
    std::vector<results::MachineRow> rows;
    for (std::size_t i = 0; i < machines.size(); ++i) {
        hierarchies[i].flush();
        for (results::MachineRow& row : machine_rows(machines[i], hierarchies[i].counts()))
            rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace regather::experiment
