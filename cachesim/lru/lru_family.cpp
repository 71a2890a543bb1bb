#include "cachesim/lru/lru_family.h"

#include <fmt/format.h>
#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <stdexcept>

#include "cachesim/lru/line_stamps.h"
#include "cachesim/lru/recency_rows.h"
#include "cachesim/lru/stamp_bits.h"
#include "trace/error.h"

namespace regather::cachesim {

namespace {

constexpr std::uint32_t max_row = 32;
constexpr std::uint64_t max_sets = std::uint64_t{1} << 24;

std::uint32_t row_of(std::uint32_t ways) {
    return std::max(4u, std::bit_ceil(ways));
}

void add(std::vector<std::uint64_t>& to, const std::vector<std::uint64_t>& what) {
    if (to.size() < what.size()) to.resize(what.size());
    for (std::size_t i = 0; i < what.size(); ++i) to[i] += what[i];
}

}  // namespace

const FamilyCounts::Level& FamilyCounts::level(std::uint64_t sets, std::uint32_t ways) const {
    for (const Level& candidate : levels)
        if (candidate.level.sets == sets && ways - 1 < candidate.level.ways) return candidate;
    throw std::logic_error(fmt::format("{} sets of {} ways are not in the family", sets, ways));
}

std::uint64_t FamilyCounts::misses(std::uint64_t sets, std::uint32_t ways) const {
    return level(sets, ways).misses[ways - 1];
}

std::uint64_t FamilyCounts::conflicts(std::uint64_t sets, std::uint32_t ways) const {
    return level(sets, ways).conflicts[ways - 1];
}

std::uint64_t FamilyCounts::full_misses(std::uint64_t lines) const {
    const std::size_t first = std::min<std::size_t>(lines, by_distance.size());
    return std::accumulate(by_distance.begin() + static_cast<std::ptrdiff_t>(first), by_distance.end(),
                           compulsory);
}

FamilyCounts& FamilyCounts::operator+=(const FamilyCounts& other) {
    if (levels.empty())
        levels = other.levels;
    else
        for (std::size_t l = 0; l < levels.size(); ++l) {
            if (levels[l].level != other.levels.at(l).level) throw std::logic_error("counts of two families");
            add(levels[l].misses, other.levels[l].misses);
            add(levels[l].conflicts, other.levels[l].conflicts);
        }
    accesses += other.accesses;
    compulsory += other.compulsory;
    add(by_distance, other.by_distance);
    return *this;
}

/// The rows of some levels, and the touches on their way to them.
class LruFamily::Batch {
public:
    Batch(bool with_distances, bool with_conflicts)
        : with_distances_(with_distances), with_conflicts_(with_conflicts) {}

    void add(const FamilyLevel& level, FamilyCounts& counts) {
        Rows& rows = rows_.emplace_back();
        const std::uint32_t row = row_of(level.ways);
        rows.places = level.sets * row;
        rows.stamps = hwy::AllocateAligned<std::int32_t>(rows.places);
        if (!rows.stamps) throw std::bad_alloc();
        std::fill_n(rows.stamps.get(), rows.places, empty_place);
        rows.kernel = {rows.stamps.get(), row, static_cast<std::uint32_t>(std::countr_zero(level.sets))};
        rows.misses.resize(row);
        rows.conflicts.resize(row);
        rows.level = counts.levels.size();
        counts.levels.push_back({level, std::vector<std::uint64_t>(level.ways),
                                 std::vector<std::uint64_t>(with_conflicts_ ? level.ways : 0)});
    }
    bool empty() const { return rows_.empty(); }
    bool full() const { return fill_ == capacity; }
    /// Flushes when there is no room for `count` touches, at most `capacity`.
    void make_room(std::size_t count) {
        if (fill_ + count > capacity) flush();
    }
    static constexpr std::size_t capacity = 2048;

    /// Touches to be filled in place after make_room(): all of them counted.
    struct Places {
        std::uint32_t* line;
        std::int32_t *before, *now, *distance;
    };
    Places append(std::size_t count) {
        const Places places{line_.data() + fill_, before_.data() + fill_, now_.data() + fill_,
                            distance_.data() + fill_};
        std::fill_n(counted_.data() + fill_, count, -1);
        fill_ += count;
        return places;
    }

    /// Not when full().
    void push(Line line, std::int32_t before, std::int32_t now, std::int32_t distance, bool counted) {
        line_[fill_] = static_cast<std::uint32_t>(static_cast<std::uint64_t>(line) << 6);
        before_[fill_] = before;
        now_[fill_] = now;
        distance_[fill_] = distance;
        counted_[fill_] = counted ? -1 : 0;
        all_counted_ = all_counted_ && counted;
        ++fill_;
    }

