// Caches as the command line and experiment files write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cachesim/cache_list.h"
#include "trace/error.h"

namespace regather::cachesim {
namespace {

TEST(ParseCache, SizeLineAndWays) {
    const CacheConfig cache = parse_caches("128K:128:8").front();
    EXPECT_EQ(cache.size_bytes, 131072u);
    EXPECT_EQ(cache.line_bytes, 128u);
    EXPECT_EQ(cache.ways, 8u);
    EXPECT_EQ(parse_caches("3K:64:3").front().ways, 3u);  // 16 sets
    EXPECT_EQ(parse_caches("64:64:1").front().size_bytes, 64u);
    EXPECT_EQ(parse_caches("3000:8:full").front().ways, fully_associative);
}

TEST(ParseCache, ItsTextIsReadBack) {
    for (const char* text : {"131072:128:8", "16384:64:full", "64:64:1"})
        EXPECT_EQ(cache_text(parse_caches(text).front()), text);
}

TEST(ParseCache, AllElseIsAUsageError) {
    for (const char* text : {"",
                             ":",
                             "::",
                             "128K",
                             "128K:128",
                             "128K:128:",
                             "128K:128:0",
                             "128K:128:-1",
                             "128K:128:8:1",
                             "128K:128:8 ",
                             "128K:128:FULL",
                             "128K:0:8",
                             "0:128:8",
                             "128K:96:8",
                             "128K:128:3",
                             "100:3:7",
                             "128K:128:4294967296",
                             "8G:4294967296:1",
                             "128K:256K:1",
                             "big:128:8"})
        EXPECT_THROW(parse_caches(text), trace::UsageError) << text;
}

TEST(ParseCaches, ListsAreMultipliedOutSizesOutermost) {
    std::vector<std::string> texts;
    for (const CacheConfig& cache : parse_caches("16K,32K:64,128:1,full")) texts.push_back(cache_text(cache));
    EXPECT_THAT(texts, testing::ElementsAre("16384:64:1", "16384:64:full", "16384:128:1", "16384:128:full",
                                            "32768:64:1", "32768:64:full", "32768:128:1", "32768:128:full"));
}

}  // namespace
}  // namespace regather::cachesim
