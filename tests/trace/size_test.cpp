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

}  // namespace
}  // namespace regather::trace