    /// Adds what the rows have counted since the last time.
    void collect(FamilyCounts& counts) {
        flush();
        for (Rows& rows : rows_) {
            FamilyCounts::Level& level = counts.levels[rows.level];
            for (std::size_t w = 0; w < level.misses.size(); ++w) level.misses[w] += rows.misses[w];
            for (std::size_t w = 0; w < level.conflicts.size(); ++w) level.conflicts[w] += rows.conflicts[w];
            std::fill(rows.misses.begin(), rows.misses.end(), 0);
            std::fill(rows.conflicts.begin(), rows.conflicts.end(), 0);
        }
    }

    void flush() {
        if (fill_ == 0) return;
        const Touches touches{line_.data(),
                              before_.data(),
                              now_.data(),
                              with_distances_ ? distance_.data() : nullptr,
                              all_counted_ ? nullptr : counted_.data(),
                              fill_};
        // Rows of one width go together.
        for (std::size_t first = 0; first < rows_.size();) {
            std::vector<RecencyRows> kernels;
            std::vector<RowCounts> sums;
            std::size_t end = first;
            for (; end < rows_.size() && rows_[end].kernel.row == rows_[first].kernel.row; ++end) {
                Rows& rows = rows_[end];
                kernels.push_back(rows.kernel);
                sums.push_back({rows.misses.data(), with_conflicts_ ? rows.conflicts.data() : nullptr});
            }
            touch_rows(kernels, touches, sums);
            first = end;
        }
        fill_ = 0;
        all_counted_ = true;
    }

    /// Replaces every stamp in the rows; none may be on the way.
    template <class Renumbered>
    void renumber(Renumbered&& renumbered) {
        for (const Rows& rows : rows_)
            for (std::size_t i = 0; i < rows.places; ++i)
                if (rows.stamps[i] >= first_stamp) rows.stamps[i] = renumbered(rows.stamps[i]);
    }

private:
    struct Rows {
        hwy::AlignedFreeUniquePtr<std::int32_t[]> stamps;
        std::size_t places = 0, level = 0;
        std::vector<std::uint64_t> misses, conflicts;
        RecencyRows kernel{};
    };
    bool with_distances_, with_conflicts_, all_counted_ = true;
    std::vector<Rows> rows_;
    std::size_t fill_ = 0;
    alignas(64) std::array<std::uint32_t, capacity + prefetched_ahead> line_{};
    alignas(64) std::array<std::int32_t, capacity> before_{}, now_{}, distance_{}, counted_{};
};

/// Two streams: all touches, for distances and the levels of few sets; and those that are left when a touch
/// of the line that is the newest of its set, for the levels of many sets. Such a touch hits in all of these
/// and changes the order in none.
class LruFamily::Engine {
public:
    explicit Engine(const FamilyConfig& config)
        : distances_(config.distances),
          bits_(config.stamps),
          all_(config.distances, config.distances && config.conflicts),
          filtered_(config.distances, config.distances && config.conflicts) {
        std::uint64_t fewest = max_sets;
        for (const FamilyLevel& level : config.levels) {
            if (!std::has_single_bit(level.sets) || level.sets > max_sets)
                throw trace::UsageError(
                    fmt::format("sets: found {}, expected a power of two up to {}", level.sets, max_sets));
            if (level.ways == 0 || level.ways > max_row)
                throw trace::UsageError(fmt::format("ways: found {}, expected 1 to {}", level.ways, max_row));
            (level.sets < filtered_from ? all_ : filtered_).add(level, counts_);
            if (level.sets >= filtered_from) fewest = std::min(fewest, level.sets);
        }
        if (filtered_.empty()) return;
        newest_.resize(fewest);
        for (std::uint64_t set = 0; set < fewest; ++set)
            newest_[set].line = Line{set ^ 1};  // of another set: none yet
    }

    void access(std::span<const Line> lines) {
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (i + ahead < lines.size()) last_.prefetch(lines[i + ahead]);
            if (next_ == bits_.capacity()) renumber(1);
            touch<true>(lines[i], 0, 0);
            end_walk(1);
        }
        counts_.accesses += lines.size();
    }

