// tests/cachesim/machines/plain_hierarchy.h -- a second hierarchy, written slowly from the words of
// docs/machines.md: sets are ways with the time of their last use, and every sector of a line knows when it
// became dirty, and by whom. Of two writers the later one counts, which here is looked up and nowhere kept.
// LRU and FIFO, lines modulo the sets, no prefetch; sectors are at least 16 bytes, and so are the DRAM's
// bursts.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "cachesim/machines/hierarchy.h"

namespace regather::cachesim {

class PlainHierarchy {
public:
    static constexpr std::uint64_t line_bytes = 64, burst = 16;

    explicit PlainHierarchy(std::span<const LevelConfig> configs) : sector_(configs.front().sector()) {
        for (const LevelConfig& config : configs) {
            Level level{config, {}, {}, {}};
            level.sets.assign(config.cache.sets(), Ways(config.cache.ways()));
            level.buffer.resize(config.victim_lines);
            levels_.push_back(level);
        }
    }

    void access(const ByteAccess& access, trace::Region region) {
        std::map<std::uint64_t, std::set<std::uint64_t>> by_line;
        for (std::uint64_t b = 0; b < access.bytes; ++b) {
            const std::uint64_t address = access.address + b;
            by_line[address / line_bytes].insert(address % line_bytes);
        }
        for (const auto& [line, bytes] : by_line) {
            if (access.kind == Access::read)
                read(0, line, sectors_of(bytes), region);
            else
                write(0, line, bytes, region, true);
        }
    }

    void flush() {
        for (std::size_t l = 0; l < levels_.size(); ++l) {
            std::vector<Held> all;
            for (Ways& ways : levels_[l].sets)
                for (std::optional<Held>& way : ways)
                    if (way) all.push_back(*way), way.reset();
            for (std::optional<Held>& place : levels_[l].buffer)
                if (place) all.push_back(*place), place.reset();
            for (const Held& held : all)
                if (held.is_dirty()) write_down(l, held);
        }
    }

    const LevelStats& stats(std::size_t level, trace::Region region) const {
        return levels_[level].stats[static_cast<std::size_t>(region)];
    }
    bool holds(std::size_t level, std::uint64_t line, unsigned sector) {
        const std::optional<Held>* const held = find(levels_[level], line);
        return held && (*held)->sectors.contains(sector);
    }
    std::array<std::uint64_t, trace::region_count> bursts_read{}, bursts_written{};

private:
    using Bytes = std::set<std::uint64_t>;    // of a line
    using Sectors = std::set<std::uint64_t>;  // of a line
    struct Sector {
        std::uint64_t dirty_since = 0;  // 0: clean
        trace::Region writer{};
    };
    struct Held {
        std::uint64_t line = 0, used = 0;
        trace::Region owner{};
        std::map<std::uint64_t, Sector> sectors;  // those that are here

        bool is_dirty() const { return !dirty().empty(); }
        Sectors dirty() const {
            Sectors all;
            for (const auto& [number, sector] : sectors)
                if (sector.dirty_since > 0) all.insert(number);
            return all;
        }
        trace::Region writer() const {
            Sector last;
            for (const auto& [number, sector] : sectors)
                if (sector.dirty_since > last.dirty_since) last = sector;
            return last.writer;
        }
    };
    using Ways = std::vector<std::optional<Held>>;
    struct Level {
        LevelConfig config;
        std::vector<Ways> sets;
        Ways buffer;
        std::array<LevelStats, trace::region_count> stats;
        LevelStats& of(trace::Region region) { return stats[static_cast<std::size_t>(region)]; }
        bool takes_writes() const {
            return config.inclusion != Inclusion::exclusive && config.cache.write_miss == WriteMiss::allocate;
        }
        bool through() const { return config.cache.write == WritePolicy::through; }
    };

