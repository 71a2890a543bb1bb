#include "replay/set_sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <numeric>

#include "replay/student.h"
#include "replay/walk_lines.h"
#include "replay/walk_run.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using cachesim::CacheConfig;
using cachesim::Line;

constexpr std::uint64_t most_classes_sampled = 64;
constexpr double hot_share = 0.1;  // of the walks

/// A 64-bit finalizer: Steele, Lea & Flood, "Fast Splittable Pseudorandom Number Generators", 2014.
std::uint64_t mixed(std::uint64_t value) {
    value = (value ^ value >> 30) * 0xBF58476D1CE4E5B9u;
    value = (value ^ value >> 27) * 0x94D049BB133111EBu;
    return value ^ value >> 31;
}

/// `count` of the numbers below `below`, without repetition.
std::vector<std::uint64_t> chosen(std::uint64_t count, std::uint64_t below, std::uint64_t seed) {
    std::vector<std::uint64_t> numbers(below);
    std::iota(numbers.begin(), numbers.end(), 0u);
    const auto draw = [&](std::uint64_t number) { return std::pair(mixed(mixed(seed) + number), number); };
    std::sort(numbers.begin(), numbers.end(),
              [&](std::uint64_t a, std::uint64_t b) { return draw(a) < draw(b); });
    numbers.resize(count);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

}  // namespace

LineUse count_line_use(const WalkStore& walks, const Layout& layout, std::span<const CacheConfig> caches,
                       const QueriesDone& progress) {
    struct Size {
        WalkLines lines;
        std::uint64_t first_line;
        std::vector<std::uint64_t> walks;
    };
    using Part = std::vector<Size>;
    LineUse use;
    for (const CacheConfig& cache : caches) {
        const std::uint64_t end = (layout.end_byte() + cache.line_bytes - 1) / cache.line_bytes;
        use[cache.line_bytes].resize(end - layout.first_byte() / cache.line_bytes);
    }
    tbb::enumerable_thread_specific<Part> parts([&] {
        Part part;
        for (const auto& [line_bytes, counts] : use)
            part.push_back({WalkLines(layout, line_bytes), layout.first_byte() / line_bytes,
                            std::vector<std::uint64_t>(counts.size())});
        return part;
    });
    run_all_walks(walks, parts, progress, [](Part& part, std::span<const std::uint32_t> elements) {
        for (Size& size : part)
            for (const Line line : size.lines.first(size.lines.touches(elements)).lines)
                ++size.walks[static_cast<std::uint64_t>(line) - size.first_line];
    });
    for (const Part& part : parts)
        for (const Size& size : part) {
            std::vector<std::uint64_t>& sum = use[size.lines.line_bytes()];
            for (std::size_t l = 0; l < sum.size(); ++l) sum[l] += size.walks[l];
        }
    return use;
}

void SetSample::check(std::span<const CacheConfig> caches, const Sampling& sampling) {
    const std::uint64_t one_of = sampling.one_of;
    if (!std::has_single_bit(one_of) || one_of < 2 || one_of > 1024)
        throw trace::UsageError(
            fmt::format("sampling: found 1/{}, expected 1/2, 1/4, ... or 1/1024", one_of));
    for (const CacheConfig& cache : caches) {
        cachesim::check(cache);
        const bool full = cache.ways == cachesim::fully_associative;
        if (!family_serves(cache) || full || cache.sets() < 2 * one_of)
            throw trace::UsageError(
                fmt::format("sampling: found 1/{} of the sets of a cache of {} bytes in lines of {} with {} "
                            "ways, expected at least {} "
                            "sets of 1 to 32 ways",
                            one_of, cache.size_bytes, cache.line_bytes,
                            full ? "all" : std::to_string(cache.ways), 2 * one_of));
    }
}

