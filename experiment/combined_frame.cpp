#include "experiment/combined_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <deque>
#include <map>
#include <optional>
#include <set>

#include "cachesim/cache_list.h"
#include "experiment/address_sweep.h"
#include "experiment/measurement.h"
#include "experiment/traces/one_capture.h"
#include "reorder/tiling.h"
#include "replay/frame.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::experiment {
namespace {

constexpr std::uint64_t alignment = 4096;

/// The edge of a unit's tiles; none: the whole image.
std::optional<std::uint32_t> edge_of(std::string_view unit) {
    if (unit == "pixel") return 1;
    if (unit == "frame") return {};
    constexpr std::string_view tile = "tile=";
    std::uint32_t edge = 0;
    const std::string_view digits = unit.starts_with(tile) ? unit.substr(tile.size()) : "";
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), edge);
    if (error != std::errc{} || end != digits.data() + digits.size() || edge < 1 || edge > reorder::max_tile)
        throw trace::UsageError(
            fmt::format("--unit: found {}, expected pixel, tile=N with N from 1 to {}, or frame",
                        trace::in_quotes(unit), reorder::max_tile));
    return edge;
}

/// The I-th of a list that has one for all or one for each.
const std::string& nth(const std::vector<std::string>& list, std::size_t i) {
    return list[list.size() == 1 ? 0 : i];
}

void check_length(std::string_view option, std::size_t found, std::size_t traces) {
    if (found > 1 && found != traces)
        throw trace::UsageError(fmt::format(
            "{}: found {} for {} traces, expected one for all or one for each", option, found, traces));
}

/// Columns that say what was walked.
bool of_the_structure(std::string_view column) {
    return column == "photon" || column.starts_with("tree_") || column.starts_with("element_");
}

struct Part {
    trace::TraceReader trace;
    std::string name;
    reorder::ParsedOrdering parsed;
    std::optional<Measurement> measurement;
    reorder::Ordered ordered;
    std::uint64_t base = 0;

    Part(const std::filesystem::path& folder, const std::string& ordering)
        : trace(folder), name(part_name(trace.info())), parsed(reorder::parse_ordering(ordering)) {}

    const trace::TraceInfo& info() const { return trace.info(); }
    bool shares_memory_with(const Part& other) const {
        const auto columns = [](const Part& part) {
            std::map<std::string, trace::ColumnDigest> held;
            for (const auto& [column, digest] : part.trace.digests())
                if (of_the_structure(column)) held.emplace(column, digest);
            return held;
        };
        return info().structure == other.info().structure &&
               info().structure_version == other.info().structure_version &&
               measurement->layout().name() == other.measurement->layout().name() &&
               columns(*this) == columns(other);
    }
};

std::deque<Part> opened(const CombinedFrame& frame) {
    check_length("--order", frame.orderings.size(), frame.traces.size());
    check_length("--layout", frame.layouts.size(), frame.traces.size());
    if (frame.traces.empty() || frame.orderings.empty())
        throw trace::UsageError(fmt::format("{}: found none, expected at least one",
                                            frame.traces.empty() ? "traces" : "--order"));
    std::deque<Part> parts;
    std::uint64_t end = 0;
    for (std::size_t i = 0; i < frame.traces.size(); ++i) {
        Part& part = parts.emplace_back(frame.traces[i], nth(frame.orderings, i));
        check_one_capture(parts.front().trace, part.trace, "the traces of a frame");
        for (std::size_t j = 0; j < i; ++j)
            if (parts[j].name == part.name)
                throw trace::UsageError(fmt::format("{}: found {} as in {}, expected each kind once",
                                                    frame.traces[i].string(), part.name,
                                                    frame.traces[j].string()));
        part.measurement.emplace(part.trace, part.parsed.ordering->reads(), frame.onchip_bytes);
        if (!frame.layouts.empty()) part.measurement->lay_out(nth(frame.layouts, i));
        part.ordered = part.measurement->order(*part.parsed.ordering);
        const auto shared = std::find_if(parts.begin(), parts.end() - 1,
                                         [&](const Part& other) { return other.shares_memory_with(part); });
        part.base = shared != parts.end() - 1 ? shared->base : end;
        end = std::max(
            end, (part.base + part.measurement->layout().end_byte() + alignment - 1) / alignment * alignment);
    }
    return parts;
}

