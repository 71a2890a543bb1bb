#include "replay/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <string_view>

#include "cachesim/distinct.h"
#include "cachesim/lines.h"
#include "replay/first_touches.h"
#include "replay/walk_lines.h"
#include "replay/walk_run.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using cachesim::CacheConfig;
using cachesim::FamilyConfig;
using cachesim::FamilyCounts;

constexpr std::uint32_t max_family_ways = 32;
constexpr std::uint64_t max_family_sets = std::uint64_t{1} << 24;

/// Simulated for itself: what no family serves, and one or two set-associative caches of a line size when
/// nobody asks for classes or for families, which take less time than the pass for all. (Below 16 sets one
/// cache is slow; see set_engine.cpp.)
bool alone(const CacheConfig& cache, const ReplayConfig& config) {
    if (!family_serves(cache)) return true;
    if (config.classes || config.together) return false;
    std::size_t beside = 0;
    for (const CacheConfig& other : config.caches) {
        if (other.line_bytes != cache.line_bytes || !family_serves(other)) continue;
        if (other.ways == cachesim::fully_associative || other.sets() < 16) return false;
        ++beside;
    }
    return beside <= 2;
}

/// The families that serve a configuration's caches, by line size.
std::map<std::uint32_t, FamilyConfig> families(const ReplayConfig& config) {
    std::map<std::uint32_t, FamilyConfig> by_line;
    for (const CacheConfig& cache : config.caches) {
        cachesim::check(cache);
        if (alone(cache, config)) continue;
        FamilyConfig& family = by_line
                                   .try_emplace(cache.line_bytes, FamilyConfig{.levels = {},
                                                                               .distances = config.classes,
                                                                               .conflicts = config.classes})
                                   .first->second;
        if (cache.ways == cachesim::fully_associative) {
            family.distances = true;
            continue;
        }
        const auto level = std::lower_bound(family.levels.begin(), family.levels.end(), cache.sets(),
                                            [](const auto& l, std::uint64_t sets) { return l.sets < sets; });
        if (level == family.levels.end() || level->sets != cache.sets())
            family.levels.insert(level, {cache.sets(), cache.ways});
        else
            level->ways = std::max(level->ways, cache.ways);
    }
    return by_line;
}

/// The caches of one line size on their way through a replay.
class LineSize {
public:
    LineSize(const Layout& layout, std::uint32_t line_bytes) : lines_(layout, line_bytes) {}

    std::uint32_t line_bytes() const { return lines_.line_bytes(); }
    void add_family(const FamilyConfig& config) { family_.emplace(config); }
    void add_cache(const CacheConfig& config) { alone_.emplace_back(config); }
    bool needs_all_touches() const { return !alone_.empty(); }

    void visit(std::span<const std::uint32_t> elements) {
        const std::span<const cachesim::Line> touches = lines_.touches(elements);
        accesses_ += touches.size();
        for (cachesim::LruCache& cache : alone_) cache.access(touches, trace::Region::photons);
        if (family_) visit_first(lines_.first(touches));
    }
    /// In place of visit() where no cache needs all touches, but for the accesses.
    void visit_first(const WalkLines::First& first) { family_->access_first(first.lines, first.last_rank); }
    void set_accesses(std::uint64_t accesses) { accesses_ = accesses; }

