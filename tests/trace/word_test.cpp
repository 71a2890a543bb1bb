#include "trace/word.h"

#include <gtest/gtest.h>

namespace regather::trace {
namespace {

using Words = std::vector<std::string_view>;

TEST(Word, NearestIsByEditDistance) {
    const Words words{"kitten", "sitting", "radius"};
    EXPECT_EQ(nearest_words("mitten", words), Words{"kitten"});
    EXPECT_EQ(nearest_words("sittin", words), Words{"sitting"});
    EXPECT_EQ(nearest_words("", Words{"abc", "ab"}), Words{"ab"});
    EXPECT_EQ(nearest_words("edge_", Words{"corner", "edge_u", "edge_v"}), (Words{"edge_u", "edge_v"}));
}

TEST(Word, AlternativesReadAsASentence) {
    EXPECT_EQ(alternatives(Words{"a"}), "\"a\"");
    EXPECT_EQ(alternatives(Words{"a", "b", "c"}), "\"a\", \"b\" or \"c\"");
    EXPECT_EQ(listed(Words{"a", "b", "c"}), "a, b, c");
}

}  // namespace
}  // namespace regather::trace
