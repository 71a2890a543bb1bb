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
    const std::string trace = box_trace(), csv = (scratch / "rows.csv").string();
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
         {std::vector<std::string>{"--help"}, {"info", box_trace()}}) {
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

/// This exit code, and one line without control characters that is not long, whatever was in the words.
void expect_cut(int exit_code, const std::vector<std::string>& words) {
    const Outcome outcome = regather(words);
    EXPECT_EQ(outcome.exit_code, exit_code) << words.front() << ' ' << outcome.err.substr(0, 900);
    EXPECT_LT(outcome.err.size(), 900u) << words.front();
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << words.front();
    EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos) << words.front();
}

TEST(Usage, AnOutputNobodyCanHaveIsWrongUsageAndCut) {
    const std::string name = std::string(5000, 'x') + "\x1b[31m", trace = box_trace();
    expect_cut(bad_usage, small_capture(name));
    expect_cut(bad_usage, {"reference", "box", "-o", name});
    expect_cut(bad_usage, {"replay", trace, "--order", "naive", "--csv", name + ".csv"});
    expect_cut(bad_usage, {"race", trace, "--csv", name + ".csv"});
    expect_cut(bad_usage,
               {"cachesim", "none.din", "--size", "1K", "--line", "64", "--ways", "2", "--csv", name});
    expect_cut(bad_usage, {"stability", "-o", name});
    expect_cut(bad_usage, {"import", "mesh", "none.obj", "-o", name});
    expect_cut(bad_usage, {"scenes", "--thumbnails", name + ".png"});
    expect_cut(bad_usage, {"reference", "box", "-o", std::string(256, 'y')});
    std::string deep;
    while (deep.size() < 4096) deep += "folder/";
    expect_cut(bad_usage, {"reference", "box", "-o", deep});
}

TEST(Usage, WhatIsReadIsCutInMessages) {
    const std::string name = "\x1b[31m\n" + std::string(5000, 'x'), trace = box_trace();
    expect_cut(bad_usage, {name});
    expect_cut(bad_usage, {"info", name});
    expect_cut(bad_data, {"info", name + ".json"});
    expect_cut(bad_usage, {"import", name, "-o", "none"});
    expect_cut(bad_usage, {"import", "mesh", name, "-o", "none"});
    expect_cut(bad_usage, {"machines", name});
    expect_cut(bad_data, {"machines", name + ".json"});
    expect_cut(bad_usage, {"scenes", "--thumbnails", "none.png", name});
    expect_cut(bad_usage, {"scenes", "box", name});
    expect_cut(bad_usage, {"replay", trace, "--order", name});
    expect_cut(bad_usage, {"replay", trace, "--order", name + ".so"});
    expect_cut(bad_usage, {"race", trace, "--structure", name});
    expect_cut(bad_usage, small_capture("none") + std::vector<std::string>{"--gather-order", name});
    expect_cut(bad_usage, small_capture("none") + std::vector<std::string>{"--keep", name});
    expect_cut(bad_usage, {"stability", "--only", name});
    expect_cut(bad_data, {"cachesim", name, "--size", "1K", "--line", "64", "--ways", "2"});
}

TEST(Usage, AFolderIsNoAddressTrace) {
    const Scratch scratch;
    expect_refused(bad_data,
                   {"cachesim", scratch.path().string(), "--size", "1K", "--line", "64", "--ways", "2"},
                   {scratch.path().string() + ": found a folder, expected a file"});
}

TEST(Usage, TextOfATraceIsShownOnOneLineOfItsOwn) {
    const Scratch scratch;
    const std::filesystem::path trace = copied_trace(scratch);
    std::string text = content(trace / "trace.json");
    const std::string before = "\"scene\": \"box\"", why = "\"why\": \"";
    text.replace(text.find(before), before.size(),
                 "\"scene\": \"a\\u001b[31mb" + std::string(5000, 'x') + "\"");
    text.replace(text.find(why), why.size(), why + "\\u001b]0;\\n");
    write(trace / "trace.json", text);
    const std::string out = expect_done({"info", trace.string()}).out;
    EXPECT_THAT(out, HasSubstr("scene      a\\x1b[31mbxxx"));
    EXPECT_THAT(out, HasSubstr(": \\x1b]0;\\n"));
    EXPECT_EQ(out.find('\x1b'), std::string::npos);
    EXPECT_EQ(out.find(std::string(100, 'x')), std::string::npos);
}

// Pixels and walks that do not fit are named with the trace's folder.
TEST(Usage, AReplayNamesTheFileThatDoesNotFit) {
    const Scratch scratch;
    const std::filesystem::path trace = copied_trace(scratch);
    std::string text = content(trace / "trace.json");
    const std::string before = "\"image_height\": 16";
    write(trace / "trace.json", text.replace(text.find(before), before.size(), "\"image_height\": 1"));
    expect_refused(
        bad_data, {"replay", trace.string(), "--order", "naive"},
        {(trace / "query_pixel.npy").string() + ": row ", "expected less than 16 (16 x 1 pixels)"});
}

}  // namespace
}  // namespace regather::cli
