// cachesim/machines/hierarchy.h -- one to four levels of cache and the memory behind them, exact: byte
// accesses go in, counts by level and region come out. Each level has its own geometry, policy, write policy
// and set index (policy.h), and says whether it includes the levels above. Options of a level: a victim
// buffer (Jouppi, "Improving direct-mapped cache performance by the addition of a small fully-associative
// cache and prefetch buffers", ISCA 1990), lines of sectors, next-line prefetch (one-block lookahead: Smith,
// "Cache memories", Computing Surveys 1982). Nothing is timed. docs/machines.md says every rule in words.
//
// Level 0 is the nearest. All levels have the same line and sector.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/lines.h"
#include "cachesim/machines/dram.h"
#include "cachesim/machines/line_store.h"

namespace regather::cachesim {

/// neither:   a fetch fills the level; an eviction does not touch the levels above.
/// inclusive: as neither, but a line that goes, goes from all levels above, too.
/// exclusive: filled by what the level above evicts, clean or dirty, and by nothing else; a line that is
/// found here
///            moves up.
enum class Inclusion : std::uint8_t { neither, inclusive, exclusive };
inline constexpr std::array<std::string_view, 3> inclusion_names{"neither", "inclusive", "exclusive"};

/// When line n + 1 is prefetched: never; when n missed; when n missed, or was itself prefetched and is used
/// for the first time (tagged); whenever n is accessed.
enum class Prefetch : std::uint8_t { none, on_miss, tagged, always };
inline constexpr std::array<std::string_view, 4> prefetch_names{"none", "on-miss", "tagged", "always"};

struct LevelConfig {
    std::string name = "L1";
    PolicyConfig cache{};
    Inclusion inclusion = Inclusion::neither;
    std::uint32_t sector_bytes = 0;  ///< 0: the whole line. A power of two; at most max_sectors of them.
    std::uint32_t victim_lines = 0;  ///< In the victim buffer; 0: none.
    Prefetch prefetch = Prefetch::none;

    std::uint32_t line_bytes() const { return cache.geometry.line_bytes; }
    std::uint32_t sector() const { return sector_bytes == 0 ? line_bytes() : sector_bytes; }
};

inline constexpr std::size_t max_levels = 4;
inline constexpr std::uint64_t max_hierarchy_lines = std::uint64_t{1}
                                                     << 24;  ///< Of a level: memory is bounded.
inline constexpr std::uint32_t max_victim_lines = 4096;

/// Throws trace::UsageError: "levels[1].ways: found X, expected Y".
void check(std::span<const LevelConfig> levels);

/// What one region did at one level. accesses, hits and misses are those of the demand: at level 0 the
/// user's, below the misses of the level above. Prefetches and writes from above are not among them.
struct LevelStats {
    std::uint64_t accesses = 0;            ///< Line accesses.
    std::uint64_t hits = 0;                ///< All sectors asked for were here, or in the victim buffer.
    std::uint64_t misses = 0;              ///< accesses - hits
    std::uint64_t sector_misses = 0;       ///< Those misses whose line was here without the sector.
    std::uint64_t victim_hits = 0;         ///< Accesses whose line was in the victim buffer.
    std::uint64_t writebacks = 0;          ///< Dirty lines that left; charged to the region that wrote last.
    std::uint64_t clean_victims = 0;       ///< Clean lines handed to an exclusive level.
    std::uint64_t passed_writes = 0;       ///< Writes that went on as they came: through, or not allocated.
    std::uint64_t back_invalidations = 0;  ///< Lines taken from here by an inclusive level below.
    std::uint64_t prefetches = 0;          ///< Lines fetched by this level's own prefetcher.
    std::uint64_t useful_prefetches = 0;   ///< Of those, used by a demand access while they were here.
    std::uint64_t bytes_in = 0;            ///< From below.
    std::uint64_t bytes_out = 0;           ///< To below.
    LevelStats& operator+=(const LevelStats& other);
    LevelStats& operator-=(const LevelStats& earlier);  ///< Of the same level, and no later.
    friend bool operator==(const LevelStats&, const LevelStats&) = default;
};

/// What all levels and the memory counted, by region.
struct HierarchyCounts {
    std::vector<std::array<LevelStats, trace::region_count>> levels;  ///< Nearest first.
    std::array<DramStats, trace::region_count> dram{};                ///< 0 without one.
    /// Of hierarchies with as many levels.
    HierarchyCounts& operator+=(const HierarchyCounts& other);
    HierarchyCounts& operator-=(const HierarchyCounts& earlier);
    friend bool operator==(const HierarchyCounts&, const HierarchyCounts&) = default;
};

class Hierarchy {
public:
    /// check()s them. Without `dram` the memory only receives.
    explicit Hierarchy(std::span<const LevelConfig> levels, const std::optional<DramConfig>& dram = {});

