// cachesim/line_chains.h -- which entry of an array holds a line, while lines come and go: a hash table of
// chains through the array, as long as the array at least. What else is known of a line is the owner's.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/recency_list.h"

namespace regather::cachesim {

class LineChains {
public:
    /// Room for entries 0 .. entries - 1, none of which is entered.
    void resize(std::size_t entries) {
        next_.assign(entries, no_entry);
        first_.assign(std::bit_ceil(std::max<std::size_t>(entries, 2)), no_entry);
        shift_ = 64 - std::countr_zero(first_.size());
    }
    std::size_t entries() const { return next_.size(); }

    /// The entry that was entered for the line, or no_entry; `line_of(entry)` is the line that an entry
    /// holds.
    template <class LineOf>
    std::uint32_t find(std::uint64_t line, const LineOf& line_of) const {
        std::uint32_t at = first_[chain_of(line)];
        while (at != no_entry && line_of(at) != line) at = next_[at];
        return at;
    }
    void enter(std::uint64_t line, std::uint32_t at) {
        std::uint32_t& first = first_[chain_of(line)];
        next_[at] = first;
        first = at;
    }
    /// Entry `at` had been entered for the line.
    void erase(std::uint64_t line, std::uint32_t at) {
        std::uint32_t* link = &first_[chain_of(line)];
        while (*link != at) link = &next_[*link];
        *link = next_[at];
    }
    void clear() { std::fill(first_.begin(), first_.end(), no_entry); }

private:
    std::size_t chain_of(std::uint64_t line) const { return line * 0x9e3779b97f4a7c15 >> shift_; }

    std::vector<std::uint32_t> first_, next_;  // by chain; by entry
    int shift_ = 0;
};

}  // namespace regather::cachesim