    CacheTraffic traffic(const CacheConfig& config, const ReplayConfig& all, const Revisits& revisits) {
        const bool classes = all.classes;
        CacheTraffic found{.config = config,
                           .accesses = accesses_,
                           .misses = 0,
                           .traffic_bytes = 0,
                           .classes = {},
                           .error = {}};
        if (!alone(config, all)) {
            const FamilyCounts &first = family_->counts(), &again = revisits.at(config.line_bytes);
            const std::uint64_t sets = config.sets();
            const bool full = config.ways == cachesim::fully_associative;
            const std::uint64_t lines = config.size_bytes / config.line_bytes;
            found.misses = full ? first.full_misses(lines) + again.full_misses(lines)
                                : first.misses(sets, config.ways) + again.misses(sets, config.ways);
            if (classes) {
                const std::uint64_t conflict =
                    full ? 0 : first.conflicts(sets, config.ways) + again.conflicts(sets, config.ways);
                found.classes = {first.compulsory, found.misses - first.compulsory - conflict, conflict};
            }
        } else {
            const auto cache =
                std::find_if(alone_.begin(), alone_.end(), [&](const cachesim::LruCache& candidate) {
                    return candidate.config().size_bytes == config.size_bytes &&
                           candidate.config().ways == config.ways;
                });
            found.misses = cache->total().misses;
        }
        found.traffic_bytes = found.misses * config.line_bytes;
        return found;
    }

private:
    WalkLines lines_;
    std::uint64_t accesses_ = 0;
    std::optional<cachesim::LruFamily> family_;
    std::vector<cachesim::LruCache> alone_;
};

}  // namespace

void refuse_walk(const WalkStore& walks, std::uint64_t query, spatial::WalkFault fault) {
    constexpr std::array<std::string_view, 4> found{"", "a walk that ends early",
                                                    "bytes after the walk's end",
                                                    "a walk that enters a node that does not exist"};
    throw trace::DataError(fmt::format("{}: query {}: found {}, expected the walk of a search in this tree",
                                       walks.file(), query, found[static_cast<std::size_t>(fault)]));
}

bool family_serves(const CacheConfig& config) {
    return config.ways == cachesim::fully_associative ||
           (config.ways <= max_family_ways && config.sets() <= max_family_sets);
}

Revisits count_revisits(const WalkStore& walks, const Layout& layout, const ReplayConfig& config,
                        const QueriesDone& progress) {
    const std::map<std::uint32_t, FamilyConfig> by_line = families(config);
    struct Part {
        std::vector<WalkLines> lines;
        std::vector<cachesim::LruFamily> families;
    };
    tbb::enumerable_thread_specific<Part> parts([&] {
        Part part;
        for (const auto& [line_bytes, family] : by_line) {
            part.lines.emplace_back(layout, line_bytes);
            part.families.emplace_back(family);
        }
        return part;
    });
    if (by_line.empty()) return {};
    run_all_walks(walks, parts, progress, [](Part& part, std::span<const std::uint32_t> elements) {
        for (std::size_t f = 0; f < part.families.size(); ++f)
            part.families[f].revisit(part.lines[f].touches(elements));
    });
    Revisits sum;
    std::size_t f = 0;
    for (const auto& [line_bytes, family] : by_line) {
        FamilyCounts& counts = sum[line_bytes];
        counts = cachesim::LruFamily(family).counts();
        for (Part& part : parts) counts += part.families[f].counts();
        ++f;
    }
    return sum;
}

bool serve(const Revisits& revisits, const ReplayConfig& config) {
    for (const auto& [line_bytes, family] : families(config)) {
        const auto counts = revisits.find(line_bytes);
        if (counts == revisits.end()) return false;
        for (const cachesim::FamilyLevel& level : family.levels)
            if (std::none_of(counts->second.levels.begin(), counts->second.levels.end(),
                             [&](const FamilyCounts::Level& held) {
                                 return held.level.sets == level.sets && held.misses.size() >= level.ways &&
                                        held.conflicts.size() >= (config.classes ? level.ways : 0);
                             }))
                return false;
    }
    return true;
}

namespace {

/// A replay from its caches to their traffic; `run` puts the walks through them, one after the other.
template <class Run>
Replayed replayed(const Layout& layout, const ReplayConfig& config, const Revisits& revisits, Run&& run) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<LineSize> sizes;
    const auto size_of = [&](std::uint32_t line_bytes) -> LineSize& {
        for (LineSize& size : sizes)
            if (size.line_bytes() == line_bytes) return size;
        return sizes.emplace_back(layout, line_bytes);
    };
    for (const auto& [line_bytes, family] : families(config)) size_of(line_bytes).add_family(family);
    for (const CacheConfig& cache : config.caches)
        if (alone(cache, config)) size_of(cache.line_bytes).add_cache(cache);