    void access_first(std::span<const Line> lines, std::span<const std::uint32_t> last_rank) {
        const auto count = static_cast<std::uint32_t>(lines.size());
        if (next_ + lines.size() > bits_.capacity()) renumber(lines.size());
        if (last_.low(lines)) {
            for (std::uint32_t done = 0; done < count; done += Batch::capacity)
                touch_low(lines, last_rank, done, std::min<std::uint32_t>(Batch::capacity, count - done));
        } else {
            for (std::uint32_t i = 0; i < count; ++i) touch<true>(lines[i], last_rank[i], i);
        }
        end_walk(count);
        counts_.accesses += count;
    }

    void revisit(std::span<const Line> lines) {
        if (next_ + lines.size() > bits_.capacity()) renumber(lines.size());
        const std::uint32_t start = next_;
        std::uint64_t again = 0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (i + ahead < lines.size()) last_.prefetch(lines[i + ahead]);
            if (static_cast<std::uint32_t>(last_.of(lines[i]).all) >= start) {
                ++again;
                touch<true>(lines[i], 0, 0);
            } else {
                touch<false>(lines[i], 0, 0);
            }
            end_walk(1);
        }
        counts_.accesses += again;
    }

    const FamilyCounts& counts() {
        all_.collect(counts_);
        filtered_.collect(counts_);
        while (!counts_.by_distance.empty() && counts_.by_distance.back() == 0)
            counts_.by_distance.pop_back();
        return counts_;
    }

