#include "cachesim/policies/policy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "trace/error.h"

namespace regather::cachesim {
namespace {

using testing::HasSubstr;

std::string refusal(const PolicyConfig& config) {
    try {
        check(config);
    } catch (const trace::UsageError& error) {
        return error.what();
    }
    return "accepted";
}

std::vector<std::uint64_t> sets_of(const PolicyConfig& config, const std::vector<std::uint64_t>& lines) {
    const SetOfLine index(config);
    std::vector<std::uint64_t> sets;
    for (const std::uint64_t line : lines) sets.push_back(index(Line{line}));
    return sets;
}

TEST(Policy, NamesAreReadBack) {
    for (std::size_t i = 0; i < policy_names.size(); ++i)
        EXPECT_EQ(name_of(parse_policy(policy_names[i])), policy_names[i]);
    EXPECT_EQ(parse_policy("srrip"), Policy::srrip);
    EXPECT_EQ(parse_write_policy("through"), WritePolicy::through);
    EXPECT_EQ(parse_write_miss("no-allocate"), WriteMiss::no_allocate);
    EXPECT_EQ(parse_set_index("hashed"), SetIndex::hashed);
}

TEST(Policy, AnUnknownNameIsAnsweredWithTheKnownOnes) {
    try {
        parse_policy("mru");
        FAIL();
    } catch (const trace::UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "policy: found 'mru', expected one of: lru, fifo, plru, srrip, random, opt");
    }
}

TEST(Policy, SetsMayBeAnyNumberButWhole) {
    EXPECT_EQ(refusal({{12 * 64, 64, 2}}), "accepted");  // 6 sets
    EXPECT_EQ(refusal({{13 * 64, 64, 1}}), "accepted");
    EXPECT_THAT(refusal({{13 * 64, 64, 2}}), HasSubstr("ways: found 2 ways of 13 lines"));
    EXPECT_THAT(refusal({{1000, 64, 1}}), HasSubstr("size_bytes: found 1000"));
    EXPECT_THAT(refusal({{0, 64, 1}}), HasSubstr("size_bytes: found 0"));
    EXPECT_THAT(refusal({{4096, 48, 1}}), HasSubstr("line_bytes: found 48"));
    EXPECT_THAT(refusal({{64, 128, 1}}), HasSubstr("size_bytes: found 64"));
    EXPECT_THAT(refusal({{512, 64, 16}}), HasSubstr("ways: found 16 ways of 8 lines"));
}

TEST(Policy, WhatAPolicyCannotDoIsRefused) {
    EXPECT_EQ(refusal({{8 * 64, 64, 4}, Policy::plru}), "accepted");
    EXPECT_THAT(refusal({{6 * 64, 64, 3}, Policy::plru}), HasSubstr("found 3 ways with policy plru"));
    EXPECT_THAT(refusal({{6 * 64, 64, fully_associative}, Policy::plru}), HasSubstr("found 6 ways"));
    PolicyConfig config{{6 * 64, 64, 1}};
    config.index = SetIndex::hashed;
    EXPECT_THAT(refusal(config), HasSubstr("index: found hashed with 6 sets"));
    config = {{8 * 64, 64, 1}, Policy::opt};
    config.write_miss = WriteMiss::no_allocate;
    EXPECT_THAT(refusal(config), HasSubstr("write_miss: found no-allocate with policy opt"));
}

TEST(SetOfLine, TakesTheLineModuloTheSets) {
    const std::vector<std::uint64_t> lines{0, 1, 15, 16, ~std::uint64_t{0}};
    EXPECT_THAT(sets_of({{16 * 64, 64, 1}}, lines), testing::ElementsAre(0, 1, 15, 0, 15));
    EXPECT_THAT(sets_of({{12 * 64, 64, 1}}, lines),
                testing::ElementsAre(0, 1, 3, 4, 3));  // 2^64 - 1 = 3 mod 12
    EXPECT_THAT(sets_of({{12 * 64, 64, fully_associative}}, lines), testing::ElementsAre(0, 0, 0, 0, 0));
}

TEST(SetOfLine, HashedXorsAllDigitsOfTheLine) {
    PolicyConfig config{{16 * 64, 64, 1}};  // 16 sets: hexadecimal digits
    config.index = SetIndex::hashed;
    EXPECT_THAT(sets_of(config, {0x5, 0x35, 0x123, 0xf0f1, 0x8000'0000'0000'0001}),
                testing::ElementsAre(0x5, 0x3 ^ 0x5, 0x1 ^ 0x2 ^ 0x3, 0x1, 0x8 ^ 0x1));
    config.geometry = {64, 64, 1};
    EXPECT_THAT(sets_of(config, {0, 1, ~std::uint64_t{0}}), testing::ElementsAre(0, 0, 0));
}

TEST(SetOfLine, HashedSpreadsNeighboursAndStridesOverAllSets) {
    PolicyConfig config{{64 * 64, 64, 1}};
    config.index = SetIndex::hashed;
    const SetOfLine index(config);
    for (const std::uint64_t stride : {1, 64, 4096})
        for (const std::uint64_t block : {0, 5, 77}) {
            std::set<std::uint64_t> used;
            for (std::uint64_t i = 0; i < 64; ++i) used.insert(index(Line{block * 64 * stride + i * stride}));
            EXPECT_EQ(used.size(), 64u) << "stride " << stride << ", block " << block;
        }
}

}  // namespace
}  // namespace regather::cachesim