replay::FramePart replayed(Part& part) {
    return {&part.measurement->walks(), &part.measurement->layout(), part.base, part.ordered.permutation,
            part.trace.column<std::uint32_t>("query_pixel")};
}

}  // namespace

cachesim::Machine machine_of(const cachesim::CacheConfig& cache) {
    cachesim::check(cache);
    cachesim::LevelConfig level;
    level.cache.geometry = cache;
    cachesim::Machine machine;
    machine.name = cachesim::cache_text(cache);
    machine.levels = {level};
    cachesim::check(std::span<const cachesim::LevelConfig>(machine.levels));
    return machine;
}

FrameResult run(const CombinedFrame& frame, const ProgressListener& progress) {
    std::set<std::string> seen;
    for (const std::string& unit : frame.units) {
        edge_of(unit);
        if (!seen.insert(unit).second)
            throw trace::UsageError(fmt::format("--unit: found {} twice, expected each unit once", unit));
    }
    std::deque<Part> parts = opened(frame);
    FrameResult result;
    const auto add = [&](const std::string& unit, std::string_view run, const cachesim::Machine& machine,
                         const Part& part, const cachesim::HierarchyCounts& counts) {
        for (results::MachineRow& of_machine : machine_rows(machine, counts)) {
            results::FrameRow& row = result.rows.emplace_back();
            static_cast<results::MachineRow&>(row) = std::move(of_machine);
            row.scene = part.info().scene;
            if (part.info().frame) row.frame = *part.info().frame;
            row.unit = unit;
            row.run = run;
            row.part = part.name;
            row.structure = part.measurement->structure_name();
            row.layout = part.measurement->layout().name();
            row.ordering = part.parsed.spec.name;
            row.parameters = part.parsed.spec.text;
            row.queries = part.measurement->queries();
        }
    };
    const auto systems = [&] {
        std::vector<cachesim::Hierarchy> all;
        for (const cachesim::Machine& machine : frame.machines) all.push_back(machine.hierarchy());
        return all;
    };
    std::uint64_t queries = 0;
    std::vector<replay::FramePart> all;
    for (Part& part : parts) {
        all.push_back(replayed(part));
        queries += part.measurement->queries();
    }
    for (const std::string& unit : frame.units) {
        const replay::FrameTurns turns{parts.front().info().image_width, parts.front().info().image_height,
                                       edge_of(unit)};
        std::vector<cachesim::Hierarchy> shared = systems();
        const auto together = replay::replay_frame(
            all, turns, shared, listening(progress, "replaying together, by " + unit, "queries", queries));
        std::vector<std::vector<std::vector<cachesim::HierarchyCounts>>> apart;  // by part
        for (std::size_t p = 0; p < parts.size(); ++p) {
            std::vector<cachesim::Hierarchy> own = systems();
            apart.push_back(
                replay::replay_frame(std::span(all).subspan(p, 1), turns, own,
                                     listening(progress, "replaying " + parts[p].name + " apart, by " + unit,
                                               "queries", parts[p].measurement->queries())));
        }
        for (std::size_t m = 0; m < frame.machines.size(); ++m) {
            for (std::size_t p = 0; p < parts.size(); ++p)
                add(unit, results::together, frame.machines[m], parts[p], together[m][p]);
            for (std::size_t p = 0; p < parts.size(); ++p)
                add(unit, results::apart, frame.machines[m], parts[p], apart[p][m][0]);
        }
    }
    std::vector<const trace::TraceReader*> traces;
    for (const Part& part : parts) traces.push_back(&part.trace);
    result.checksum = checksum_of(traces);
    result.parameters = parameters_of(traces, "frame");
    return result;
}

}  // namespace regather::experiment
