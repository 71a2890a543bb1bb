// The binary's command line: help, versions, and words that mean nothing.
#include "cli/commands.h"
#include "tests/cli/expect.h"

namespace regather::cli {
namespace {

using testing::HasSubstr;

TEST(Usage, HelpOfEverySubcommandShowsAnExample) {
    const std::string all = expect_done({"--help"}).out;
    for (const Subcommand& command : subcommands()) {
        const std::string name(command.name);
        EXPECT_THAT(all, HasSubstr("\n  " + name + " ")) << name;
        const std::string help = expect_done({name, "--help"}).out;
        EXPECT_THAT(help, HasSubstr("Example")) << name;
        EXPECT_THAT(help, HasSubstr("\n  regather " + name + " ")) << name;
        EXPECT_THAT(help, HasSubstr(std::string(command.summary))) << name;
    }
}

TEST(Usage, VersionNamesTheRevision) {
    EXPECT_THAT(expect_done({"--version"}).out, testing::MatchesRegex("regather [0-9.]+ \\(.+\\)\n"));
}

TEST(Usage, ASubcommandIsNeeded) {
    expect_refused(bad_usage, {}, {"SUBCOMMAND", "capture", "regather --help"});
}

TEST(Usage, AnUnknownSubcommandBringsTheNearest) {
    expect_refused(bad_usage, {"capure", "room"},
                   {"'capure'", "expected \"capture\"", "replay", "regather --help"});
}

TEST(Usage, AnUnknownOptionBringsTheNearest) {
    expect_refused(bad_usage, {"capture", "box", "-o", "x", "--widht", "4"},
                   {"'--widht'", "expected \"--width\"", "regather capture --help"});
    expect_refused(bad_usage, {"capture", "box", "--ouput=x"}, {"'--ouput=x'", "expected \"--output\""});
    expect_refused(bad_usage, {"--verion"}, {"'--verion'", "expected \"--version\""});
    expect_refused(bad_usage, {"scenes", "box", "room"}, {"'room'", "nothing more"});
}

TEST(Usage, AMissingArgumentIsNamed) {
    expect_refused(bad_usage, {"capture", "box"}, {"--output", "required"});
    expect_refused(bad_usage, {"replay", "trace"}, {"--order"});
    expect_refused(bad_usage, {"capture", "box", "-o"}, {"--output"});
    expect_refused(bad_usage, {"info"}, {"what", "required"});
}

TEST(Usage, ImpossibleCaptureValuesLeaveNoFolder) {
    const Scratch scratch;
    const std::string folder = (scratch / "out").string();
    const std::vector<std::string> capture{"capture", "box", "-o", folder};
    expect_refused(bad_usage, capture + std::vector<std::string>{"--width", "0"}, {"--width", "0", "1"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--k", "0"}, {"--k", "0", "1"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--k", "-1"}, {"--k", "-1"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--height", "tall"}, {"--height", "tall"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--photons", "1e6"}, {"--photons", "1e6"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--photons", "99999999999"}, {"--photons"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--radius", "-1"}, {"--radius", "-1"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--radius", "nan"}, {"--radius", "nan"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--gather-order", "hilbrt"},
                   {"hilbrt", "hilbert"});
    expect_refused(bad_usage, capture + std::vector<std::string>{"--gather-order", "kd-leaf"}, {"kd-leaf"});
    expect_refused(bad_usage, {"capture", "bx", "-o", folder}, {"\"bx\"", "\"box\""});
    expect_refused(bad_data, {"capture", "nowhere/scene.json", "-o", folder}, {"nowhere/scene.json"});
    EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(Usage, ImpossibleReplayValuesLeaveNoFile) {
    const Scratch scratch;
    const std::string trace = (captured_box() / "trace").string(), csv = (scratch / "rows.csv").string();
    const auto refused = [&](const std::string& order, const std::string& cache,
                             const std::vector<std::string>& parts) {
        expect_refused(bad_usage, {"replay", trace, "--order", order, "--cache", cache, "--csv", csv}, parts);
    };
    refused("naive", "100:3:7", {"found 3", "power of two"});
    refused("naive", "128K", {"'128K'", "SIZE:LINE:WAYS"});
    refused("naive", "128K:128:0", {"128K:128:0", "ways", "'0'"});
    refused("naive", "0:128:1", {"found 0"});
    refused("naive", "many:128:1", {"'many'"});
    refused("hilbrt", "128K:128:8", {"\"hilbrt\"", "nearest: hilbert", "morton"});
    refused("hilbert:tiel=4", "128K:128:8", {"\"tiel\"", "nearest: tile"});
    refused("hilbert:tile=0", "128K:128:8", {"hilbert", "tile", "0"});
    refused("hilbert:tile=big", "128K:128:8", {"hilbert", "tile", "big"});
    refused("./no_such_library.so", "128K:128:8", {"no_such_library.so"});
    expect_refused(bad_usage, {"replay", trace, "--order", "naive", "--onchip", "much", "--csv", csv},
                   {"'much'"});
    expect_refused(bad_data, {"replay", (scratch / "none").string(), "--order", "naive"},
                   {"none", "no such folder"});
    EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
}

TEST(Binary, OutputThatCannotBeWrittenIsAFailedRun) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--help"}, {"info", (captured_box() / "trace").string()}}) {
        const Outcome outcome = Process(words, "/dev/full").outcome();
        EXPECT_EQ(outcome.exit_code, run_failed) << words.front();
        EXPECT_THAT(outcome.err, HasSubstr("regather: stdout: cannot write: No space left"));
    }
}

TEST(Binary, ItsExitCodesAndOutputsAreThoseOfTheCommand) {
    const Outcome done = Process({"info", "box"}).outcome(), wrong = Process({"info", "bx"}).outcome(),
                  bad = Process({"info", "nowhere/scene.json"}).outcome();
    EXPECT_EQ(done.exit_code, 0);
    EXPECT_EQ(done.out, regather({"info", "box"}).out);
    EXPECT_EQ(wrong.exit_code, bad_usage);
    EXPECT_EQ(wrong.err, regather({"info", "bx"}).err);
    EXPECT_EQ(bad.exit_code, bad_data);
}

}  // namespace
}  // namespace regather::cli
