// Options that would leave each other without effect are refused, in one line that names both; so is a word
// that no option takes. Nothing is dropped in silence.
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/commands.h"
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

struct Conflict {
    Words command;     ///< With what it needs.
    Words one, other;  ///< Each is accepted without the other, as far as words go.
};

const std::vector<Conflict>& conflicts() {
    static const Words replay{"replay", "none", "--order", "naive"}, cachesim{"cachesim", "none.din"},
        capture{"capture", "box", "-o", "none"}, detail{"detail", "none", "--order", "naive"};
    static const std::vector<Conflict> table = [] {
        std::vector<Conflict> all{
            {replay, {"--sample", "2"}, {"--classes"}},
            {replay, {"--sample", "2"}, {"--buffers"}},
            {replay + Words{"--queue", "9"}, {"--treelets", "1K"}, {"--classes"}},
            {replay + Words{"--queue", "9"}, {"--treelets", "1K"}, {"--sample", "2"}},
            {{"frame", "none", "--order", "naive"}, {"--machine", "paper-128k"}, {"--cache", "1K:64:1"}},
            {{"stability"}, {"--list"}, {"--quick"}},
            {{"stability"}, {"--list"}, {"--output", "x"}},
            {capture, {"--mode", "direct"}, {"--gather-rays", "4"}},
            {capture, {"--mode", "direct"}, {"--shadow-rays", "4"}},
            {capture, {"--caustic-photons", "0"}, {"--caustic-k", "4"}},
            {capture, {"--caustic-photons", "0"}, {"--caustic-radius", "4"}},
            {capture, {"--caustic-photons", "0"}, {"--caustic-filter", "none"}},
        };
        for (const Words& beside : std::vector<Words>{
                 {"--cache", "1K:64:1"}, {"--classes"}, {"--buffers"}, {"--sample", "2"}, {"--seed", "3"}})
            all.push_back({replay, {"--machine", "paper-128k"}, beside});
        for (const Words& beside : std::vector<Words>{{"--size", "1K"},
                                                      {"--line", "64"},
                                                      {"--ways", "1"},
                                                      {"--policy", "lru"},
                                                      {"--write", "back"},
                                                      {"--write-miss", "allocate"},
                                                      {"--index", "modulo"},
                                                      {"--all-lru"},
                                                      {"--seed", "3"},
                                                      {"--no-3c"},
                                                      {"--opt-limit", "9"}})
            all.push_back({cachesim, {"--machine", "paper-128k"}, beside});
        for (const Words& beside : std::vector<Words>{{"--size", "1K"},
                                                      {"--policy", "lru"},
                                                      {"--write", "back"},
                                                      {"--write-miss", "allocate"},
                                                      {"--index", "modulo"},
                                                      {"--seed", "3"},
                                                      {"--opt-limit", "9"}})
            all.push_back({cachesim + Words{"--line", "64"}, {"--all-lru"}, beside});
        return all;
    }();
    return table;
}

TEST(Conflicts, AreRefusedInOneLineThatNamesBoth) {
    for (const Conflict& conflict : conflicts())
        for (const Words& words : {conflict.one + conflict.other, conflict.other + conflict.one})
            expect_refused(bad_usage, conflict.command + words,
                           {conflict.one.front(), conflict.other.front()});
    EXPECT_FALSE(fs::exists("none"));
}

TEST(Conflicts, AnOptionThatNeedsAnotherIsRefusedWithoutIt) {
    const Words cachesim{"cachesim", "none.din", "--size", "1K", "--line", "64", "--ways", "1"};
    for (const auto& [words, option, needed] : std::vector<std::tuple<Words, Words, std::string>>{
             {{"replay", "none", "--order", "naive"}, {"--seed", "3"}, "--sample"},
             {{"replay", "none", "--order", "naive"}, {"--force"}, "--csv"},
             {{"replay", "none", "--order", "naive"}, {"--treelets", "1K"}, "--queue"},
             {{"replay", "none", "--order", "naive"}, {"--queue", "9"}, "--treelets"},
             {{"frame", "none", "--order", "naive"}, {"--force"}, "--csv"},
             {{"detail", "none", "--order", "naive"}, {"--slices", "3"}, "--timeline"},
             {{"detail", "none", "--order", "naive"}, {"--force"}, "--csv"},
             {{"race", "none"}, {"--force"}, "--csv"},
             {{"sampling", "none"}, {"--force"}, "--csv"},
             {{"scenes"}, {"--force"}, "--thumbnails"},
             {{"stability"}, {"--force"}, "--output"},
             {cachesim, {"--force"}, "--csv"},
             {cachesim, {"--seed", "3"}, "--policy random"},
             {cachesim, {"--opt-limit", "3"}, "--policy opt"},
             {{"info", "box"}, {"--verify"}, "a trace's folder"}})
        expect_refused(bad_usage, words + option, {option.front(), needed});
}