private:
    static constexpr std::size_t ahead = 16;
    static constexpr std::uint64_t filtered_from = 256;  // sets
    static constexpr std::uint64_t max_stamps = std::uint64_t{1} << 28;

    /// The newest line of a set, counted for the level of the fewest sets that are filtered.
    struct Newest {
        Line line{};
        std::uint64_t walk = 0;  // in which it was touched last
        std::int32_t now = 0;    // the stamp that it then should have ...
        bool left_out = false;   // ... and has not got
    };

    /// One touch of a walk whose stamps start at next_: its line's last touch in the walk is the `rank`-th.
    /// `met`: lines of the walk that were touched before it, when their bits are set at the walk's end.
    template <bool counted>
    void touch(Line line, std::uint32_t rank, std::uint32_t met) {
        Stamps& last = last_.of(line);
        const std::int32_t before = last.all, now = static_cast<std::int32_t>(next_ + rank);
        last.all = now;
        std::int32_t distance = last_stamp;
        if (before == never_touched) {
            if constexpr (counted) ++counts_.compulsory;
        } else if (distances_) {
            const auto stamp = static_cast<std::uint32_t>(before);
            distance = static_cast<std::int32_t>(bits_.above(stamp, next_ - 1) + met);
            bits_.clear(stamp);
            if constexpr (counted) {
                const auto d = static_cast<std::size_t>(distance);
                if (d >= counts_.by_distance.size()) counts_.by_distance.resize(2 * (d + 512));
                ++counts_.by_distance[d];
            }
        }
        if (!all_.empty()) {
            if (all_.full()) all_.flush();
            all_.push(line, before, now, distance, counted);
        }
        if (!newest_.empty()) filter(line, last, now, distance, counted);
    }

    /// touch() for `count` touches of a walk from the `first`-th on, in steps that each run through a few
    /// arrays.
    void touch_low(std::span<const Line> lines, std::span<const std::uint32_t> last_rank, std::uint32_t first,
                   std::uint32_t count) {
        Stamps* const last = last_.table();
        const auto base = static_cast<std::int32_t>(next_);
        all_.make_room(count);
        const Batch::Places to = all_.append(count);
        const Line* const line = lines.data() + first;
        const std::uint32_t* const rank = last_rank.data() + first;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto number = static_cast<std::uint64_t>(line[i]);
            to.line[i] = static_cast<std::uint32_t>(number << 6);
            to.before[i] = last[number].all;
            to.now[i] = last[number].all = base + static_cast<std::int32_t>(rank[i]);
        }
        if (distances_) {
            std::uint64_t fresh = 0;
            for (std::uint32_t i = 0; i < count; ++i) {
                if (i + ahead < count) bits_.prefetch(static_cast<std::uint32_t>(to.before[i + ahead]));
                if (to.before[i] == never_touched) {
                    to.distance[i] = last_stamp;
                    ++fresh;
                    continue;
                }
                const auto stamp = static_cast<std::uint32_t>(to.before[i]);
                const std::uint32_t distance = bits_.above(stamp, next_ - 1) + first + i;
                bits_.clear(stamp);
                to.distance[i] = static_cast<std::int32_t>(distance);
                if (distance >= counts_.by_distance.size())
                    counts_.by_distance.resize(2 * (std::size_t{distance} + 512));
                ++counts_.by_distance[distance];
            }
            counts_.compulsory += fresh;
        } else {
            for (std::uint32_t i = 0; i < count; ++i)
                counts_.compulsory += to.before[i] == never_touched ? 1 : 0;
        }
        if (!newest_.empty())
            for (std::uint32_t i = 0; i < count; ++i)
                filter(line[i], last[static_cast<std::uint64_t>(line[i])], to.now[i], to.distance[i], true);
        if (all_.empty()) all_.flush();
    }

    void filter(Line line, Stamps& last, std::int32_t now, std::int32_t distance, bool counted) {
        Newest& newest = newest_[static_cast<std::uint64_t>(line) & (newest_.size() - 1)];
        if (newest.line == line) {
            newest.walk = walk_;
            newest.now = now;
            newest.left_out = true;
            return;
        }
        pass(line, last, now, distance, counted);
        const bool of_this_walk = newest.walk == walk_;
        if (of_this_walk && newest.left_out) {
            // Another line came in between: which of the two is the newer one shows in their stamps.
            pass(newest.line, last_.of(newest.line), newest.now, 0, false);
            newest.left_out = false;
        }
        if (!of_this_walk || now > newest.now) newest = {line, walk_, now, false};
    }

    void pass(Line line, Stamps& last, std::int32_t now, std::int32_t distance, bool counted) {
        if (filtered_.full()) filtered_.flush();
        filtered_.push(line, last.filtered, now, distance, counted);
        last.filtered = now;
    }

    void end_walk(std::uint32_t lines) {
        if (distances_) bits_.set_range(next_, lines);
        next_ += lines;
        ++walk_;
    }

    /// Makes room for `count` stamps from next_ on: numbers those in use anew, in their order.
    void renumber(std::size_t count) {
        all_.flush();
        filtered_.flush();
        bits_.reset();
        std::uint32_t in_use = 0, lines = 0;
        last_.for_each([&](Stamps& stamps) {
            if (stamps.all == never_touched) return;
            ++lines;
            bits_.set(static_cast<std::uint32_t>(stamps.all));
            ++in_use;
            if (stamps.filtered == never_touched || stamps.filtered == stamps.all) return;
            bits_.set(static_cast<std::uint32_t>(stamps.filtered));
            ++in_use;
        });
        const StampBits::Ranks ranks(bits_);
        const auto renumbered = [&](std::int32_t stamp) {
            return first_stamp + static_cast<std::int32_t>(ranks.below(static_cast<std::uint32_t>(stamp)));
        };
        last_.for_each([&](Stamps& stamps) {
            if (stamps.all != never_touched) stamps.all = renumbered(stamps.all);
            if (stamps.filtered != never_touched) stamps.filtered = renumbered(stamps.filtered);
        });
        all_.renumber(renumbered);
        filtered_.renumber(renumbered);
        const std::uint64_t wanted = 2 * (std::uint64_t{in_use} + count + first_stamp);
        if (wanted > max_stamps)
            throw std::length_error(fmt::format("found {} different lines, expected fewer", lines));
        if (wanted > bits_.capacity())
            bits_ = StampBits(wanted);
        else
            bits_.reset();
        next_ = first_stamp + in_use;
        last_.for_each([&](Stamps& stamps) {
            if (distances_ && stamps.all != never_touched) bits_.set(static_cast<std::uint32_t>(stamps.all));
        });
    }

    bool distances_;
    LineStamps last_;
    StampBits bits_;  // the lines' last stamps in all_
    std::uint32_t next_ = first_stamp;
    std::uint64_t walk_ = 1;
    std::vector<Newest> newest_;
    FamilyCounts counts_;
    Batch all_, filtered_;
};

LruFamily::LruFamily(const FamilyConfig& config) : engine_(std::make_unique<Engine>(config)) {}
LruFamily::~LruFamily() = default;
LruFamily::LruFamily(LruFamily&&) noexcept = default;
LruFamily& LruFamily::operator=(LruFamily&&) noexcept = default;

void LruFamily::access(std::span<const Line> lines) {
    engine_->access(lines);
}
void LruFamily::access_first(std::span<const Line> lines, std::span<const std::uint32_t> last_rank) {
    engine_->access_first(lines, last_rank);
}
void LruFamily::revisit(std::span<const Line> lines) {
    engine_->revisit(lines);
}
const FamilyCounts& LruFamily::counts() {
    return engine_->counts();
}

}  // namespace regather::cachesim
