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

TEST(Import, AFileWithoutAKindIsAnsweredWithWhatToType) {
    const Scratch scratch;
    const std::string file = (scratch / "t.obj").string();
    write(file, triangle);
    for (const std::vector<std::string>& words : {std::vector<std::string>{"import", file},
                                                  {"import", file, "-o", "y"},
                                                  {"import", file, "other.obj", "-o", "y"}}) {
        const Outcome outcome = regather(words);
        EXPECT_EQ(outcome.exit_code, 2);
        EXPECT_THAT(outcome.err,
                    HasSubstr("expected a kind before it: regather import mesh " + file + " -o DIR"));
    }
    EXPECT_THAT(regather({"import", "a.sh3d", "-o", "y"}).err,
                HasSubstr("regather import sweethome3d a.sh3d -o DIR"));
    EXPECT_THAT(regather({"import", "a.pk3"}).err, HasSubstr("regather import openarena a.pk3 -o DIR"));
    EXPECT_THAT(regather({"import", "a.SH3D"}).err, HasSubstr("regather import sweethome3d a.SH3D -o DIR"));
    for (const std::string file_of_none : {"x.stl", "x.fbx"}) {
        const Outcome refused = regather({"import", file_of_none, "-o", "y"});
        EXPECT_EQ(refused.exit_code, 2);
        EXPECT_THAT(refused.err, HasSubstr("KIND: found the file \"" + file_of_none +
                                           "\", which no kind reads, expected a kind and a file: "));
        EXPECT_THAT(refused.err, HasSubstr("mesh (.obj, .ply, .gltf, .glb)"));
        EXPECT_THAT(refused.err, HasSubstr("openarena (.pk3)"));
    }
    const Outcome none = regather({"import", "mesh"});
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_THAT(none.err, HasSubstr("FILE: found none, expected what to read"));
}

TEST(Import, AMeshGivenAsASceneIsAnsweredWithWhatToType) {
    const Scratch scratch;
    const std::string file = (scratch / "t.obj").string(), out = (scratch / "out").string();
    write(file, triangle);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"info", file}, {"scenes", file}, {"capture", file, "-o", out}}) {
        const Outcome outcome = regather(words);
        EXPECT_EQ(outcome.exit_code, 2);
        EXPECT_THAT(outcome.err, HasSubstr("regather import mesh " + file + " -o DIR"));
    }
    EXPECT_FALSE(fs::exists(out));
}

TEST(Import, TheAxisThatIsUpAndWhatAFileHoldsBeyondTrianglesAreSaid) {
    const Scratch scratch;
    const std::string file = (scratch / "t.obj").string(), out = (scratch / "out").string();
    write(file, std::string("mtllib gone.mtl\nl 1 2\n") + triangle);
    const Outcome first = regather({"import", "mesh", file, "-o", out});
    EXPECT_EQ(first.exit_code, 0);
    EXPECT_THAT(first.out, HasSubstr("up       y of the file, by default: see --up"));
    EXPECT_EQ(first.err, "note: " + file + ": lines (l) are not read: 1\nnote: " + file +
                             ": the material library \"gone.mtl\" is not there: 1\n");
    const Outcome second = regather({"import", "mesh", file, "-o", out, "--force", "--up", "x"});
    EXPECT_THAT(second.out, HasSubstr("up       x of the file\n"));
    // A scene that names the mesh itself: each command that loads it says the same.
    write(
        scratch / "s.json",
        R"({"name": "s", "camera": {"position": [0, -3, 1], "target": [0, 0, 0], "up": [0, 0, 1], "vertical_fov_degrees": 50},
              "materials": {"m": {"kind": "diffuse", "diffuse": [0.5, 0.5, 0.5]}},
              "shapes": [{"type": "mesh", "file": "t.obj", "material": "m"}],
              "lights": [{"corner": [0, 0, 2], "edge_u": [0, 1, 0], "edge_v": [1, 0, 0], "radiance": [1, 1, 1]}]})");
    const std::string scene = (scratch / "s.json").string();
    for (const std::vector<std::string>& words : {std::vector<std::string>{"info", scene},
                                                  {"scenes", scene},
                                                  {"capture", scene, "-o", (scratch / "capture").string(),
                                                   "--width", "4", "--photons", "100", "--samples", "1"}}) {
        const Outcome outcome = regather(words);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("note: " + file + ": lines (l) are not read: 1\n"));
    }
}

}  // namespace
}  // namespace regather::cli
