#include "cachesim/machines/hierarchy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>

#include "trace/error.h"

namespace regather::cachesim {

namespace {

PolicyConfig victim_buffer(const LevelConfig& config) {
    PolicyConfig buffer;
    buffer.geometry = {std::uint64_t{config.victim_lines} * config.line_bytes(), config.line_bytes(),
                       fully_associative};
    return buffer;
}

bool passes_misses(const LevelConfig& config) {
    return config.inclusion == Inclusion::exclusive || config.cache.write_miss == WriteMiss::no_allocate;
}

/// An access of the demand; `held`: the line is here, if only some of it.
void count(LevelStats& stats, bool held, bool hit) {
    ++stats.accesses;
    ++(hit ? stats.hits : stats.misses);
    if (held && !hit) ++stats.sector_misses;
}

constexpr std::uint64_t LevelStats::*level_counts[] = {&LevelStats::accesses,
                                                       &LevelStats::hits,
                                                       &LevelStats::misses,
                                                       &LevelStats::sector_misses,
                                                       &LevelStats::victim_hits,
                                                       &LevelStats::writebacks,
                                                       &LevelStats::clean_victims,
                                                       &LevelStats::passed_writes,
                                                       &LevelStats::back_invalidations,
                                                       &LevelStats::prefetches,
                                                       &LevelStats::useful_prefetches,
                                                       &LevelStats::bytes_in,
                                                       &LevelStats::bytes_out};

}  // namespace

LevelStats& LevelStats::operator+=(const LevelStats& other) {
    for (const auto count : level_counts) this->*count += other.*count;
    return *this;
}

LevelStats& LevelStats::operator-=(const LevelStats& earlier) {
    for (const auto count : level_counts) this->*count -= earlier.*count;
    return *this;
}

HierarchyCounts& HierarchyCounts::operator+=(const HierarchyCounts& other) {
    assert(levels.size() == other.levels.size());
    for (std::size_t r = 0; r < trace::region_count; ++r) {
        for (std::size_t l = 0; l < levels.size(); ++l) levels[l][r] += other.levels[l][r];
        dram[r] += other.dram[r];
    }
    return *this;
}

HierarchyCounts& HierarchyCounts::operator-=(const HierarchyCounts& earlier) {
    assert(levels.size() == earlier.levels.size());
    for (std::size_t r = 0; r < trace::region_count; ++r) {
        for (std::size_t l = 0; l < levels.size(); ++l) levels[l][r] -= earlier.levels[l][r];
        dram[r] -= earlier.dram[r];
    }
    return *this;
}

Hierarchy::Hierarchy(std::span<const LevelConfig> levels, const std::optional<DramConfig>& dram) {
    check(levels);
    for (const LevelConfig& config : levels) {
        levels_.push_back({config, LineStore(config.cache), {}, {}});
        if (config.victim_lines > 0) levels_.back().victims.emplace(victim_buffer(config));
    }
    if (dram) dram_.emplace(*dram);
    line_bytes_ = levels.front().line_bytes();
    sector_shift_ = static_cast<std::uint32_t>(std::countr_zero(levels.front().sector()));
}

void Hierarchy::access(std::span<const ByteAccess> accesses, trace::Region region) {
    const std::uint64_t mask = line_bytes_ - 1;
    const Asker user{region, true};
    for (const ByteAccess& access : accesses) {
        std::uint64_t at = access.address;
        for (std::uint64_t left = access.bytes; left > 0;) {
            const Line line{at / line_bytes_};
            const Bytes bytes{static_cast<std::uint32_t>(at & mask),
                              static_cast<std::uint32_t>(std::min(left, line_bytes_ - (at & mask)))};
            if (access.kind == Access::read)
                fetch(0, line, sectors_of(bytes), user);
            else
                store(0, line, bytes, user);
            at += bytes.count;
            left -= bytes.count;
            if (wishes_.empty()) continue;
            std::sort(wishes_.begin(), wishes_.end(),
                      [](const Wish& a, const Wish& b) { return a.level < b.level; });
            for (const Wish& wish : wishes_) prefetch(wish);
            wishes_.clear();
        }
    }
}

Hierarchy::Supply Hierarchy::fetch(std::size_t level, Line line, Sectors need, Asker asker) {
    if (level == levels_.size()) {
        memory(line, need, Access::read, asker.region);
        return {need, 0, asker.region};
    }
    Level& here = levels_[level];
    LevelStats& stats = here.of(asker.region);
    LineState* state = locate(here, line, asker);
    const bool hit = state && (need & ~state->valid) == 0;
    if (asker.demand) count(stats, state != nullptr, hit);
    if (here.is(Inclusion::exclusive)) {
        // What is here moves up; what is not passes by.
        const std::optional<LineState> moved = take(here, line);
        Supply supply =
            moved ? Supply{moved->valid, moved->dirty, moved->writer} : Supply{0, 0, asker.region};
        if (hit) return supply;
        const Supply below = fetch(level + 1, line, need & ~supply.valid, asker);
        stats.bytes_in += bytes_of(below.valid);
        if (supply.dirty == 0) supply.writer = below.writer;
        return {supply.valid | below.valid, supply.dirty | below.dirty, supply.writer};
    }
    if (hit)
        use(here, state);
    else
        state = &complete(level, line, state, need, asker);
    used(level, line, *state, !hit, asker);
    return {need, 0, asker.region};
}

void Hierarchy::store(std::size_t level, Line line, Bytes bytes, Asker asker) {
    if (level == levels_.size()) {
        if (dram_)
            dram_->access(static_cast<std::uint64_t>(line) * line_bytes_ + bytes.first, bytes.count,
                          Access::write, asker.region);
        return;
    }
    Level& here = levels_[level];
    LevelStats& stats = here.of(asker.region);
    const Sectors need = sectors_of(bytes);
    LineState* state = locate(here, line, asker);
    const bool hit = state && (need & ~state->valid) == 0;
    if (asker.demand) count(stats, state != nullptr, hit);
    if (!hit && passes_misses(here.config)) return pass(level, line, bytes, asker);
    if (hit)
        use(here, state);
    else
        state = &complete(level, line, state, need, asker);
    used(level, line, *state, !hit, asker);
    if (here.config.cache.write == WritePolicy::through)
        return pass(level, line, bytes, {asker.region, false});
    state->dirty |= need;
    state->writer = asker.region;
}

// Fetches the sectors that a line lacks, and the line itself if it is not here.
LineState& Hierarchy::complete(std::size_t level, Line line, LineState* state, Sectors need, Asker asker) {
    const bool held = state != nullptr;
    const Supply below = fetch(level + 1, line, held ? need & ~state->valid : need, asker);
    Level& here = levels_[level];
    here.of(asker.region).bytes_in += bytes_of(below.valid);
    if (!held)
        return insert(
            level, line,
            {.valid = below.valid, .dirty = below.dirty, .owner = asker.region, .writer = below.writer});
    state = here.lines.find(line);
    state->valid |= below.valid;
    if (below.dirty != 0) state->writer = below.writer;
    state->dirty |= below.dirty;
    here.lines.use(state);
    return *state;
}

void Hierarchy::used(std::size_t level, Line line, LineState& state, bool missed, Asker asker) {
    state.owner = asker.region;
    if (!asker.demand) return;
    Level& here = levels_[level];
    const bool first_use = state.prefetched;
    if (first_use) {
        ++here.of(state.fetcher).useful_prefetches;
        state.prefetched = false;
    }
    const Prefetch when = here.config.prefetch;
    if (when == Prefetch::always || (when == Prefetch::tagged && (missed || first_use)) ||
        (when == Prefetch::on_miss && missed))
        wishes_.push_back({level, line, asker.region});
}

// Waits until the access that asked for it is over: a fill below could otherwise push out, and an inclusive
// level take back, what the levels above are about to receive.
void Hierarchy::prefetch(const Wish& wish) {
    const std::uint64_t next = static_cast<std::uint64_t>(wish.line) + 1;
    if (next > ~std::uint64_t{0} / line_bytes_) return;
    const Line line{next};
    Level& here = levels_[wish.level];
    if (peek(here, line)) return;
    // An exclusive level takes nothing that a level above holds and will hand down.
    for (std::size_t level = wish.level; level > 0 && levels_[level].is(Inclusion::exclusive); --level)
        if (peek(levels_[level - 1], line)) return;
    const auto all = static_cast<Sectors>((std::uint64_t{1} << (line_bytes_ >> sector_shift_)) - 1);
    const Supply below = fetch(wish.level + 1, line, all, {wish.region, false});
    LevelStats& stats = here.of(wish.region);
    ++stats.prefetches;
    stats.bytes_in += bytes_of(below.valid);
    insert(wish.level, line,
           {.valid = below.valid,
            .dirty = below.dirty,
            .owner = wish.region,
            .writer = below.writer,
            .fetcher = wish.region,
            .prefetched = true});
}

// Dirty sectors of a line that left the level above. They are whole, so nothing is fetched for them.
void Hierarchy::write_back(std::size_t level, Line line, Sectors dirty, trace::Region writer) {
    if (level == levels_.size()) return memory(line, dirty, Access::write, writer);
    Level& here = levels_[level];
    const bool through = here.config.cache.write == WritePolicy::through;
    LineState* const state = peek(here, line);
    const bool passes = through || (!state && passes_misses(here.config));
    if (state) {
        use(here, state);
        state->valid |= dirty;
        state->owner = writer;
        if (!through) {
            state->dirty |= dirty;
            state->writer = writer;
        }
    } else if (!passes_misses(here.config)) {
        LineState brought{.valid = dirty, .dirty = through ? 0 : dirty, .owner = writer, .writer = writer};
        // Exclusive levels that follow one another hold a line once: whichever has it gives it up.
        for (std::size_t below = level + 1; exclusive(below); ++below) {
            if (const std::optional<LineState> held = take(levels_[below], line)) {
                here.of(writer).bytes_in += bytes_of(held->valid & ~dirty);
                brought.valid |= held->valid;
                brought.dirty |= held->dirty;
                break;
            }
        }
        insert(level, line, brought);
    }
    if (!passes) return;
    LevelStats& stats = here.of(writer);
    ++stats.passed_writes;
    stats.bytes_out += bytes_of(dirty);
    write_back(level + 1, line, dirty, writer);
}

void Hierarchy::take_victim(std::size_t level, Line line, const LineState& state) {
    insert(level, line,
           {.valid = state.valid, .dirty = state.dirty, .owner = state.owner, .writer = state.writer});
}

// Nothing that follows from the eviction takes the line out again: only a fill of an inclusive level does
// that, and what leaves this level is already in those below.
LineState& Hierarchy::insert(std::size_t level, Line line, const LineState& state) {
    Level& here = levels_[level];
    auto [inserted, gone] = here.lines.insert(line, state);
    if (gone && here.victims) gone = here.victims->insert(gone->line, gone->state).gone;
    if (gone) leave(level, gone->line, gone->state);
    return *inserted;
}

// A hit. A line that waits in the victim buffer has no place in the order of the policy.
void Hierarchy::use(Level& level, const LineState* state) {
    if (level.lines.has(state)) level.lines.use(state);
}

void Hierarchy::leave(std::size_t level, Line line, LineState state) {
    if (levels_[level].is(Inclusion::inclusive)) {
        // The nearest copy is the latest: its writer has the last word.
        for (std::size_t above = level; above-- > 0;) {
            const std::optional<LineState> copy = take(levels_[above], line);
            if (!copy) continue;
            ++levels_[above].of(copy->owner).back_invalidations;
            if (copy->dirty == 0) continue;
            LevelStats& stats = levels_[above].of(copy->writer);
            ++stats.writebacks;
            stats.bytes_out += bytes_of(copy->dirty);
            state.dirty |= copy->dirty;
            state.writer = copy->writer;
        }
    }
    const bool dirty = state.dirty != 0, whole = exclusive(level + 1);
    if (!dirty && !whole) return;
    LevelStats& stats = levels_[level].of(dirty ? state.writer : state.owner);
    ++(dirty ? stats.writebacks : stats.clean_victims);
    stats.bytes_out += bytes_of(whole ? state.valid : state.dirty);
    if (whole)
        take_victim(level + 1, line, state);
    else
        write_back(level + 1, line, state.dirty, state.writer);
}

void Hierarchy::pass(std::size_t level, Line line, Bytes bytes, Asker asker) {
    LevelStats& stats = levels_[level].of(asker.region);
    ++stats.passed_writes;
    stats.bytes_out += bytes.count;
    store(level + 1, line, bytes, asker);
}

// Where a line is, after a swap if it was in the victim buffer: Jouppi's hit.
LineState* Hierarchy::locate(Level& level, Line line, Asker asker) {
    if (LineState* const state = level.lines.find(line)) return state;
    if (!level.victims) return nullptr;
    LineState* const waiting = level.victims->find(line);
    if (!waiting) return nullptr;
    if (asker.demand) ++level.of(asker.region).victim_hits;
    if (level.is(Inclusion::exclusive)) return waiting;  // it is about to move up
    const LineState state = *level.victims->remove(line);
    // The buffer has room: the line that comes has just left it.
    const auto [inserted, gone] = level.lines.insert(line, state);
    if (gone) level.victims->insert(gone->line, gone->state);
    return inserted;
}

LineState* Hierarchy::peek(Level& level, Line line) {
    if (LineState* const state = level.lines.find(line)) return state;
    return level.victims ? level.victims->find(line) : nullptr;
}

std::optional<LineState> Hierarchy::take(Level& level, Line line) {
    std::optional<LineState> state = level.lines.remove(line);
    if (!state && level.victims) state = level.victims->remove(line);
    return state;
}

void Hierarchy::memory(Line line, Sectors sectors, Access kind, trace::Region region) {
    if (!dram_) return;
    const std::uint64_t base = static_cast<std::uint64_t>(line) * line_bytes_;
    for (std::uint64_t rest = sectors; rest != 0;) {
        const int first = std::countr_zero(rest), count = std::countr_one(rest >> first);
        dram_->access(base + (std::uint64_t(first) << sector_shift_), std::uint64_t(count) << sector_shift_,
                      kind, region);
        rest &= ~(((std::uint64_t{1} << count) - 1) << first);
    }
}

void Hierarchy::flush() {
    for (std::size_t level = 0; level < levels_.size(); ++level) {
        Level& here = levels_[level];
        std::vector<HeldLine> lines = here.lines.drain();
        if (here.victims)
            for (const HeldLine& held : here.victims->drain()) lines.push_back(held);
        for (const auto& [line, state] : lines) {
            if (state.dirty == 0) continue;
            LevelStats& stats = here.of(state.writer);
            ++stats.writebacks;
            stats.bytes_out += bytes_of(state.dirty);
            write_back(level + 1, line, state.dirty, state.writer);
        }
    }
}

Sectors Hierarchy::sectors_of(Bytes bytes) const {
    const std::uint32_t first = bytes.first >> sector_shift_,
                        last = (bytes.first + (bytes.count - 1)) >> sector_shift_;
    return static_cast<Sectors>(((std::uint64_t{2} << (last - first)) - 1) << first);
}

std::uint64_t Hierarchy::bytes_of(Sectors sectors) const {
    return static_cast<std::uint64_t>(std::popcount(sectors)) << sector_shift_;
}

bool Hierarchy::exclusive(std::size_t level) const {
    return level < levels_.size() && levels_[level].is(Inclusion::exclusive);
}

HierarchyCounts Hierarchy::counts() const {
    HierarchyCounts counts;
    for (const Level& level : levels_) counts.levels.push_back(level.stats);
    if (dram_)
        for (std::size_t r = 0; r < trace::region_count; ++r)
            counts.dram[r] = dram_->stats(static_cast<trace::Region>(r));
    return counts;
}

LevelStats Hierarchy::total(std::size_t level) const {
    LevelStats sum;
    for (const LevelStats& region : levels_[level].stats) sum += region;
    return sum;
}

bool Hierarchy::holds(std::size_t level, Line line) const {
    const Level& here = levels_[level];
    return here.lines.find(line) || (here.victims && here.victims->find(line));
}

bool Hierarchy::holds(std::size_t level, Line line, unsigned sector) const {
    const Level& here = levels_[level];
    const LineState* state = here.lines.find(line);
    if (!state && here.victims) state = here.victims->find(line);
    return state && (state->valid >> sector & 1) != 0;
}

}  // namespace regather::cachesim
