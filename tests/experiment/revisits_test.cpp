// What no order changes, as text: read back as it was, or refused.
#include "experiment/revisits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::experiment {
namespace {

replay::Revisits some_revisits() {
    replay::Revisits revisits;
    cachesim::FamilyCounts& counts = revisits[128];
    counts.accesses = (std::uint64_t{1} << 63) + 1;
    counts.by_distance = {3, 0, ~std::uint64_t{0}};
    counts.levels = {{{1, 2}, {5, 4}, {1, 0}}, {{1 << 24, 1}, {std::uint64_t{1} << 40}, {}}};
    revisits[8].accesses = 7;
    return revisits;
}

TEST(Revisits, AreReadAsTheyWereWritten) {
    for (const replay::Revisits& revisits : {some_revisits(), replay::Revisits{}})
        EXPECT_EQ(revisits_in(text_of(revisits), "kept"), revisits);
}

TEST(Revisits, TextThatIsSomethingElseIsRefusedByName) {
    const std::string whole = text_of(some_revisits());
    const auto refused = [&](const std::string& text) {
        try {
            revisits_in(text, "out/kept");
            ADD_FAILURE() << "accepted: " << text;
        } catch (const trace::DataError& error) {
            EXPECT_THAT(error.what(),
                        testing::AllOf(testing::HasSubstr("out/kept"), testing::HasSubstr("expected"),
                                       testing::Not(testing::HasSubstr("\n"))));
        }
    };
    for (std::size_t length = 0; length + 2 < whole.size(); length += 7) refused(whole.substr(0, length));
    for (const char* text :
         {"{}", "null", "7", "\"text\"", "[7]", "[{}]", R"([{"line_bytes": 8}])",
          R"([{"line_bytes": "8", "accesses": 1, "by_distance": [], "levels": []}])",
          R"([{"line_bytes": 8, "accesses": 1, "by_distance": ["many"], "levels": []}])",
          R"([{"line_bytes": 8, "accesses": 1, "by_distance": [], "levels": [{"sets": 1}]}])"})
        refused(text);
}

}  // namespace
}  // namespace regather::experiment
