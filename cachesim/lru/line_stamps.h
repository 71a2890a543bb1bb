// cachesim/lru/line_stamps.h -- the time stamps of each line's last touch: an array for low line numbers, a
// hash table above.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/line_table.h"

namespace regather::cachesim {

/// Of the line's last touch among all, and among those that a filter let through. 0: none.
struct Stamps {
    std::int32_t all = 0, filtered = 0;
    bool free() const { return all == 0; }
};

class LineStamps {
public:
    /// To be changed in place, `all` to something else than 0. Valid until the next call.
    Stamps& of(Line line) {
        const auto number = static_cast<std::uint64_t>(line);
        if (number < low_.size()) return low_[number];
        return number < low_lines ? grown(number) : hashed(number);
    }
    /// Whether all of them are in the table, which this makes large enough when they can be.
    bool low(std::span<const Line> lines) {
        std::uint64_t greatest = 0;
        for (const Line line : lines) greatest = std::max(greatest, static_cast<std::uint64_t>(line));
        if (greatest >= low_.size() && greatest < low_lines) grown(greatest);
        return greatest < low_.size();
    }
    /// By line number, for low ones; valid until a line that was not low comes.
    Stamps* table() { return low_.data(); }
    void prefetch(Line line) const {
        const auto number = static_cast<std::uint64_t>(line);
        if (number < low_.size()) __builtin_prefetch(&low_[number]);
    }
    /// Calls each(Stamps&) for every line.
    template <class Each>
    void for_each(Each&& each) {
        for (Stamps& stamps : low_) each(stamps);
        high_.for_each(each);
    }

private:
    static constexpr std::uint64_t low_lines = std::uint64_t{1} << 24;
    Stamps& grown(std::uint64_t line);
    Stamps& hashed(std::uint64_t line);

    std::vector<Stamps> low_;
    LineTable<Stamps> high_;
};

}  // namespace regather::cachesim
