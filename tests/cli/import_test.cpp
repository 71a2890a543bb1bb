// `regather import`: kinds, options, refusals, and that a written scene is one that `regather scenes` reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/command.h"

namespace regather::cli {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(Import, AMeshBecomesASceneThatTheOtherCommandsRead) {
    const Scratch scratch;
    write(scratch / "t.obj", triangle);
    const std::string out = (scratch / "out").string();
    const Outcome import = regather({"import", "mesh", (scratch / "t.obj").string(), "-o", out});
    EXPECT_EQ(import.exit_code, 0) << import.err;
    EXPECT_THAT(import.out, HasSubstr("36 frames"));
    const Outcome scenes = regather({"scenes", out + "/scene.json"});
    EXPECT_EQ(scenes.exit_code, 0) << scenes.err;
}

TEST(Import, AFolderThatIsThereIsRefusedBeforeAnythingIsRead) {
    const Scratch scratch;
    write(scratch / "t.obj", triangle);
    const std::string out = (scratch / "out").string();
    const std::vector<std::string> words{"import", "mesh", (scratch / "t.obj").string(), "-o", out};
    EXPECT_EQ(regather(words).exit_code, 0);
    const auto before = contents(out);
    const Outcome second = regather({"import", "mesh", "no-such-file.obj", "-o", out});
    EXPECT_EQ(second.exit_code, 2);
    EXPECT_THAT(second.err, HasSubstr("expected another one (or --force)"));
    EXPECT_EQ(contents(out), before);
    std::vector<std::string> forced = words;
    forced.push_back("--force");
    EXPECT_EQ(regather(forced).exit_code, 0);
    EXPECT_EQ(contents(out), before);  // the same scene, the same bytes
}

TEST(Import, BadDataIsOneLineAndExit3AndLeavesNothing) {
    const Scratch scratch;
    write(scratch / "bad.sh3d", "not a zip archive at all");
    write(scratch / "bad.obj", "v 0 0\n");
    for (const auto& [kind, file] :
         {std::pair{"sweethome3d", "bad.sh3d"}, {"mesh", "bad.obj"}, {"furniture", "bad.sh3d"}}) {
        const Outcome outcome =
            regather({"import", kind, (scratch / file).string(), "-o", (scratch / "out").string()});
        EXPECT_EQ(outcome.exit_code, 3) << kind;
        EXPECT_THAT(outcome.err, HasSubstr(file));
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_FALSE(fs::exists(scratch / "out"));
    }
    EXPECT_EQ(contents(scratch.path()).size(), 2u);
}

TEST(Import, AnUnknownKindOrAnotherKindsOptionIsAUsageError) {
    const Outcome kind = regather({"import", "sweethom3d", "x", "-o", "y"});
    EXPECT_EQ(kind.exit_code, 2);
    EXPECT_THAT(kind.err, HasSubstr("sweethome3d"));
    const Outcome option = regather({"import", "mesh", "x.obj", "--home", "Studio", "-o", "y"});
    EXPECT_EQ(option.exit_code, 2);
    EXPECT_THAT(option.err, HasSubstr("--home: found with the kind mesh"));
    EXPECT_EQ(regather({"import", "mesh", "x.obj"}).exit_code, 2);
}

}  // namespace
}  // namespace regather::cli