    Replayed result;
    run(std::span(sizes), result);
    for (const CacheConfig& cache : config.caches)
        result.caches.push_back(size_of(cache.line_bytes).traffic(cache, config, revisits));
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

/// Which line size of the held ones each is, as far as all can do with first touches that are held.
std::optional<std::vector<std::size_t>> held_sizes(std::span<const LineSize> sizes,
                                                   const FirstTouches& held) {
    std::vector<std::size_t> found;
    for (const LineSize& size : sizes) {
        const auto at = std::find(held.line_sizes().begin(), held.line_sizes().end(), size.line_bytes());
        if (size.needs_all_touches() || at == held.line_sizes().end()) return std::nullopt;
        found.push_back(static_cast<std::size_t>(at - held.line_sizes().begin()));
    }
    return found;
}

}  // namespace

Replayed replay(const WalkStore& walks, const Layout& layout, std::span<const std::uint32_t> permutation,
                const ReplayConfig& config, const Revisits& revisits, const QueriesDone& progress) {
    assert(permutation.size() == walks.queries());
    return replayed(layout, config, revisits, [&](std::span<LineSize> sizes, Replayed& result) {
        result.visited_nodes =
            run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> elements) {
                result.raw_bytes += layout.bytes(elements);
                for (LineSize& size : sizes) size.visit(elements);
            });
    });
}

Replayed replay(const WalkStore& walks, const Layout& layout, std::span<const std::uint32_t> permutation,
                const ReplayConfig& config, const Revisits& revisits, const FirstTouches& held,
                const QueriesDone& progress) {
    assert(permutation.size() == walks.queries());
    bool serves = true;
    Replayed result = replayed(layout, config, revisits, [&](std::span<LineSize> sizes, Replayed& found) {
        const std::optional<std::vector<std::size_t>> held_size = held_sizes(sizes, held);
        serves = held_size.has_value();
        if (!serves) return;
        std::vector<LineSize*> size_at(held.line_sizes().size());  // by the held ones
        for (std::size_t s = 0; s < sizes.size(); ++s) size_at[(*held_size)[s]] = &sizes[s];
        FirstTouches::Reader reader(held);
        run_order(
            walks, permutation, progress, held,
            [&](std::uint32_t query) {
                reader.read(query, [&](std::size_t s, const WalkLines::First& first) {
                    if (size_at[s]) size_at[s]->visit_first(first);
                });
            },
            [&](std::span<const std::uint32_t> elements) {
                for (LineSize& size : sizes) size.visit(elements);
            });
        for (std::size_t s = 0; s < sizes.size(); ++s)
            sizes[s].set_accesses(held.totals().accesses[(*held_size)[s]]);
        found.visited_nodes = held.totals().visited_nodes;
        found.raw_bytes = held.totals().raw_bytes;
    });
    return serves ? result : replay(walks, layout, permutation, config, revisits, progress);
}

std::vector<bool> touched_elements(const WalkStore& walks) {
    const std::size_t elements = walks.structure().end();
    tbb::enumerable_thread_specific<std::vector<bool>> parts([&] { return std::vector<bool>(elements); });
    run_all_walks(walks, parts, {}, [](std::vector<bool>& touched, std::span<const std::uint32_t> visited) {
        for (const std::uint32_t element : visited) touched[element] = true;
    });
    std::vector<bool> touched(elements);
    for (const std::vector<bool>& part : parts)
        for (std::size_t e = 0; e < elements; ++e)
            if (part[e]) touched[e] = true;
    return touched;
}

std::uint64_t compulsory_bytes(const std::vector<bool>& touched, const Layout& layout,
                               std::uint32_t line_bytes) {
    cachesim::DistinctLines distinct;
    std::vector<cachesim::Line> lines;
    for (std::uint32_t element = 0; element < touched.size(); ++element) {
        if (!touched[element]) continue;
        const Extent extent = layout.extent(element);
        lines.clear();
        cachesim::append_lines(lines, extent.address, extent.bytes, line_bytes);
        distinct.add(lines);
    }
    return distinct.count() * line_bytes;
}

}  // namespace regather::replay