    /// In this order. An access that straddles lines is one access to each.
    void access(std::span<const ByteAccess> accesses, trace::Region region);
    /// Empties the levels from the nearest on; dirty lines are written back, clean ones dropped.
    void flush();

    std::size_t levels() const { return levels_.size(); }
    const LevelConfig& config(std::size_t level) const { return levels_[level].config; }
    const LevelStats& stats(std::size_t level, trace::Region region) const {
        return levels_[level].stats[static_cast<std::size_t>(region)];
    }
    LevelStats total(std::size_t level) const;
    HierarchyCounts counts() const;
    const Dram* dram() const { return dram_ ? &*dram_ : nullptr; }

    /// Whether a level or its victim buffer has the line, if only a sector of it.
    bool holds(std::size_t level, Line line) const;
    /// The same for the sector with this number in the line.
    bool holds(std::size_t level, Line line, unsigned sector) const;

private:
    struct Level {
        LevelConfig config;
        LineStore lines;
        std::optional<LineStore> victims;
        std::array<LevelStats, trace::region_count> stats{};

        LevelStats& of(trace::Region region) { return stats[static_cast<std::size_t>(region)]; }
        bool is(Inclusion inclusion) const { return config.inclusion == inclusion; }
    };
    /// Who asks: the user's demand, which is counted, or a prefetch or a write from above.
    struct Asker {
        trace::Region region;
        bool demand;
    };
    // Wider than two registers, so that it is returned in memory: packed into registers it costs a stall of
    // the store buffer, and a quarter of the speed.
    struct Supply {
        alignas(8) Sectors valid;
        alignas(8) Sectors dirty;
        alignas(8) trace::Region writer;
    };
    struct Bytes {
        std::uint32_t first, count;  // in the line
    };
    struct Wish {
        std::size_t level;
        Line line;
        trace::Region region;
    };

    Sectors sectors_of(Bytes bytes) const;
    std::uint64_t bytes_of(Sectors sectors) const;
    bool exclusive(std::size_t level) const;

    Supply fetch(std::size_t level, Line line, Sectors need, Asker asker);
    void store(std::size_t level, Line line, Bytes bytes, Asker asker);
    void write_back(std::size_t level, Line line, Sectors dirty, trace::Region writer);
    void take_victim(std::size_t level, Line line, const LineState& state);
    void prefetch(const Wish& wish);

    LineState* locate(Level& level, Line line, Asker asker);
    LineState* peek(Level& level, Line line);
    std::optional<LineState> take(Level& level, Line line);
    LineState& complete(std::size_t level, Line line, LineState* here, Sectors need, Asker asker);
    void used(std::size_t level, Line line, LineState& state, bool missed, Asker asker);
    LineState& insert(std::size_t level, Line line, const LineState& state);
    static void use(Level& level, const LineState* state);
    void leave(std::size_t level, Line line, LineState state);
    void pass(std::size_t level, Line line, Bytes bytes, Asker asker);
    void memory(Line line, Sectors sectors, Access kind, trace::Region region);

    std::vector<Level> levels_;
    std::optional<Dram> dram_;
    std::uint32_t line_bytes_, sector_shift_;
    std::vector<Wish> wishes_;  // prefetches that wait for the access to end
};

}  // namespace regather::cachesim
