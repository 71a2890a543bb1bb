#include "cachesim/attributed_cache.h"

#include <algorithm>
#include <bit>

namespace regather::cachesim {
namespace {

CacheConfig checked(const CacheConfig& config) {
    check(config);
    return config;
}

std::uint64_t lines_of(const CacheConfig& config) {
    return config.size_bytes / config.line_bytes;
}

}  // namespace

ClassStats& ClassStats::operator+=(const ClassStats& other) {
    MissClasses::operator+=(other);
    accesses += other.accesses;
    misses += other.misses;
    writebacks += other.writebacks;
    used_bytes += other.used_bytes;
    return *this;
}

AttributedCache::AttributedCache(const CacheConfig& config, std::uint32_t classes)
    : config_(checked(config)),
      shift_(std::countr_zero(config.line_bytes)),
      ways_(config.ways == fully_associative ? lines_of(config) : config.ways),
      words_((config.line_bytes + 63) / 64),
      stats_(classes),
      full_(std::vector<std::uint64_t>{lines_of(config)}),
      sets_(config.sets()) {}

void AttributedCache::access(const ByteAccess& bytes, std::uint32_t by) {
    const std::uint32_t last_byte = config_.line_bytes - 1;
    const std::uint64_t end = bytes.address + (bytes.bytes - 1);
    for_each_line(bytes.address, bytes.bytes, config_.line_bytes, [&](Line touched) {
        const auto line = static_cast<std::uint64_t>(touched);
        const std::uint32_t first =
            line == bytes.address >> shift_ ? static_cast<std::uint32_t>(bytes.address) & last_byte : 0;
        const std::uint32_t last =
            line == end >> shift_ ? static_cast<std::uint32_t>(end) & last_byte : last_byte;
        access_line(line, first, last, bytes.kind, by);
    });
}

void AttributedCache::access_line(std::uint64_t line, std::uint32_t first, std::uint32_t last, Access kind,
                                  std::uint32_t by) {
    ClassStats& mine = stats_[by];
    ++mine.accesses;
    std::uint32_t slot = last_slot_;
    if (slot == none || line != last_line_) {  // else it is the newest everywhere
        const std::uint32_t id = ids_(Line{line});
        if (id == slot_of_.size()) slot_of_.push_back(none);
        const std::uint32_t missing = full_.access(id);
        Set& set = sets_[line & (sets_.size() - 1)];
        slot = slot_of_[id];
        if (slot == none) {
            ++mine.misses;
            mine.count(missing, 0);
            slot = fetch(id, set, by);
        } else {
            set.renew(slots_, slot);
        }
        last_line_ = line;
        last_slot_ = slot;
    }
    mark(slot, first, last);
    if (kind == Access::write) slots_[slot].dirty_by = by;
}

void AttributedCache::flush() {
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) settle(slot);
    slots_.clear();
    std::fill(sets_.begin(), sets_.end(), Set{});
    std::fill(slot_of_.begin(), slot_of_.end(), none);
    used_.clear();
    last_slot_ = none;
}

ClassStats AttributedCache::total() const {
    ClassStats sum;
    for (const ClassStats& one : stats_) sum += one;
    return sum;
}

/// A slot for a line that is not held: the set's oldest if the set is full.
std::uint32_t AttributedCache::fetch(std::uint32_t id, Set& set, std::uint32_t by) {
    std::uint32_t slot;
    if (set.used == ways_) {
        slot = set.oldest;
        settle(slot);
        set.leave(slots_, slot);
        slot_of_[slots_[slot].id] = none;
        std::fill_n(used_.begin() + std::ptrdiff_t{slot} * words_, words_, 0);
    } else {
        ++set.used;
        slot = static_cast<std::uint32_t>(slots_.size());
        slots_.emplace_back();
        used_.resize(used_.size() + words_);
    }
    slots_[slot].id = id;
    slots_[slot].fetched_by = by;
    slots_[slot].dirty_by = none;
    slot_of_[id] = slot;
    set.enter(slots_, slot);
    return slot;
}

/// Counts what is known when a line goes.
void AttributedCache::settle(std::uint32_t slot) {
    const Slot& gone = slots_[slot];
    std::uint64_t bytes = 0;
    for (std::uint64_t word = std::uint64_t{slot} * words_; word < std::uint64_t{slot + 1} * words_; ++word)
        bytes += static_cast<std::uint64_t>(std::popcount(used_[word]));
    stats_[gone.fetched_by].used_bytes += bytes;
    if (gone.dirty_by != none) ++stats_[gone.dirty_by].writebacks;
}

/// Bytes first to last of the line.
void AttributedCache::mark(std::uint32_t slot, std::uint32_t first, std::uint32_t last) {
    std::uint64_t* const words = used_.data() + std::uint64_t{slot} * words_;
    constexpr std::uint64_t all = ~std::uint64_t{0};
    const std::uint64_t from = all << first % 64, to = all >> (63 - last % 64);
    if (first / 64 == last / 64) {
        words[first / 64] |= from & to;
        return;
    }
    words[first / 64] |= from;
    for (std::uint32_t word = first / 64 + 1; word < last / 64; ++word) words[word] = all;
    words[last / 64] |= to;
}

}  // namespace regather::cachesim
