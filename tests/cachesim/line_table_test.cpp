// The table of lines against a map, while lines come and go; the list of entries against a std::list.
#include "cachesim/line_table.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <list>
#include <map>

#include "cachesim/recency_list.h"
#include "tests/cachesim/brute_force.h"

namespace regather::cachesim {
namespace {

/// Holds the table against the map, for lines that are in it and for as many that are not.
void expect_equal(LineTable<LineNumber>& table, const std::map<std::uint64_t, std::uint32_t>& map) {
    RC_ASSERT(table.size() == map.size());
    for (const auto& [line, number] : map) {
        RC_ASSERT(table.find(line) != nullptr);
        RC_ASSERT(table.find(line)->number == number);
        RC_ASSERT(map.contains(line + 1) || table.find(line + 1) == nullptr);
    }
    std::vector<std::uint32_t> found, expected;
    table.for_each([&](const LineNumber& value) { found.push_back(value.number); });
    for (const auto& [line, number] : map) expected.push_back(number);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    RC_ASSERT(found == expected);
}

TEST(LineTable, EqualsAMapWhileLinesComeAndGo) {
    ASSERT_TRUE(rc::check([] {
        Scatter scatter(*rc::gen::arbitrary<std::uint64_t>());
        // Multiples of 2^58 begin in few places of the table: long runs, over its end, too.
        const int shift = *rc::gen::element(0, 0, 3, 40, 58);
        const std::uint64_t universe = *rc::gen::element<std::uint64_t>(8, 39, 60, 3000);
        LineTable<LineNumber> table;
        std::map<std::uint64_t, std::uint32_t> map;
        const int steps = universe == 3000 ? 5000 : 600;
        for (int step = 0; step < steps; ++step) {
            const std::uint64_t line = scatter.below(universe) << shift;
            if (map.contains(line) && scatter.below(2) == 0) {
                table.erase(line);
                map.erase(line);
            } else {
                LineNumber& value = table.enter(line);
                RC_ASSERT(value.free() == !map.contains(line));
                value.number = map[line] = static_cast<std::uint32_t>(step);
            }
            if (step % 50 == 0) expect_equal(table, map);
        }
        expect_equal(table, map);
        table.clear();
        expect_equal(table, {});
    }));
}

TEST(RecencyList, EqualsAList) {
    ASSERT_TRUE(rc::check([] {
        Scatter scatter(*rc::gen::arbitrary<std::uint64_t>());
        std::vector<Links> entries(9);
        RecencyList list;
        std::list<std::uint32_t> expected;  // newest first
        for (int step = 0; step < 200; ++step) {
            const auto at = static_cast<std::uint32_t>(scatter.below(entries.size()));
            const auto found = std::find(expected.begin(), expected.end(), at);
            if (found == expected.end()) {
                list.enter(entries, at);
                expected.push_front(at);
            } else if (scatter.below(2) == 0) {
                list.leave(entries, at);
                expected.erase(found);
            } else {
                list.renew(entries, at);
                expected.splice(expected.begin(), expected, found);
            }
            std::list<std::uint32_t> down, up;
            for (std::uint32_t e = list.newest; e != no_entry; e = entries[e].older) down.push_back(e);
            for (std::uint32_t e = list.oldest; e != no_entry; e = entries[e].newer) up.push_front(e);
            RC_ASSERT(down == expected);
            RC_ASSERT(up == expected);
        }
    }));
}

}  // namespace
}  // namespace regather::cachesim
