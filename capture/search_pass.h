// capture/search_pass.h -- a search of a left-balanced tree for each query, in any order and in parallel, and
// the walks that the searches took.
#pragma once
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "spatial/walk.h"

namespace regather::capture {

/// Row i belongs to query i, whatever the order of the searches.
struct Searched {
    std::vector<std::uint32_t> walk_bytes;  ///< Length of each walk.
    std::vector<std::uint8_t> walks;        ///< The walks in query order.
    std::uint64_t found_photons = 0, visited_nodes = 0;
};

/// `order[r]` is the query that runs r-th (in each thread's share), a permutation. `make()` gives what a
/// thread searches with; `search(query, searcher, listener)` runs one search, keeps its result, and returns
/// how many photons were found.
template <class Make, class Search>
void search_all(std::span<const std::uint32_t> order, const Make& make, const Search& search,
                Searched& searched) {
    constexpr std::size_t chunk_queries = 2048;
    struct Chunk {
        std::vector<std::uint8_t> walks;
        std::uint64_t found = 0, visited = 0;
    };
    struct Thread {
        decltype(make()) searcher;
        spatial::WalkRecorder recorder;
    };
    const std::size_t n = order.size();
    searched.walk_bytes.assign(n, 0);
    std::vector<Chunk> chunks((n + chunk_queries - 1) / chunk_queries);
    tbb::enumerable_thread_specific<Thread> threads([&] { return Thread{make(), {}}; });
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        Thread& thread = threads.local();
        thread.recorder.clear();
        const std::size_t end = std::min(n, (c + 1) * chunk_queries);
        for (std::size_t r = c * chunk_queries; r < end; ++r) {
            const std::uint32_t q = order[r];
            chunks[c].found += search(q, thread.searcher, thread.recorder);
            searched.walk_bytes[q] = thread.recorder.finish();
        }
        const std::span<const std::uint8_t> walks = thread.recorder.bytes();
        chunks[c].walks.assign(walks.begin(), walks.end());
        chunks[c].visited = thread.recorder.visited_nodes();
    });

    std::vector<std::uint64_t> place(n);
    std::uint64_t bytes = 0;
    for (std::size_t q = 0; q < n; ++q) {
        place[q] = bytes;
        bytes += searched.walk_bytes[q];
    }
    searched.walks.resize(bytes);
    searched.found_photons = searched.visited_nodes = 0;
    for (const Chunk& chunk : chunks) {
        searched.found_photons += chunk.found;
        searched.visited_nodes += chunk.visited;
    }
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        const std::uint8_t* from = chunks[c].walks.data();
        const std::size_t end = std::min(n, (c + 1) * chunk_queries);
        for (std::size_t r = c * chunk_queries; r < end; ++r) {
            const std::uint32_t q = order[r];
            if (searched.walk_bytes[q] == 0) continue;
            std::memcpy(searched.walks.data() + place[q], from, searched.walk_bytes[q]);
            from += searched.walk_bytes[q];
        }
    });
}

}  // namespace regather::capture