/// Of every subcommand, each option that takes a word.
std::vector<std::pair<std::string, std::string>> options() {
    std::vector<std::pair<std::string, std::string>> all;
    for (const Subcommand& entry : subcommands()) {
        Command command(entry.name, entry.summary);
        entry.add(command);
        for (const std::string& name : command.options()) all.emplace_back(entry.name, name);
    }
    return all;
}

TEST(Words, EmptyOnesAreRefusedByEveryOption) {
    ASSERT_GT(options().size(), 60u);
    for (const auto& [command, option] : options()) {
        expect_refused(bad_usage, {command, option, ""}, {option, "found ''"});
        expect_refused(bad_usage, {command, option + "="}, {option});
    }
}

TEST(Words, AnOptionWithoutAWordIsRefusedInOurWords) {
    for (const auto& [command, option] : options()) {
        const Outcome outcome = regather({command, option});
        EXPECT_EQ(outcome.exit_code, bad_usage);
        EXPECT_THAT(outcome.err, testing::HasSubstr(option + ": found nothing behind it, expected "))
            << command;
    }
}

TEST(Words, NoLibrarysWordsAndNoLongNumbersReachAUser) {
    const std::string many(400, '7');
    for (const auto& [command, option] : options()) {
        // One needs no other word to run for minutes, the other none to write a file of any name.
        if (command == "stability" || (command == "computation" && option == "--csv")) continue;
        for (const std::string& word : {std::string("-1"), std::string("nan"), std::string("1e999"), many}) {
            const Outcome outcome = regather({command, option, word});
            EXPECT_NE(outcome.exit_code, 0);
            EXPECT_LT(outcome.err.size(), 900u) << command << option;
            EXPECT_THAT(outcome.err,
                        testing::Not(testing::AnyOf(
                            testing::HasSubstr("UINT"), testing::HasSubstr("FLOAT"), testing::HasSubstr("["),
                            testing::HasSubstr("Could not convert"), testing::HasSubstr("required TEXT"))));
        }
    }
    expect_refused(bad_usage, {"capture", "--width", many}, {"--width", "from 1 to 32768"});
    expect_refused(bad_usage, {"capture", "--radius", "-0.5"},
                   {"--radius: found '-0.5', expected a number from 0 up, or inf"});
    expect_refused(bad_usage, {"converge", "--seconds", "0"},
                   {"--seconds: found '0', expected a number above 0"});
    expect_refused(bad_usage, {"capture", "--k", "5", "--k", "6"}, {"--k: found 2 times, expected once"});
    expect_refused(bad_usage, {"capture", "--force=3"}, {"--force: found a value, expected none"});
    expect_refused(bad_usage, {"capture", "--tone", "loud"}, {"--tone", "'loud'", "exponential"});
}

TEST(Words, TheSameTwiceInAListIsRefused) {
    for (const auto& [words, parts] : std::vector<std::pair<Words, Words>>{
             {{"replay", "none", "--order", "naive", "naive"}, {"--order", "'naive' twice"}},
             {{"replay", "none", "--order", "hilbert", "hilbert:bits=21"}, {"hilbert", "twice"}},
             {{"replay", "none", "--order", "naive", "--cache", "1K:64:1", "1024:64:1"}, {"1024:64:1 twice"}},
             {{"replay", "none", "--order", "naive", "--machine", "paper-128k,paper-128k"},
              {"paper-128k twice"}},
             {{"replay", "none", "--order", "naive", "--queue", "9", "--treelets", "1K,1024"},
              {"1024", "9", "twice"}},
             {{"frame", "none", "--order", "naive", "--unit", "frame", "frame"}, {"--unit", "'frame' twice"}},
             {{"race", "none", "--structure", "bucketed,bucketed"}, {"--structure", "'bucketed' twice"}},
             {{"cachesim", "none", "--all-lru", "--line", "32,64,32"}, {"--line 32", "twice"}},
             {{"cachesim", "none", "--all-lru", "--line", "1024,1K"}, {"--line 1024", "twice"}},
             {{"sampling", "none", "--rates", "2,4,2"}, {"--rates", "'2' twice"}},
             {{"chart", "a.csv", "a.csv", "-o", "none"}, {"CSV", "'a.csv' twice"}},
             {{"stability", "--only", "maps,maps"}, {"--only", "'maps' twice"}}})
        expect_refused(bad_usage, words, parts);
}

TEST(Words, AnUnlimitedRadiusMayBeWrittenInf) {
    const Scratch scratch;
    const auto radius = [&](const char* word) {
        expect_done(small_capture(scratch / word) + Words{"--radius", word});
        return trace::TraceReader(scratch / word / "trace").info().parameters.dump();
    };
    EXPECT_EQ(radius("inf"), radius("0"));
    EXPECT_NE(radius("inf"), radius("0.5"));
}

}  // namespace
}  // namespace regather::cli
