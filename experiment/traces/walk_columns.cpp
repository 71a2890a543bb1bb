#include "experiment/traces/walk_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>

namespace regather::experiment {

std::string write_walks(const spatial::StructureSpec& spec, const spatial::PhotonSearch& search,
                        std::span<const trace::Vec3> positions, float radius, bool candidates,
                        trace::TraceWriter& writer, trace::TraceInfo& info,
                        const ProgressListener& progress) {
    search.store(writer);
    info.structure = spec.text;
    info.structure_version = spec.entry->version;
    info.found_photons = info.visited_nodes = 0;
    std::uint64_t entered = 0;
    std::optional<spatial::Recall> recall;
    constexpr std::uint64_t batch = 1 << 20;
    for (std::uint64_t first = 0; first < positions.size() || first == 0; first += batch) {
        const auto points =
            positions.subspan(first, std::min<std::uint64_t>(batch, positions.size() - first));
        const spatial::Recording walks = search.record(points, info.k, radius, candidates);
        writer.column("query_walk_bytes").append(std::span<const std::uint32_t>(walks.walk_bytes));
        writer.column("walk").append(std::span<const std::uint8_t>(walks.walks));
        if (candidates) {
            writer.column("query_candidate_bytes")
                .append(std::span<const std::uint32_t>(walks.candidate_bytes));
            writer.column("candidate").append(std::span<const std::uint8_t>(walks.candidates));
            for (const std::uint8_t byte : walks.candidates)
                entered += static_cast<std::uint64_t>(std::popcount(byte));
        }
        info.found_photons += walks.found_photons;
        info.visited_nodes += walks.visited_nodes;
        if (const auto part = search.recall(points, info.k, radius))
            recall = recall.value_or(spatial::Recall()) += *part;
        if (progress) progress("recording walks", "queries", first + points.size(), positions.size());
    }
    spatial::set_recall(info.counts, recall);
    std::string figures = spatial::text_of(recall) + "\n";
    if (candidates)
        figures += fmt::format(
            "candidates: {:.1f} photons entered the list a query\n",
            static_cast<double>(entered) / std::max<double>(1, static_cast<double>(positions.size())));
    return figures;
}

}  // namespace regather::experiment