SetSample::SetSample(const WalkStore& walks, const Layout& layout, std::span<const CacheConfig> caches,
                     const Sampling& sampling, const LineUse& use)
    : walks_(walks), layout_(layout), caches_(caches.begin(), caches.end()) {
    check(caches, sampling);
    const std::uint64_t one_of = sampling.one_of;
    for (const CacheConfig& cache : caches) {
        auto size = std::find_if(sizes_.begin(), sizes_.end(),
                                 [&](const LineSize& s) { return s.line_bytes == cache.line_bytes; });
        if (size == sizes_.end()) {
            size = sizes_.insert(size, LineSize{});
            size->line_bytes = cache.line_bytes;
            size->classes = most_classes_sampled * one_of;
        }
        size->classes = std::min(size->classes, cache.sets());
    }
    for (LineSize& size : sizes_) {
        size.family = {
            .levels = {}, .distances = false, .conflicts = false, .stamps = std::uint64_t{1} << 18};
        for (const CacheConfig& cache : caches_) {
            if (cache.line_bytes != size.line_bytes) continue;
            const std::uint64_t sets = cache.sets() / size.classes;
            const auto level = std::lower_bound(size.family.levels.begin(), size.family.levels.end(), sets,
                                                [](const auto& l, std::uint64_t s) { return l.sets < s; });
            if (level == size.family.levels.end() || level->sets != sets)
                size.family.levels.insert(level, {sets, cache.ways});
            else
                level->ways = std::max(level->ways, cache.ways);
        }
        size.sampled.assign(size.classes, unsampled);
        const std::vector<std::uint64_t> numbers = chosen(size.classes / one_of, size.classes, sampling.seed);
        for (std::size_t n = 0; n < numbers.size(); ++n)
            size.sampled[numbers[n]] = static_cast<std::uint16_t>(n);
        size.touches.resize(numbers.size());
        const std::vector<std::uint64_t>& by_line = use.at(size.line_bytes);
        const std::uint64_t first_line = layout.first_byte() >> std::countr_zero(size.line_bytes);
        const double hot = hot_share * static_cast<double>(walks.queries());
        for (std::size_t l = 0; l < by_line.size(); ++l) {
            const auto touching = static_cast<double>(by_line[l]);
            if (touching > hot) continue;
            size.all_touches += touching;
            const std::uint16_t number = size.sampled[(first_line + l) % size.classes];
            if (number != unsampled) size.touches[number] += touching;
        }
        if (size.all_touches > 0 && std::accumulate(size.touches.begin(), size.touches.end(), 0.0) == 0)
            throw trace::DataError(fmt::format(
                "sampling: found no touched line of {} bytes in 1/{} of the sets by seed {}, expected some: "
                "the "
                "addresses are on few sets, which another seed, more sets or all of them would tell",
                size.line_bytes, one_of, sampling.seed));
    }
}

/// One replay's simulation of the sampled classes of a line size.
struct SetSample::Run {
    Run(const LineSize& s, const Layout& l)
        : size(s),
          layout(l),
          lines(l, s.line_bytes),
          shift(std::countr_zero(s.classes)),
          last(s.touches.size(), ~std::uint64_t{0}),
          waiting(s.touches.size()) {
        for (std::size_t n = 0; n < s.touches.size(); ++n) classes.emplace_back(s.family);
        for (const std::uint16_t number : s.sampled) is_sampled.push_back(number != unsampled ? 1 : 0);
    }

