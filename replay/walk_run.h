// replay/walk_run.h -- goes through walks in an order: decodes each, with what comes next on its way into the
// cache.
#pragma once
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <concepts>
#include <cstdint>
#include <span>

#include "replay/replay.h"
#include "replay/walk_store.h"
#include "spatial/structure.h"

namespace regather::replay {

/// Throws trace::DataError that names the file and the query whose walk does not fit its structure.
[[noreturn]] void refuse_walk(const WalkStore& walks, std::uint64_t query, spatial::WalkFault fault);

/// Holds no walk: every one is decoded.
struct NoneHeld {
    bool holds(std::uint64_t) const { return false; }
    void prefetch_place(std::uint64_t) const {}
    void prefetch(std::uint64_t) const {}
};

/// Calls use_held(query) for each query of `permutation` that `held` holds (FirstTouches, NoneHeld), and
/// visit(elements) for the walk of every other one. Returns the number of elements visited in the latter.
template <class Held, class UseHeld, class Visit>
std::uint64_t run_order(const WalkStore& walks, std::span<const std::uint32_t> permutation,
                        const QueriesDone& progress, const Held& held, UseHeld&& use_held, Visit&& visit) {
    constexpr std::uint64_t prefetch_table = 32, prefetch_walk = 12, progress_queries = 1 << 16;
    const std::unique_ptr<spatial::WalkDecoder> decoder = walks.structure().decoder();
    std::uint64_t visited = 0;
    for (std::uint64_t r = 0; r < permutation.size(); ++r) {
        if (r + prefetch_table < permutation.size()) {
            held.prefetch_place(permutation[r + prefetch_table]);
            walks.prefetch(permutation[r + prefetch_table]);
        }
        if (r + prefetch_walk < permutation.size()) {
            const std::uint32_t query = permutation[r + prefetch_walk];
            if (held.holds(query)) {
                held.prefetch(query);
            } else {
                const std::span<const std::uint8_t> ahead = walks.walk(query);
                __builtin_prefetch(ahead.data());
                __builtin_prefetch(ahead.data() + ahead.size());
            }
        }
        const std::uint32_t query = permutation[r];
        if (held.holds(query)) {
            use_held(query);
        } else {
            const auto [fault, elements] = decoder->decode(walks.walk(query));
            if (fault != spatial::WalkFault::none) refuse_walk(walks, query, fault);
            visited += elements.size();
            visit(elements);
        }
        if (progress && (r + 1) % progress_queries == 0) progress(r + 1);
    }
    if (progress) progress(permutation.size());
    return visited;
}

/// Calls visit(elements) for the walk of each query of `permutation`. Returns the number of visited elements.
template <class Visit>
std::uint64_t run_walks(const WalkStore& walks, std::span<const std::uint32_t> permutation,
                        const QueriesDone& progress, Visit&& visit) {
    return run_order(
        walks, permutation, progress, NoneHeld{}, [](std::uint32_t) {}, visit);
}

/// Calls visit(part, elements) or visit(part, query, elements) for the walk of every query, on all cores in
/// any order: each thread has a Part of its own.
template <class Part, class Visit>
void run_all_walks(const WalkStore& walks, tbb::enumerable_thread_specific<Part>& parts,
                   const QueriesDone& progress, Visit&& visit) {
    tbb::enumerable_thread_specific<std::unique_ptr<spatial::WalkDecoder>> decoders(
        [&] { return walks.structure().decoder(); });
    std::atomic<std::uint64_t> done = 0;
    tbb::parallel_for(tbb::blocked_range<std::uint64_t>(0, walks.queries(), 4096), [&](const auto& range) {
        spatial::WalkDecoder* const decoder = decoders.local().get();
        Part& part = parts.local();
        for (std::uint64_t q = range.begin(); q != range.end(); ++q) {
            const auto [fault, elements] = decoder->decode(walks.walk(q));
            if (fault != spatial::WalkFault::none) refuse_walk(walks, q, fault);
            if constexpr (std::invocable<Visit&, Part&, std::uint64_t, std::span<const std::uint32_t>>)
                visit(part, q, elements);
            else
                visit(part, elements);
        }
        done += range.size();
        if (progress) progress(done);
    });
}

}  // namespace regather::replay
