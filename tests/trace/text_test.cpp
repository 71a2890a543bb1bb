#include "trace/text.h"

#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::trace {
namespace {

using namespace std::string_literals;

TEST(Text, PlainTextIsShownAsItIs) {
    EXPECT_EQ(shown("living room, 3rd floor"), "living room, 3rd floor");
    EXPECT_EQ(shown("K\xc3\xbc"
                    "che \xe2\x82\xac \xf0\x9f\x8f\xa0"),
              "K\xc3\xbc"
              "che \xe2\x82\xac \xf0\x9f\x8f\xa0");
    EXPECT_EQ(shown("a \"b\" \\c"), "a \"b\" \\c");
    EXPECT_EQ(in_quotes("a \"b\" \\c"), R"("a \"b\" \\c")");
}

TEST(Text, ControlCharactersAreEscaped) {
    EXPECT_EQ(shown("a\nb\tc\rd"), R"(a\nb\tc\rd)");
    EXPECT_EQ(shown("\x1b[31mred\x7f\0"s), R"(\x1b[31mred\x7f\x00)");
    EXPECT_EQ(shown("\xc2\x9b"
                    "31m"),
              R"(\u{9b}31m)");  // CSI, which terminals obey like ESC [
    EXPECT_EQ(shown("a\xe2\x80\xae"
                    "b\xe2\x80\xa8"),
              R"(a\u{202e}b\u{2028})");  // right-to-left override, line separator
}

TEST(Text, BytesThatAreNoUtf8AreEscapedOneByOne) {
    EXPECT_EQ(shown("\xff"), R"(\xff)");
    EXPECT_EQ(shown("a\xc3("), R"(a\xc3()");                      // begun, not ended
    EXPECT_EQ(shown("\xc0\xaf"), R"(\xc0\xaf)");                  // '/' in two bytes: overlong
    EXPECT_EQ(shown("\xed\xa0\x80"), R"(\xed\xa0\x80)");          // half a surrogate pair
    EXPECT_EQ(shown("\xf4\x90\x80\x80"), R"(\xf4\x90\x80\x80)");  // U+110000
}

// Unicode 15, table 3-7: the first and the last of each row, and their neighbours that are not well-formed.
TEST(Text, LengthsOfCharactersAreThoseOfTheStandard) {
    EXPECT_EQ(utf8_length(""), 0u);
    EXPECT_EQ(utf8_length("\x7f"), 1u);
    EXPECT_EQ(utf8_length("\x80"), 0u);
    EXPECT_EQ(utf8_length("\xc1\xbf"), 0u);
    EXPECT_EQ(utf8_length("\xc2\x80"), 2u);
    EXPECT_EQ(utf8_length("\xdf\xbf"), 2u);
    EXPECT_EQ(utf8_length("\xe0\x9f\xbf"), 0u);
    EXPECT_EQ(utf8_length("\xe0\xa0\x80"), 3u);
    EXPECT_EQ(utf8_length("\xed\x9f\xbf"), 3u);
    EXPECT_EQ(utf8_length("\xed\xa0\x80"), 0u);
    EXPECT_EQ(utf8_length("\xee\x80\x80"), 3u);
    EXPECT_EQ(utf8_length("\xf0\x8f\xbf\xbf"), 0u);
    EXPECT_EQ(utf8_length("\xf0\x90\x80\x80"), 4u);
    EXPECT_EQ(utf8_length("\xf4\x8f\xbf\xbf"), 4u);
    EXPECT_EQ(utf8_length("\xf5\x80\x80\x80"), 0u);
    EXPECT_EQ(utf8_length("\xe2\x82"), 0u);
}

TEST(Text, LongTextIsCutBetweenCharacters) {
    EXPECT_EQ(shown("abcdef", 6), "abcdef");
    EXPECT_EQ(shown("abcdefg", 6), "abcdef...");
    EXPECT_EQ(shown("abcd\xe2\x82\xac", 6), "abcd...");
    EXPECT_EQ(in_quotes(std::string(1000, 'x'), 4), "\"xxxx...\"");
}

TEST(Errors, AreOneLineWhateverAFileHolds) {
    EXPECT_STREQ(DataError("a.ply: found \"x\ny\x01\"").what(), "a.ply: found \"x\\ny\\x01\"");
    EXPECT_STREQ(UsageError("a\tb").what(), "a\\tb");
    const std::string longer_than_a_shown_text(500, 'a');
    EXPECT_EQ(DataError(longer_than_a_shown_text).what(), longer_than_a_shown_text);
}

}  // namespace
}  // namespace regather::trace