    Sectors sectors_of(const Bytes& bytes) const {
        Sectors sectors;
        for (const std::uint64_t byte : bytes) sectors.insert(byte / sector_);
        return sectors;
    }
    bool is_exclusive(std::size_t level) const {
        return level < levels_.size() && levels_[level].config.inclusion == Inclusion::exclusive;
    }
    static std::optional<Held>* find_in(Ways& ways, std::uint64_t line) {
        for (std::optional<Held>& way : ways)
            if (way && way->line == line) return &way;
        return nullptr;
    }
    static Ways& set_of(Level& level, std::uint64_t line) { return level.sets[line % level.sets.size()]; }
    static std::optional<Held>* find(Level& level, std::uint64_t line) {
        std::optional<Held>* const way = find_in(set_of(level, line), line);
        return way ? way : find_in(level.buffer, line);
    }
    /// Into the first empty place, or that of the oldest, which is returned.
    std::optional<Held> put(Ways& ways, Held held) {
        held.used = ++now_;
        std::optional<Held>* place = ways.data();
        for (std::optional<Held>& way : ways) {
            if (!way) {
                way = held;
                return {};
            }
            if (way->used < (*place)->used) place = &way;
        }
        std::optional<Held> gone = held;
        std::swap(*place, gone);
        return gone;
    }
    void use(Level& level, std::uint64_t line) {
        std::optional<Held>* const way = find_in(set_of(level, line), line);
        if (way && level.config.cache.policy == Policy::lru) (*way)->used = ++now_;
    }
    void fill(std::size_t l, const Held& held) {
        Level& level = levels_[l];
        std::optional<Held> gone = put(set_of(level, held.line), held);
        if (gone && !level.buffer.empty()) gone = put(level.buffer, *gone);
        if (gone) evict(l, *gone);
    }
    /// A line in the buffer of a level that it does not leave changes places with what its set evicts.
    void swap_in(Level& level, std::uint64_t line) {
        std::optional<Held>* const waiting = find_in(level.buffer, line);
        if (!waiting) return;
        const Held held = **waiting;
        waiting->reset();
        if (std::optional<Held> gone = put(set_of(level, line), held)) put(level.buffer, *gone);
    }
    void count(Level& level, std::uint64_t line, bool tag, bool hit, trace::Region region) {
        LevelStats& stats = level.of(region);
        ++stats.accesses;
        ++(hit ? stats.hits : stats.misses);
        if (tag && !hit) ++stats.sector_misses;
        if (find_in(level.buffer, line)) ++stats.victim_hits;
    }
    Sectors missing(Level& level, std::uint64_t line, const Sectors& need) {
        Sectors rest = need;
        if (const std::optional<Held>* const held = find(level, line))
            for (const auto& [number, sector] : (*held)->sectors) rest.erase(number);
        return rest;
    }

    /// What the level above gets: an exclusive level's sectors with all that is known of them.
    std::map<std::uint64_t, Sector> read(std::size_t l, std::uint64_t line, const Sectors& need,
                                         trace::Region region, bool demand = true) {
        std::map<std::uint64_t, Sector> given;
        if (l == levels_.size()) {
            for (const std::uint64_t number : need) given[number] = {};
            bursts_read[static_cast<std::size_t>(region)] += need.size() * sector_ / burst;
            return given;
        }
        Level& level = levels_[l];
        const Sectors rest = missing(level, line, need);
        std::optional<Held>* held = find(level, line);
        if (demand) count(level, line, held != nullptr, rest.empty(), region);
        if (is_exclusive(l)) {
            if (held) {
                given = (*held)->sectors;
                held->reset();
            }
            if (rest.empty()) return given;
            const auto below = read(l + 1, line, rest, region, demand);
            level.of(region).bytes_in += below.size() * sector_;
            given.insert(below.begin(), below.end());
            return given;
        }
        swap_in(level, line);
        bring(l, line, rest, region, demand);
        (*find(level, line))->owner = region;
        for (const std::uint64_t number : need) given[number] = {};
        return given;
    }
    /// After it the line is here with what was missing, and was used.
    void bring(std::size_t l, std::uint64_t line, const Sectors& rest, trace::Region region, bool demand) {
        Level& level = levels_[l];
        if (!rest.empty()) {
            const auto below = read(l + 1, line, rest, region, demand);
            level.of(region).bytes_in += below.size() * sector_;
            if (std::optional<Held>* const held = find(level, line))
                (*held)->sectors.insert(below.begin(), below.end());
            else
                return fill(l, {line, 0, region, below});
        }
        use(level, line);
    }
    void write(std::size_t l, std::uint64_t line, const Bytes& bytes, trace::Region region, bool demand) {
        if (l == levels_.size()) {
            std::set<std::uint64_t> bursts;
            for (const std::uint64_t byte : bytes) bursts.insert(byte / burst);
            bursts_written[static_cast<std::size_t>(region)] += bursts.size();
            return;
        }
        Level& level = levels_[l];
        const Sectors need = sectors_of(bytes), rest = missing(level, line, need);
        if (demand) count(level, line, find(level, line) != nullptr, rest.empty(), region);
        if (!is_exclusive(l)) swap_in(level, line);
        if (!rest.empty() && !level.takes_writes()) return write_on(l, line, bytes, region, demand);
        bring(l, line, rest, region, demand);
        Held& held = **find(level, line);
        held.owner = region;
        if (level.through()) return write_on(l, line, bytes, region, false);
        ++now_;
        for (const std::uint64_t number : need) held.sectors[number] = {now_, region};
    }
    void write_on(std::size_t l, std::uint64_t line, const Bytes& bytes, trace::Region region, bool demand) {
        LevelStats& stats = levels_[l].of(region);
        ++stats.passed_writes;
        stats.bytes_out += bytes.size();
        write(l + 1, line, bytes, region, demand);
    }

