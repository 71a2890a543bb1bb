// What a run keeps: read for its key alone, and only whole.
#include "experiment/kept.h"

#include <gtest/gtest.h>

#include "tests/scratch.h"
#include "trace/file.h"

namespace regather::experiment {
namespace {

TEST(Kept, IsReadForItsKeyAlone) {
    const Scratch scratch;
    EXPECT_EQ(read_kept(scratch / "a.part", "rows 1"), std::nullopt);
    for (const std::string bytes : {"", "a,b\n1,2\n", "\n\n"}) {
        write_kept(scratch / "a.part", "rows 1", bytes);
        EXPECT_EQ(read_kept(scratch / "a.part", "rows 1"), bytes);
        EXPECT_EQ(read_kept(scratch / "a.part", "rows 2"), std::nullopt);
    }
    EXPECT_EQ(read_kept(scratch.path(), "rows 1"), std::nullopt);  // a folder
}

TEST(Kept, EveryDamageIsSeen) {
    const Scratch scratch;
    write_kept(scratch / "a.part", "rows 1", "a,b\n1,2\n");
    const std::string whole = trace::read_file(scratch / "a.part");
    const auto accepted = [&](const std::string& bytes) {
        trace::write_whole(scratch / "a.part", bytes);
        return read_kept(scratch / "a.part", "rows 1").has_value();
    };
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(accepted(whole.substr(0, length)));
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string other = whole;
        other[at] = static_cast<char>(other[at] ^ 1);
        EXPECT_FALSE(accepted(other)) << at;
    }
    EXPECT_FALSE(accepted(whole + "\n"));
    EXPECT_TRUE(accepted(whole));
}

}  // namespace
}  // namespace regather::experiment
