// tests/replay/traced.h -- a small scene's searches, recorded; and what they touch, found by searching again.
#pragma once
#include <algorithm>
#include <cstdint>
#include <list>
#include <numeric>
#include <span>
#include <vector>

#include "replay/layout.h"
#include "replay/walk_store.h"
#include "spatial/photons/left_balanced.h"
#include "spatial/photons/nearest.h"
#include "spatial/photons/recording.h"
#include "tests/spatial/photons.h"

namespace regather::replay {

/// Photons in heap order, `stride_bytes` apart; or scattered, each of another length, every seventh of none.
struct Placed {
    std::string_view name = "heap-20";
    std::uint64_t base = 0;
    std::uint32_t stride_bytes = 20, used_bytes = 20;
    bool scattered = false;

    /// `node` counts from 0 and lies below 2003.
    Extent at(std::uint64_t node) const {
        if (scattered)
            return {base + node * 7919 % 2003 * 64 + node % 5, static_cast<std::uint32_t>(node % 7 * 9)};
        return {base + node * stride_bytes, used_bytes};
    }
    Layout on(const spatial::Structure& structure) const {
        if (!scattered) return {std::string(name), structure, base, stride_bytes, used_bytes};
        std::vector<Extent> extents(structure.end());
        for (std::size_t slot = 1; slot < extents.size(); ++slot) extents[slot] = at(slot - 1);
        return {std::string(name), structure, std::move(extents)};
    }
};

struct Searched {
    std::vector<trace::Photon> heap;
    std::vector<trace::Vec3> points;
    std::uint32_t k;
    std::shared_ptr<const spatial::Structure> tree;
    spatial::Recording recording;

    Searched(std::size_t photons, std::size_t queries, std::uint32_t nearest)
        : heap(spatial::left_balanced(spatial::uniform_photons(photons))),
          k(nearest),
          tree(std::make_shared<spatial::LeftBalanced>(static_cast<std::uint32_t>(photons))) {
        spatial::Numbers numbers(11);
        const auto coordinate = [&] { return numbers.uniform(); };
        for (std::size_t q = 0; q < queries; ++q)
            points.push_back({coordinate(), coordinate(), coordinate()});
        recording = spatial::record_walks(spatial::PhotonKd(heap), points, k, 1e9f);
    }
    WalkStore walks() const { return {tree, recording.walk_bytes, recording.walks}; }
    Layout layout(const Placed& placed = {}) const { return placed.on(*tree); }
    /// The nodes that one search visits, from 0.
    std::vector<std::uint32_t> nodes_of(std::uint32_t query) const {
        struct Visits {
            std::vector<std::uint32_t> nodes;
            void visit(std::uint32_t node) { nodes.push_back(node); }
            void near(bool) {}
            void far(bool) {}
        } visits;
        spatial::NearestSet found(k);
        spatial::nearest(spatial::PhotonKd(heap), points[query], found, visits);
        return visits.nodes;
    }
    /// The lines that one search touches, one by one.
    std::vector<std::uint64_t> lines_of(std::uint32_t query, std::uint64_t line_bytes,
                                        const Placed& layout = {}) const {
        std::vector<std::uint64_t> lines;
        for (const std::uint64_t node : nodes_of(query)) {
            const auto [begin, bytes] = layout.at(node);
            if (bytes == 0) continue;
            for (std::uint64_t line = begin / line_bytes; line * line_bytes < begin + bytes; ++line)
                lines.push_back(line);
        }
        return lines;
    }
    std::vector<std::uint64_t> lines_of(std::span<const std::uint32_t> order, std::uint64_t line_bytes,
                                        const Placed& layout = {}) const {
        std::vector<std::uint64_t> all;
        for (const std::uint32_t query : order) {
            const std::vector<std::uint64_t> lines = lines_of(query, line_bytes, layout);
            all.insert(all.end(), lines.begin(), lines.end());
        }
        return all;
    }
};

/// LRU by its definition: lists of lines, the last used first. True: missed.
class ListedLru {
public:
    ListedLru(std::uint64_t sets, std::size_t ways) : ways_(ways), sets_(sets) {}
    bool misses(std::uint64_t line) {
        std::list<std::uint64_t>& set = sets_[line % sets_.size()];
        const auto found = std::find(set.begin(), set.end(), line);
        const bool missed = found == set.end();
        if (!missed)
            set.splice(set.begin(), set, found);
        else
            set.push_front(line);
        if (set.size() > ways_) set.pop_back();
        return missed;
    }

private:
    std::size_t ways_;
    std::vector<std::list<std::uint64_t>> sets_;
};

inline std::vector<std::uint32_t> shuffled_queries(std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    spatial::Numbers numbers(seed);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[static_cast<std::size_t>(numbers.uniform() * static_cast<float>(i))]);
    return order;
}

}  // namespace regather::replay