    /// A dirty line leaves level l for the one below: its dirty sectors do.
    void write_down(std::size_t l, const Held& held) {
        LevelStats& stats = levels_[l].of(held.writer());
        ++stats.writebacks;
        stats.bytes_out += held.dirty().size() * sector_;
        take_in(l + 1, held.line, held.dirty(), held.writer());
    }
    void take_in(std::size_t l, std::uint64_t line, const Sectors& dirty, trace::Region writer) {
        if (l == levels_.size()) {
            bursts_written[static_cast<std::size_t>(writer)] += dirty.size() * sector_ / burst;
            return;
        }
        Level& level = levels_[l];
        Held arriving{line, 0, writer, {}};
        ++now_;
        for (const std::uint64_t number : dirty)
            arriving.sectors[number] = level.through() ? Sector{} : Sector{now_, writer};
        bool passes = level.through();
        if (std::optional<Held>* const held = find(level, line)) {
            for (const auto& [number, sector] : arriving.sectors)
                if (!level.through() || !(*held)->sectors.contains(number)) (*held)->sectors[number] = sector;
            (*held)->owner = writer;
            use(level, line);
        } else if (level.takes_writes()) {
            for (std::size_t below = l + 1; is_exclusive(below); ++below)
                if (std::optional<Held>* const lower = find(levels_[below], line)) {
                    for (const auto& [number, sector] : (*lower)->sectors)
                        if (arriving.sectors.emplace(number, sector).second)
                            level.of(writer).bytes_in += sector_;
                    lower->reset();
                    break;
                }
            fill(l, arriving);
        } else {
            passes = true;
        }
        if (!passes) return;
        ++level.of(writer).passed_writes;
        level.of(writer).bytes_out += dirty.size() * sector_;
        take_in(l + 1, line, dirty, writer);
    }
    void evict(std::size_t l, Held held) {
        if (levels_[l].config.inclusion == Inclusion::inclusive)
            for (std::size_t above = l; above-- > 0;)
                if (std::optional<Held>* const found = find(levels_[above], held.line)) {
                    const Held copy = **found;
                    found->reset();
                    ++levels_[above].of(copy.owner).back_invalidations;
                    if (!copy.is_dirty()) continue;
                    LevelStats& stats = levels_[above].of(copy.writer());
                    ++stats.writebacks;
                    stats.bytes_out += copy.dirty().size() * sector_;
                    ++now_;
                    for (const std::uint64_t number : copy.dirty())
                        held.sectors[number] = {now_, copy.writer()};
                }
        if (!is_exclusive(l + 1)) {
            if (held.is_dirty()) write_down(l, held);
            return;
        }
        LevelStats& stats = levels_[l].of(held.is_dirty() ? held.writer() : held.owner);
        ++(held.is_dirty() ? stats.writebacks : stats.clean_victims);
        stats.bytes_out += held.sectors.size() * sector_;
        fill(l + 1, held);
    }

    std::uint64_t sector_, now_ = 0;
    std::vector<Level> levels_;
};

}  // namespace regather::cachesim
