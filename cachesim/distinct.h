// cachesim/distinct.h -- counts different lines: times the line size this is the compulsory traffic, which no
// order of the same accesses can go below. A bitmap for low line numbers, a hash table above.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/line_ids.h"

namespace regather::cachesim {

class DistinctLines {
public:
    void add(std::span<const Line> lines);
    std::uint64_t count() const { return low_count_ + high_.size(); }

private:
    std::vector<std::uint64_t> low_;  // one bit a line, as long as the largest low line needs
    std::uint64_t low_count_ = 0;
    LineIds high_;
};

}  // namespace regather::cachesim
