#include "cachesim/policies/policy_cache.h"

#include <Random123/philox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "cachesim/line_chains.h"
#include "cachesim/recency_list.h"
#include "trace/error.h"

namespace regather::cachesim {

namespace {

constexpr std::uint32_t none = no_entry;
constexpr std::uint64_t max_searched_ways = 32;
constexpr std::uint8_t distant = 3, long_ahead = 2, near = 0;  // re-reference predictions of srrip

/// What is known of a slot in one byte; 0 is empty.
std::uint8_t packed(bool dirty, trace::Region region) {
    return static_cast<std::uint8_t>(2 + 2 * static_cast<unsigned>(region) + (dirty ? 1 : 0));
}
bool is_dirty(std::uint8_t state) {
    return (state & 1) != 0;
}
trace::Region region_of(std::uint8_t state) {
    return static_cast<trace::Region>((state >> 1) - 1);
}

}  // namespace

/// A slot is set x ways + way.
class PolicyCache::Sets {
public:
    explicit Sets(const PolicyConfig& config)
        : policy_(config.policy),
          seed_(config.seed),
          ways_(static_cast<std::uint32_t>(config.ways())),
          index_(config),
          lines_(config.sets() * ways_),
          states_(lines_.size(), 0),
          used_(config.sets(), 0),
          first_empty_(config.sets(), 0) {
        if (ways_ > max_searched_ways) slots_.resize(lines_.size());
        forget();
    }

    std::uint64_t set(Line line) const { return index_(line); }
    std::size_t slots() const { return lines_.size(); }
    std::uint8_t& state(std::uint32_t slot) { return states_[slot]; }
    std::optional<Resident> at(std::uint32_t slot) const {
        const std::uint8_t state = states_[slot];
        if (state == 0) return {};
        return Resident{Line{lines_[slot]}, is_dirty(state), region_of(state)};
    }

    std::uint32_t find(Line line) const {
        const auto number = static_cast<std::uint64_t>(line);
        if (ways_ > max_searched_ways)
            return slots_.find(number, [&](std::uint32_t slot) { return lines_[slot]; });
        const auto first = static_cast<std::uint32_t>(set(line) * ways_);
        for (std::uint32_t slot = first; slot < first + ways_; ++slot)
            if (lines_[slot] == number && states_[slot] != 0) return slot;
        return none;
    }

    /// A hit.
    void use(std::uint32_t slot) {
        switch (policy_) {
            case Policy::lru:
                order_[slot / ways_].renew(links_, slot);
                break;
            case Policy::plru:
                point_away(slot);
                break;
            case Policy::srrip:
                predictions_[slot] = near;
                break;
            default:
                break;
        }
    }

    bool full(std::uint64_t set) const { return used_[set] == ways_; }

    /// Of a full set.
    std::uint32_t victim(std::uint64_t set) const {
        const auto first = static_cast<std::uint32_t>(set * ways_);
        switch (policy_) {
            case Policy::plru: {
                std::uint32_t node = 1;
                while (node < ways_) node = 2 * node + tree_[first + node];
                return first + node - ways_;
            }
            case Policy::srrip: {
                const std::uint8_t* const begin = &predictions_[first];
                if (const void* const found = std::memchr(begin, distant, ways_))
                    return first +
                           static_cast<std::uint32_t>(static_cast<const std::uint8_t*>(found) - begin);
                return first + static_cast<std::uint32_t>(std::max_element(begin, begin + ways_) - begin);
            }
            case Policy::random: {
                using Philox = r123::Philox4x32;
                const auto word = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
                const auto drawn = Philox()(Philox::ctr_type{{word(draws_), word(draws_ >> 32), 0, 0}},
                                            Philox::key_type{{word(seed_), word(seed_ >> 32)}});
                const std::uint64_t wide = std::uint64_t{drawn[1]} << 32 | drawn[0];
                return first + static_cast<std::uint32_t>(static_cast<unsigned __int128>(wide) * ways_ >> 64);
            }
            default:
                return order_[set].oldest;
        }
    }

    /// Takes the victim out to make room for a line.
    void evict(std::uint32_t slot) {
        if (policy_ == Policy::random) ++draws_;
        if (policy_ == Policy::srrip) {
            std::uint8_t* const begin = &predictions_[slot - slot % ways_];
            const auto years = static_cast<std::uint8_t>(distant - predictions_[slot]);
            if (years != 0)
                std::for_each(begin, begin + ways_,
                              [&](auto& p) { p = static_cast<std::uint8_t>(p + years); });
        }
        clear(slot);
    }

    /// Empties a slot.
    void clear(std::uint32_t slot) {
        const std::uint64_t set = slot / ways_;
        if (!order_.empty()) order_[set].leave(links_, slot);
        if (ways_ > max_searched_ways) slots_.erase(lines_[slot], slot);
        states_[slot] = 0;
        --used_[set];
        first_empty_[set] = std::min(first_empty_[set], static_cast<std::uint32_t>(slot % ways_));
    }

