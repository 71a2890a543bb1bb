#include "trace/size.h"

#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::trace {
namespace {

TEST(ParseSize, SuffixesArePowersOf1024) {
    EXPECT_EQ(parse_size("4096"), 4096u);
    EXPECT_EQ(parse_size("16K"), 16384u);
    EXPECT_EQ(parse_size("16k"), 16384u);
    EXPECT_EQ(parse_size("1M"), 1048576u);
    EXPECT_EQ(parse_size("3g"), 3221225472u);
    EXPECT_EQ(parse_size("0"), 0u);
    EXPECT_EQ(parse_size("18446744073709551615"), ~std::uint64_t{0});
    EXPECT_EQ(parse_size("17179869183G"), 0xffffffffc0000000u);
}

TEST(ParseSize, AllElseIsAUsageError) {
    for (const char* text : {"", "K", "-1", "+1", " 1", "1 K", "1KB", "1.5K", "0x10", "1T",
                             "18446744073709551616", "17179869184G"})
        EXPECT_THROW(parse_size(text), trace::UsageError) << text;
}

TEST(ParseSize, ShowsWhatItRefusesOnOneLine) {
    try {
        parse_size("16\x03\n");
        FAIL();
    } catch (const trace::UsageError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "size: found '16\\x03\\n', expected bytes below 2^64 as 4096, 16K, 1M or 2G");
    }
}

TEST(SizeText, IsTheShortestThatReadsAsTheSame) {
    for (const auto& [bytes, text] : {std::pair{std::uint64_t{0}, "0"},
                                      {1023, "1023"},
                                      {1024, "1K"},
                                      {1536, "1536"},
                                      {98304, "96K"},
                                      {3 << 20, "3M"},
                                      {std::uint64_t{5} << 30, "5120M"}}) {
        EXPECT_EQ(size_text(bytes), text);
        EXPECT_EQ(parse_size(text), bytes);
    }
}

TEST(ScaledDown, FromTheBorderOnAndSixTimesAtMost) {
    EXPECT_EQ(scaled_down(999.5, 1000, 999.5).steps, 1u);
    EXPECT_EQ(scaled_down(999.4, 1000, 999.5).steps, 0u);
    EXPECT_EQ(scaled_down(3 * 1024 * 1024, 1024, 1024).value, 3);
    EXPECT_EQ(scaled_down(1e30, 1000, 1000).steps, 6u);
}

}  // namespace
}  // namespace regather::trace