    void visit(std::span<const std::uint32_t> elements) {
        const std::size_t count = find(elements);
        const std::uint16_t* const sampled = size.sampled.data();
        const std::uint64_t mask = size.classes - 1;
        for (std::size_t i = 0; i < count; ++i) {
            const auto line = static_cast<std::uint64_t>(found[i]);
            const std::uint16_t n = sampled[line & mask];
            if (last[n] == line)
                continue;  // the newest line of its class hits in every cache and changes nothing
            last[n] = line;
            waiting[n].push_back(Line{line >> shift});
            if (waiting[n].size() == batch) pass(n);
        }
    }
    /// Puts the touches of sampled lines into `found`; returns their number. Without a branch: few are
    /// sampled, and nobody could foretell which.
    std::size_t find(std::span<const std::uint32_t> elements) {
        const std::uint8_t* const wanted = is_sampled.data();
        const std::uint64_t mask = size.classes - 1;
        std::size_t count = 0;
        if (layout.widest() > size.line_bytes) {  // an element may lie on more than two lines
            const std::span<const Line> touches = lines.touches(elements);
            accesses += touches.size();
            if (found.size() < touches.size()) found.resize(2 * touches.size());
            for (const Line line : touches) {
                found[count] = line;
                count += wanted[static_cast<std::uint64_t>(line) & mask];
            }
            return count;
        }
        if (found.size() <= 2 * elements.size()) found.resize(4 * elements.size() + 1);
        Line* const to = found.data();
        const int line_shift = std::countr_zero(size.line_bytes);
        std::uint64_t touched = 0;
        layout.for_each(elements, [&](std::uint32_t, std::uint64_t address, std::uint32_t bytes) {
            const std::uint64_t first = address >> line_shift, second = (address + bytes - 1) >> line_shift;
            const std::uint64_t two = second - first;
            touched += 1 + two;
            to[count] = Line{first};
            count += wanted[first & mask];
            to[count] = Line{second};
            count += wanted[second & mask] & two;
        });
        accesses += touched;
        return count;
    }
    void pass(std::size_t n) {
        classes[n].access(waiting[n]);
        waiting[n].clear();
    }

    CacheTraffic traffic(const CacheConfig& config) {
        const std::size_t units = classes.size();
        const auto n = static_cast<double>(units), all = static_cast<double>(size.classes);
        std::vector<double> misses(units);
        for (std::size_t u = 0; u < units; ++u) {
            pass(u);
            misses[u] =
                static_cast<double>(classes[u].counts().misses(config.sets() / size.classes, config.ways));
        }
        const double missed = std::accumulate(misses.begin(), misses.end(), 0.0);
        const double touched = std::accumulate(size.touches.begin(), size.touches.end(), 0.0);
        // Without a touched line in the sample there is nothing to take a ratio to: every class counts the
        // same.
        const double ratio = touched > 0 ? missed / touched : 0, mean = missed / n;
        const double total = touched > 0 ? ratio * size.all_touches : mean * all;
        double squares = 0;
        for (std::size_t u = 0; u < units; ++u)
            squares += std::pow(misses[u] - (touched > 0 ? ratio * size.touches[u] : mean), 2);
        const double error = all * std::sqrt((1 - n / all) / n * squares / (n - 1));
        const double reach = student_quantile_95(units - 1) * error;
        CacheTraffic result{.config = config,
                            .accesses = accesses,
                            .misses = static_cast<std::uint64_t>(std::llround(total)),
                            .traffic_bytes = 0,
                            .classes = {},
                            .error = SampleError{}};
        result.traffic_bytes = result.misses * config.line_bytes;
        result.error->sampled_sets = config.sets() / size.classes * units;
        result.error->standard_error = error;
        result.error->low = static_cast<std::uint64_t>(std::llround(std::max(missed, total - reach)));
        result.error->high = static_cast<std::uint64_t>(std::llround(total + reach));
        return result;
    }

    static constexpr std::size_t batch = 4096;
    const LineSize& size;
    const Layout& layout;
    WalkLines lines;
    int shift;
    std::uint64_t accesses = 0;
    std::vector<std::uint8_t> is_sampled;  // by class
    std::vector<Line> found;
    std::vector<std::uint64_t> last;
    std::vector<std::vector<Line>> waiting;
    std::vector<cachesim::LruFamily> classes;
};

Replayed SetSample::replay(std::span<const std::uint32_t> permutation, const QueriesDone& progress) const {
    const auto start = std::chrono::steady_clock::now();
    std::vector<Run> runs;
    runs.reserve(sizes_.size());
    for (const LineSize& size : sizes_) runs.emplace_back(size, layout_);
    Replayed result;
    result.visited_nodes =
        run_walks(walks_, permutation, progress, [&](std::span<const std::uint32_t> elements) {
            result.raw_bytes += layout_.bytes(elements);
            for (Run& run : runs) run.visit(elements);
        });
    for (const CacheConfig& cache : caches_)
        for (Run& run : runs)
            if (run.size.line_bytes == cache.line_bytes) result.caches.push_back(run.traffic(cache));
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace regather::replay