    /// Into the lowest empty way of a set that is not full.
    std::uint32_t fill(Line line, std::uint8_t state) {
        const std::uint64_t set = index_(line);
        std::uint32_t slot = static_cast<std::uint32_t>(set * ways_) + first_empty_[set];
        while (states_[slot] != 0) ++slot;
        first_empty_[set] = slot % ways_ + 1;
        ++used_[set];
        lines_[slot] = static_cast<std::uint64_t>(line);
        states_[slot] = state;
        if (ways_ > max_searched_ways) slots_.enter(lines_[slot], slot);
        if (!order_.empty()) order_[set].enter(links_, slot);
        if (policy_ == Policy::plru) point_away(slot);
        if (policy_ == Policy::srrip) predictions_[slot] = long_ahead;
        return slot;
    }

    /// Everything, as it was at the start; random goes on drawing.
    void forget() {
        std::fill(states_.begin(), states_.end(), std::uint8_t{0});
        std::fill(used_.begin(), used_.end(), 0u);
        std::fill(first_empty_.begin(), first_empty_.end(), 0u);
        slots_.clear();
        if (policy_ == Policy::lru || policy_ == Policy::fifo) {
            order_.assign(used_.size(), {});
            links_.assign(lines_.size(), {});
        }
        if (policy_ == Policy::plru) tree_.assign(lines_.size(), 0);
        if (policy_ == Policy::srrip) predictions_.assign(lines_.size(), distant);
    }

private:
    /// Node n of a set's tree has the children 2n and 2n + 1; leaf ways + w is way w. A bit says which half
    /// is next to go.
    void point_away(std::uint32_t slot) {
        const std::uint32_t way = slot % ways_, first = slot - way;
        for (std::uint32_t node = ways_ + way; node > 1; node /= 2)
            tree_[first + node / 2] = static_cast<std::uint8_t>(1 - node % 2);
    }

    Policy policy_;
    std::uint64_t seed_, draws_ = 0;
    std::uint32_t ways_;
    SetOfLine index_;
    std::vector<std::uint64_t> lines_;
    std::vector<std::uint8_t> states_;
    std::vector<std::uint32_t> used_, first_empty_;  // by set; no way below first_empty_ is empty
    LineChains slots_;                               // of more ways than are searched
    std::vector<RecencyList> order_;                 // of a set, by use (lru) or by fetch (fifo)
    std::vector<Links> links_;
    std::vector<std::uint8_t> tree_, predictions_;  // plru; srrip
};

namespace {

const PolicyConfig& checked(const PolicyConfig& config) {
    check(config);
    if (config.policy == Policy::opt)
        throw trace::UsageError("policy: found opt, which needs the whole trace first, expected another");
    return config;
}

}  // namespace

PolicyCache::PolicyCache(const PolicyConfig& config)
    : config_(checked(config)), sets_(std::make_unique<Sets>(config)) {}
PolicyCache::~PolicyCache() = default;
PolicyCache::PolicyCache(PolicyCache&&) noexcept = default;
PolicyCache& PolicyCache::operator=(PolicyCache&&) noexcept = default;

PolicyCache::Placed PolicyCache::place(Line line, bool dirty, trace::Region region) {
    Placed placed{};
    if (const std::uint64_t set = sets_->set(line); sets_->full(set)) {
        const std::uint32_t slot = sets_->victim(set);
        placed.evicted = sets_->at(slot);
        sets_->evict(slot);
    }
    placed.slot = sets_->fill(line, packed(dirty, region));
    return placed;
}

void PolicyCache::use_at(std::size_t slot) {
    sets_->use(static_cast<std::uint32_t>(slot));
}

void PolicyCache::remove_at(std::size_t slot) {
    sets_->clear(static_cast<std::uint32_t>(slot));
}

void PolicyCache::clear() {
    sets_->forget();
}

std::size_t PolicyCache::slot(Line line) const {
    const std::uint32_t slot = sets_->find(line);
    return slot == none ? nowhere : slot;
}

std::optional<Resident> PolicyCache::at(std::size_t slot) const {
    return sets_->at(static_cast<std::uint32_t>(slot));
}

PolicyCache::Outcome PolicyCache::access(Line line, Access kind, trace::Region region, std::uint32_t bytes) {
    PolicyStats& mine = stats_[static_cast<std::size_t>(region)];
    const bool writes = kind == Access::write, through = writes && config_.write == WritePolicy::through;
    const std::uint32_t slot = sets_->find(line);
    const bool hit = slot != none;
    if (hit) sets_->use(slot);
    if (hit && writes && !through) sets_->state(slot) = packed(true, region);
    const bool fetches = !hit && !(writes && config_.write_miss == WriteMiss::no_allocate);
    ++mine.accesses;
    mine.misses += !hit;
    mine.fetches += fetches;
    if (through || (!hit && !fetches)) {
        ++mine.passed_writes;
        mine.passed_bytes += bytes;
    }
    Outcome outcome{hit, {}};
    if (fetches) outcome.evicted = place(line, writes && !through, region).evicted;
    if (outcome.evicted && outcome.evicted->dirty)
        ++stats_[static_cast<std::size_t>(outcome.evicted->region)].writebacks;
    return outcome;
}

void PolicyCache::flush() {
    for (std::uint32_t slot = 0; slot < sets_->slots(); ++slot)
        if (const std::optional<Resident> held = sets_->at(slot); held && held->dirty)
            ++stats_[static_cast<std::size_t>(held->region)].writebacks;
    clear();
}

PolicyStats PolicyCache::total() const {
    PolicyStats sum;
    for (const PolicyStats& region : stats_) sum += region;
    return sum;
}

}  // namespace regather::cachesim
