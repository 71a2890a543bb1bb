// The tables of lines against maps, the list of entries against a std::list.
#include "cachesim/line_table.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <list>
#include <map>
#include <numeric>

#include "cachesim/line_chains.h"
#include "cachesim/recency_list.h"
#include "tests/cachesim/brute_force.h"

namespace regather::cachesim {
namespace {

struct Number {
    std::uint32_t number = 0;
    bool free() const { return number == 0; }
};

/// Lines from a few places: multiples of 2^58 begin in few places of the tables, so that runs and chains are
/// long.
std::uint64_t any_line(Scatter& scatter, std::uint64_t universe, int shift) {
    return scatter.below(universe) << shift;
}

TEST(LineTable, EqualsAMap) {
    ASSERT_TRUE(rc::check([] {
        Scatter scatter(*rc::gen::arbitrary<std::uint64_t>());
        const int shift = *rc::gen::element(0, 0, 3, 40, 58);
        const std::uint64_t universe = *rc::gen::element<std::uint64_t>(8, 39, 60, 3000);
        LineTable<Number> table;
        std::map<std::uint64_t, std::uint32_t> map;
        for (std::uint32_t step = 1; step < 3000; ++step) {
            const std::uint64_t line = any_line(scatter, universe, shift);
            Number& value = table.enter(line);
            RC_ASSERT(value.free() == !map.contains(line));
            RC_ASSERT(value.free() || value.number == map[line]);
            value.number = map[line] = step;
            RC_ASSERT(table.size() == map.size());
        }
        std::vector<std::uint32_t> found, expected;
        table.for_each([&](const Number& value) { found.push_back(value.number); });
        for (const auto& [line, number] : map) expected.push_back(number);
        std::sort(found.begin(), found.end());
        std::sort(expected.begin(), expected.end());
        RC_ASSERT(found == expected);
    }));
}

TEST(LineChains, EqualAMapWhileLinesComeAndGo) {
    ASSERT_TRUE(rc::check([] {
        Scatter scatter(*rc::gen::arbitrary<std::uint64_t>());
        const int shift = *rc::gen::element(0, 3, 40, 58);
        const std::uint64_t universe = *rc::gen::element<std::uint64_t>(3, 8, 60);
        std::vector<std::uint64_t> lines(universe);
        std::vector<std::uint32_t> empty(universe);
        std::iota(empty.begin(), empty.end(), 0u);
        LineChains chains;
        chains.resize(universe);
        std::map<std::uint64_t, std::uint32_t> map;
        const auto find = [&](std::uint64_t line) {
            return chains.find(line, [&](std::uint32_t at) { return lines[at]; });
        };
        for (int step = 0; step < 500; ++step) {
            const std::uint64_t line = any_line(scatter, universe, shift);
            const auto found = map.find(line);
            RC_ASSERT(find(line) == (found == map.end() ? no_entry : found->second));
            if (found == map.end()) {
                std::swap(empty[scatter.below(empty.size())], empty.back());
                lines[empty.back()] = line;
                chains.enter(line, empty.back());
                map[line] = empty.back();
                empty.pop_back();
            } else if (scatter.below(2) == 0) {
                chains.erase(line, found->second);
                empty.push_back(found->second);
                map.erase(found);
            }
        }
        for (const auto& [line, at] : map) RC_ASSERT(find(line) == at);
        chains.clear();
        for (const auto& [line, at] : map) RC_ASSERT(find(line) == no_entry);
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
