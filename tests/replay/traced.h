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
#include "spatial/nearest.h"
#include "spatial/recording.h"
#include "tests/spatial/photons.h"

namespace regather::replay {

struct Searched {
    std::vector<trace::Photon> heap;
    std::vector<trace::Vec3> points;
    std::uint32_t k;
    spatial::Recording recording;

    Searched(std::size_t photons, std::size_t queries, std::uint32_t nearest)
        : heap(spatial::left_balanced(spatial::uniform_photons(photons))), k(nearest) {
        spatial::Numbers numbers(11);
        const auto coordinate = [&] { return numbers.uniform(); };
        for (std::size_t q = 0; q < queries; ++q)
            points.push_back({coordinate(), coordinate(), coordinate()});
        recording = spatial::record_walks(spatial::PhotonKd(heap), points, k, 1e9f);
    }
    WalkStore walks() const {
        return {static_cast<std::uint32_t>(heap.size()), recording.walk_bytes, recording.walks};
    }
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
                                        const HeapLayout& layout = {}) const {
        std::vector<std::uint64_t> lines;
        for (const std::uint64_t node : nodes_of(query)) {
            const std::uint64_t begin = layout.base + node * layout.stride_bytes,
                                end = begin + layout.used_bytes;
            for (std::uint64_t line = begin / line_bytes; line * line_bytes < end; ++line)
                lines.push_back(line);
        }
        return lines;
    }
    std::vector<std::uint64_t> lines_of(std::span<const std::uint32_t> order, std::uint64_t line_bytes,
                                        const HeapLayout& layout = {}) const {
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
