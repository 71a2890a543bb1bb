// cachesim/miss_class.h -- why an access missed, access by access, after Hill ("Aspects of Cache Memory and
// Instruction Buffer Performance", 1987; Hill and Smith 1989): compulsory when it is the first touch of its
// line; else capacity when a fully associative LRU cache of the same size misses too; else conflict. The
// caches of reference allocate on every miss.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/recency_list.h"

namespace regather::cachesim {

struct MissClasses {
    std::uint64_t compulsory = 0, capacity = 0, conflict = 0;

    /// One miss: `missing` as FullLru::access() gave it, `rank` of the cache among the sizes of that FullLru.
    void count(std::uint32_t missing, std::uint32_t rank);
    MissClasses& operator+=(const MissClasses& other);
    friend bool operator==(const MissClasses&, const MissClasses&) = default;
};

/// The fully associative LRU caches of many sizes over one stream, as one list of lines in order of use with
/// a mark at the end of each cache (inclusion: Mattson et al. 1970). An access costs as many steps as caches
/// miss.
class FullLru {
public:
    /// Capacities in lines, ascending and different, from 1 up.
    explicit FullLru(std::span<const std::uint64_t> capacities);

    static constexpr std::uint32_t first_touch = ~std::uint32_t{0};
    /// The number of caches that miss, which are the smallest ones; first_touch if `id` (line_ids.h) had
    /// never been accessed.
    std::uint32_t access(std::uint32_t id);

private:
    struct Node : Links {
        std::uint32_t missing = 0;  // how many caches do not hold it
    };
    void push_down(std::uint32_t caches);

    std::vector<std::uint64_t> capacities_;
    std::vector<std::uint32_t> last_;  // the line that goes next from each full cache
    std::vector<Node> nodes_;          // by id
    RecencyList order_;
};

}  // namespace regather::cachesim
