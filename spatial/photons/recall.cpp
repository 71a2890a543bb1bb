#include "spatial/photons/recall.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "spatial/photons/nearest.h"

namespace regather::spatial {
namespace {

std::vector<std::uint32_t> numbers_of(const NearestSet& set) {
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < set.size(); ++i) numbers.push_back(set[i].node);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

}  // namespace

Recall recall_of(const BlockHashing& hashing, std::span<const Photon> heap, std::span<const Vec3> points,
                 std::uint32_t k, float radius) {
    constexpr std::size_t chunk_points = 4096;
    const PhotonKd tree(heap);
    std::vector<Recall> chunks((points.size() + chunk_points - 1) / chunk_points);
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        NearestSet truth(std::min(k, tree.size()), radius), found = truth;
        const std::size_t end = std::min(points.size(), (c + 1) * chunk_points);
        for (std::size_t i = c * chunk_points; i < end; ++i) {
            nearest(tree, points[i], truth);
            nearest(hashing, points[i], found);
            std::vector<std::uint32_t> both;
            const std::vector<std::uint32_t> a = numbers_of(truth), b = numbers_of(found);
            std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
            chunks[c] += {truth.size(), both.size()};
        }
    });
    Recall all;
    for (const Recall& chunk : chunks) all += chunk;
    return all;
}

std::string text_of(const std::optional<Recall>& recall) {
    if (!recall) return {};
    return fmt::format(", recall {:.4f} of {} nearest photons", recall->share(), recall->nearest);
}

void set_recall(trace::Json& counts, const std::optional<Recall>& recall) {
    trace::Json kept = trace::Json::object();
    if (const trace::Json::Object* const members = counts.members())
        for (const trace::Json::Member& member : *members)
            if (member.key != nearest_count && member.key != nearest_found_count)
                kept[member.key] = member.value;
    if (recall) {
        kept[nearest_count] = recall->nearest;
        kept[nearest_found_count] = recall->found;
    }
    counts = std::move(kept);
}

}  // namespace regather::spatial
