// What no order changes, kept in a file: read back as it was, or refused.
#include "experiment/revisits.h"

#include "tests/cli/expect.h"
#include "trace/error.h"

namespace regather::experiment {
namespace {

namespace fs = std::filesystem;

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
    const Scratch scratch;
    const fs::path path = scratch / "revisits.json";
    for (const replay::Revisits& revisits : {some_revisits(), replay::Revisits{}}) {
        write_revisits(path, revisits);
        EXPECT_EQ(read_revisits(path), revisits);
    }
}

TEST(Revisits, AFileThatIsSomethingElseIsRefusedByName) {
    const Scratch scratch;
    const fs::path path = scratch / "revisits.json";
    write_revisits(path, some_revisits());
    const std::string whole = cli::content(path);
    const auto refused = [&](const std::string& text) {
        cli::write(path, text);
        try {
            read_revisits(path);
            ADD_FAILURE() << "accepted: " << text;
        } catch (const trace::DataError& error) {
            EXPECT_THAT(error.what(),
                        testing::AllOf(testing::HasSubstr(path.string()), testing::HasSubstr("expected"),
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
    fs::remove(path);
    EXPECT_THROW(read_revisits(path), std::exception);
}

}  // namespace
}  // namespace regather::experiment
