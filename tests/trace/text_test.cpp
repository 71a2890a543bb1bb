#include "trace/text.h"

#include <gtest/gtest.h>

#include <string>

namespace regather::trace {
namespace {

TEST(Text, PlainTextStandsInQuotes) {
    EXPECT_EQ(in_quotes(""), R"("")");
    EXPECT_EQ(in_quotes("a b"), R"("a b")");
    EXPECT_EQ(in_quotes("a\"b\\c"), R"("a\"b\\c")");
    EXPECT_EQ(in_quotes("Küche 漢 😀"), "\"Küche 漢 😀\"");  // 2, 3 and 4 bytes of UTF-8
}

TEST(Text, NothingThatATerminalObeysGetsThrough) {
    EXPECT_EQ(in_quotes("a\nb\r\tc"), R"("a\nb\r\tc")");
    EXPECT_EQ(in_quotes(std::string("a\0\x1b[2J\x7f", 7)), R"("a\x00\x1b[2J\x7f")");
    EXPECT_EQ(in_quotes("\u009b31m"), R"("\u{9b}31m")");                // C1: the same as ESC [
    EXPECT_EQ(in_quotes("a\u202eb\u2028"), R"("a\u{202e}b\u{2028}")");  // right to left, a line's end
}

TEST(Text, BytesThatAreNotUtf8AreShownAsBytes) {
    EXPECT_EQ(in_quotes("\xff"), R"("\xff")");
    EXPECT_EQ(in_quotes("a\xc3"), R"("a\xc3")");        // cut
    EXPECT_EQ(in_quotes("\xc0\x80"), R"("\xc0\x80")");  // overlong
    EXPECT_EQ(in_quotes("\xe0\x80\xaf"), R"("\xe0\x80\xaf")");
    EXPECT_EQ(in_quotes("\xed\xa0\x80"), R"("\xed\xa0\x80")");          // half of a surrogate pair
    EXPECT_EQ(in_quotes("\xf4\x90\x80\x80"), R"("\xf4\x90\x80\x80")");  // beyond U+10FFFF
}

TEST(Text, LongTextIsCutBetweenCharacters) {
    EXPECT_EQ(in_quotes(std::string(60, 'x')), '"' + std::string(60, 'x') + '"');
    EXPECT_EQ(in_quotes(std::string(61, 'x')), '"' + std::string(60, 'x') + "...\"");
    EXPECT_EQ(in_quotes("abü", 3), R"("ab...")");
    EXPECT_EQ(in_quotes("abü", 4), "\"abü\"");
}

}  // namespace
}  // namespace regather::trace
