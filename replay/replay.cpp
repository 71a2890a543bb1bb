#include "replay/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <string_view>

#include "cachesim/distinct.h"
#include "cachesim/lines.h"
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
/// nobody asks for classes, which take less time than the pass for all. (Below 16 sets one cache is slow; see
/// set_engine.cpp.)
bool alone(const CacheConfig& cache, const ReplayConfig& config) {
    if (!family_serves(cache)) return true;
    if (config.classes) return false;
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

    void visit(std::span<const std::uint32_t> elements) {
        const std::span<const cachesim::Line> touches = lines_.touches(elements);
        accesses_ += touches.size();
        for (cachesim::LruCache& cache : alone_) cache.access(touches, trace::Region::photons);
        if (!family_) return;
        const WalkLines::First first = lines_.first(touches);
        family_->access_first(first.lines, first.last_rank);
    }

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

Replayed replay(const WalkStore& walks, const Layout& layout, std::span<const std::uint32_t> permutation,
                const ReplayConfig& config, const Revisits& revisits, const QueriesDone& progress) {
    assert(permutation.size() == walks.queries());
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
    result.visited_nodes =
        run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> elements) {
            result.raw_bytes += layout.bytes(elements);
            for (LineSize& size : sizes) size.visit(elements);
        });
    for (const CacheConfig& cache : config.caches)
        result.caches.push_back(size_of(cache.line_bytes).traffic(cache, config, revisits));
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
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
