#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "cachesim/machines/hierarchy.h"
#include "trace/error.h"

namespace regather::cachesim {

namespace {

class Checker {
public:
    explicit Checker(std::span<const LevelConfig> levels) : levels_(levels) {}

    void check() const {
        if (levels_.empty() || levels_.size() > max_levels)
            throw trace::UsageError(
                fmt::format("levels: found {}, expected 1 to {}", levels_.size(), max_levels));
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            check_cache(i);
            check_options(i);
            check_against_others(i);
        }
    }

private:
    template <class Found>
    void expect(bool holds, std::size_t level, std::string_view field, const Found& found,
                const std::string& expected) const {
        if (!holds)
            throw trace::UsageError(
                fmt::format("levels[{}].{}: found {}, expected {}", level, field, found, expected));
    }

    void check_cache(std::size_t i) const {
        const PolicyConfig& cache = levels_[i].cache;
        expect(cache.policy != Policy::opt, i, "policy", "opt", "one that does not need the future");
        try {
            cachesim::check(cache);
        } catch (const trace::UsageError& error) {
            throw trace::UsageError(fmt::format("levels[{}].{}", i, error.what()));
        }
        expect(cache.geometry.size_bytes / cache.geometry.line_bytes <= max_hierarchy_lines, i, "size_bytes",
               cache.geometry.size_bytes, fmt::format("at most {} lines in a level", max_hierarchy_lines));
    }

    void check_options(std::size_t i) const {
        const LevelConfig& level = levels_[i];
        const std::uint32_t line = level.line_bytes(), sector = level.sector();
        expect(std::has_single_bit(sector) && sector <= line && line / sector <= max_sectors, i,
               "sector_bytes", sector,
               fmt::format("a power of two from {} to the line of {} bytes",
                           std::max(line / max_sectors, std::uint32_t{1}), line));
        expect(level.victim_lines <= max_victim_lines, i, "victim_lines", level.victim_lines,
               fmt::format("0 to {}", max_victim_lines));
    }

    void check_against_others(std::size_t i) const {
        const LevelConfig &level = levels_[i], &nearest = levels_.front();
        for (std::size_t j = 0; j < i; ++j)
            expect(level.name != levels_[j].name, i, "name", level.name,
                   fmt::format("another name than that of levels[{}]", j));
        expect(level.line_bytes() == nearest.line_bytes(), i, "line_bytes", level.line_bytes(),
               fmt::format("{} as in levels[0]: all levels have the same line", nearest.line_bytes()));
        expect(level.sector() == nearest.sector(), i, "sector_bytes", level.sector(),
               fmt::format("{} as in levels[0]: all levels have the same sector", nearest.sector()));
        if (i == 0)
            expect(level.inclusion == Inclusion::neither, i, "inclusion",
                   inclusion_names[static_cast<std::size_t>(level.inclusion)],
                   "neither: no level is above it");
        if (level.inclusion != Inclusion::exclusive) return;
        expect(level.prefetch == Prefetch::none, i, "prefetch",
               prefetch_names[static_cast<std::size_t>(level.prefetch)],
               "none: an exclusive level is filled by victims only");
        for (const std::size_t j : {i - 1, i})
            expect(levels_[j].cache.write == WritePolicy::back, j, "write", "through",
                   fmt::format("back: levels[{}] is exclusive", i));
    }

    std::span<const LevelConfig> levels_;
};

}  // namespace

void check(std::span<const LevelConfig> levels) {
    Checker(levels).check();
}

}  // namespace regather::cachesim
