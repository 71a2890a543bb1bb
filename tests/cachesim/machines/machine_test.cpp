#include "cachesim/machines/machine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "tests/scratch.h"
#include "trace/error.h"

namespace regather::cachesim {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::StartsWith;

const std::string good = R"({
  "name": "toy",
  "summary": "two levels",
  "levels": [
    {"name": "L1", "size_bytes": 1024, "line_bytes": 128, "ways": 4, "sector_bytes": 32, "policy": "plru",
     "write": "through", "write_miss": "no-allocate", "victim_lines": 3, "prefetch": "tagged",
     "sources": {"ways": "a manual", "size_bytes": "assumed"}},
    {"name": "L2", "size_bytes": 12288, "line_bytes": 128, "ways": "full", "sector_bytes": 32, "policy": "random",
     "seed": 18446744073709551615, "index": "hashed", "inclusion": "inclusive"}
  ],
  "dram": {"channels": 3, "ranks": 2, "banks": 8, "row_bytes": 2048, "burst_bytes": 32, "channel_bytes": 256,
           "bank_hash": "xor-row", "activate_pj": 909, "read_pj": 10, "write_pj": 11}
})";

TEST(Machine, IsReadWithEveryKey) {
    const Machine machine = parse_machine(good, "toy.json");
    EXPECT_EQ(machine.name, "toy");
    EXPECT_EQ(machine.summary, "two levels");
    ASSERT_EQ(machine.levels.size(), 2u);
    const LevelConfig &near = machine.levels[0], &far = machine.levels[1];
    EXPECT_EQ(near.name, "L1");
    EXPECT_EQ(near.cache.geometry.size_bytes, 1024u);
    EXPECT_EQ(near.cache.geometry.line_bytes, 128u);
    EXPECT_EQ(near.cache.geometry.ways, 4u);
    EXPECT_EQ(near.sector_bytes, 32u);
    EXPECT_EQ(near.cache.policy, Policy::plru);
    EXPECT_EQ(near.cache.write, WritePolicy::through);
    EXPECT_EQ(near.cache.write_miss, WriteMiss::no_allocate);
    EXPECT_EQ(near.victim_lines, 3u);
    EXPECT_EQ(near.prefetch, Prefetch::tagged);
    EXPECT_EQ(near.inclusion, Inclusion::neither);
    EXPECT_THAT(machine.sources[0],
                ElementsAre(Field(&Source::key, "size_bytes"), Field(&Source::text, "a manual")));
    EXPECT_EQ(far.cache.geometry.ways, fully_associative);
    EXPECT_EQ(far.cache.policy, Policy::random);
    EXPECT_EQ(far.cache.seed, ~std::uint64_t{0});
    EXPECT_EQ(far.cache.index, SetIndex::hashed);
    EXPECT_EQ(far.inclusion, Inclusion::inclusive);
    ASSERT_TRUE(machine.dram);
    EXPECT_EQ(machine.dram->channels, 3u);
    EXPECT_EQ(machine.dram->ranks, 2u);
    EXPECT_EQ(machine.dram->banks, 8u);
    EXPECT_EQ(machine.dram->row_bytes, 2048u);
    EXPECT_EQ(machine.dram->burst_bytes, 32u);
    EXPECT_EQ(machine.dram->channel_bytes, 256u);
    EXPECT_EQ(machine.dram->bank_hash, BankHash::xor_row);
    EXPECT_EQ(machine.dram->activate_pj, 909u);
    EXPECT_EQ(machine.dram->read_pj, 10u);
    EXPECT_EQ(machine.dram->write_pj, 11u);
    EXPECT_EQ(machine.hierarchy().levels(), 2u);
}

TEST(Machine, NeedsNoMoreThanAGeometry) {
    const Machine machine = parse_machine(
        R"({"name": "m", "levels": [{"name": "L1", "size_bytes": 96, "line_bytes": 32, "ways": 1}]})", "m");
    EXPECT_EQ(machine.levels[0].cache.policy, Policy::lru);
    EXPECT_EQ(machine.levels[0].cache.write, WritePolicy::back);
    EXPECT_EQ(machine.levels[0].sector(), 32u);
    EXPECT_EQ(machine.levels[0].cache.sets(), 3u);
    EXPECT_FALSE(machine.dram);
}

/// A message less the line of the value that it is about.
std::string without_line(const std::string& message) {
    return std::regex_replace(message, std::regex(R"(: line \d+, (?!column))"), ": ");
}

/// The message for `good` with one text replaced by another.
std::string refusal(const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    if (at == text.npos) throw std::logic_error("not in the file: " + from);
    text.replace(at, from.size(), to);
    try {
        parse_machine(text, "toy.json");
    } catch (const trace::DataError& error) {
        return without_line(error.what());
    }
    return "none";
}

TEST(Machine, RefusesABadFileWithOneLineThatNamesTheField) {
    const struct {
        std::string from, to, message;
    } cases[] = {
        {R"("policy": "plru")", R"("polcy": "plru")",
         "levels[0].polcy: found unknown key \"polcy\", expected \"policy\" (keys of a level: name, "
         "size_bytes,"},
        {R"("name": "toy")", R"("nam": "toy")", "nam: found unknown key \"nam\", expected \"name\""},
        {R"("name": "toy",)", "", "name: found nothing, expected a name of 1 to 64"},
        {R"("name": "toy")", R"("name": "a b")", "name: found \"a b\", expected a name of 1 to 64"},
        {R"("name": "toy")", R"("name": "")", "name: found \"\", expected a name of 1 to 64"},
        {R"("name": "L2")", R"("name": "L1")", "levels[1].name: found L1, expected another name"},
        {R"("summary": "two levels")", R"("summary": "two\nlines")",
         "summary: found \"two\\nlines\", expected one line"},
        {R"("summary": "two levels")", R"("summary": 3)", "summary: found 3, expected a text"},
        {R"("ways": 4)", R"("ways": 0)",
         "levels[0].ways: found 0, expected a whole number of ways from 1 up"},
        {R"("ways": 4)", R"("ways": 4.5)", "levels[0].ways: found 4.5, expected a whole number of ways"},
        {R"("ways": 4)", R"("ways": -4)", "levels[0].ways: found -4, expected a whole number of ways"},
        {R"("ways": 4)", R"("ways": 1e30)", "levels[0].ways: found 1e+30, expected a whole number of ways"},
        {R"("ways": 4)", R"("ways": 4294967296)",
         "levels[0].ways: found 4294967296, expected a whole number of ways from 1 up, or \"full\", at most"},
        {R"("ways": 4)", R"("ways": 99999999999999999999999)", "levels[0].ways: found 1e+23, expected"},
        {R"("ways": 4)", R"("ways": 1e999)", "line 5, column 67: found 1e999, expected a number from -1.7"},
        {R"("ways": 4)", R"("ways": "all")",
         "levels[0].ways: found \"all\", expected a whole number of ways"},
        {R"("ways": 4)", R"("ways": true)", "levels[0].ways: found true, expected"},
        {R"("ways": 4)", R"("ways": [4])", "levels[0].ways: found a list of 1, expected"},
        {R"("ways": 4)", R"("ways": 3)", "levels[0].ways: found 3"},
        {R"("line_bytes": 128)", R"("line_bytes": 4096)",
         "levels[0].size_bytes: found 1024, expected a multiple"},
        {R"("line_bytes": 128)", R"("line_bytes": 96)",
         "levels[0].line_bytes: found 96, expected a power of two"},
        {R"("line_bytes": 128)", R"("line_bytes": 0)",
         "levels[0].line_bytes: found 0, expected a power of two"},
        {R"("line_bytes": 128)", R"("line_bytes": 64)",
         "levels[1].line_bytes: found 128, expected 64 as in levels[0]"},
        {R"("size_bytes": 12288)", R"("size_bytes": 18446744073709551488)",
         "levels[1].size_bytes: found 18446744073709551488, which is"},
        {R"("size_bytes": 12288)", R"("size_bytes": 4294967296)",
         "levels[1].size_bytes: found 4294967296, expected at most 16777216 lines"},
        {R"("size_bytes": 12288)", R"("size_bytes": 0)",
         "levels[1].size_bytes: found 0, expected a multiple"},
        {R"("sector_bytes": 32)", R"("sector_bytes": 0)",
         "levels[0].sector_bytes: found 0, expected a power of two"},
        {R"("sector_bytes": 32)", R"("sector_bytes": 256)",
         "levels[0].sector_bytes: found 256, expected a power of two from 4 to"},
        {R"("policy": "plru")", R"("policy": "opt")",
         "levels[0].policy: found \"opt\", expected \"lru\", \"fifo\", \"plru\", \"srrip\" or \"random\""},
        {R"("write": "through")", R"("write": 1)",
         "levels[0].write: found 1, expected \"back\" or \"through\""},
        {R"("inclusion": "inclusive")", R"("inclusion": "maybe")",
         "levels[1].inclusion: found \"maybe\", expected \"neither\""},
        {R"("inclusion": "inclusive")", R"("inclusion": "exclusive")",
         "levels[0].write: found through, expected back"},
        {R"("victim_lines": 3)", R"("victim_lines": 1000000)",
         "levels[0].victim_lines: found 1000000, expected 0 to 4096"},
        {R"("ways": "a manual")", R"("way": "a manual")",
         "levels[0].sources.way: found unknown key \"way\", expected \"ways\""},
        {R"("ways": "a manual")", R"("ways": 7)", "levels[0].sources.ways: found 7, expected a text"},
        {R"("banks": 8)", R"("banks": 6)", "dram.banks: found 6, expected a power of two from 1 to 1024"},
        {R"("channels": 3)", R"("channels": 4000000000)",
         "dram.channels: found 4000000000, expected at most 1048576 banks"},
        {R"("read_pj": 10, )", "", "dram.read_pj: found nothing, expected a whole number of picojoules"},
        {R"("read_pj": 10)", R"("read_pj": 0.5)",
         "dram.read_pj: found 0.5, expected a whole number of picojoules"},
        {R"("read_pj": 10)", R"("read_pj": 10, "read_pj": 11)",
         "line 12, column 71: found the key \"read_pj\" a second time"},
        {R"("dram": {)", R"("dram": [{}], "dram2": {)",
         "dram2: found unknown key \"dram2\", expected \"dram\""},
        {R"("channels": 3)", R"("channels": [[[[[[[[[[3]]]]]]]]]])",
         "dram.channels: found a list of 1, expected a whole number"},
        {R"("name": "toy",)", R"("name": "toy")",
         "line 3, column 3: found another text, expected ',' or '}'"},
    };
    for (const auto& [from, to, message] : cases) {
        const std::string found = refusal(from, to);
        EXPECT_THAT(found, StartsWith("toy.json: " + message)) << to;
        EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), 0) << found;
    }
}

TEST(Machine, RefusesTextThatIsNoMachine) {
    const auto message = [](const std::string& text) -> std::string {
        try {
            parse_machine(text, "m.json");
        } catch (const trace::DataError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_THAT(message(""), StartsWith("m.json: line 1, column 1: "));
    EXPECT_EQ(message("[]"), "m.json: line 1: found an empty list, expected an object");
    EXPECT_EQ(message("3"), "m.json: line 1: found 3, expected an object");
    EXPECT_EQ(message(R"({"name": "m", "levels": []})"),
              "m.json: line 1, levels: found an empty list, expected a list of 1 to 4 levels, nearest first");
    EXPECT_EQ(message(R"({"name": "m", "levels": {}})"),
              "m.json: line 1, levels: found an object, expected a list of 1 to 4 levels, nearest first");
    EXPECT_EQ(message(R"({"name": "m", "levels": [7]})"),
              "m.json: line 1, levels[0]: found 7, expected an object");
    EXPECT_EQ(message(std::string(1'000'000, '[')),
              "m.json: line 1, column 65: found objects or lists 65 deep, expected at most 64");
    EXPECT_THAT(message("{\"name\": \"\xff\"}"), StartsWith("m.json: line 1, column "));
    // Cut anywhere, a file is refused: no part of one passes for a whole one.
    for (std::size_t length = 0; length < good.size(); ++length)
        EXPECT_THAT(message(good.substr(0, length)), StartsWith("m.json: line ")) << length;
}

TEST(Machine, IsFoundByItsNameOrInAFile) {
    EXPECT_EQ(load_machine("paper-128k").name, "paper-128k");
    const Scratch scratch;
    const std::filesystem::path path = scratch / "mine.json";
    std::ofstream(path) << good;
    EXPECT_EQ(load_machine(path.string()).name, "toy");
    const auto message = [](const std::string& name) -> std::string {
        try {
            load_machine(name);
        } catch (const trace::DataError& error) {
            return std::string("data: ") + error.what();
        } catch (const trace::UsageError& error) {
            return std::string("usage: ") + error.what();
        }
        return "none";
    };
    EXPECT_THAT(message("paper-128"),
                StartsWith("usage: found the unknown machine 'paper-128', expected \"paper-128k\""));
    EXPECT_EQ(message((scratch / "none.json").string()),
              "data: " + (scratch / "none.json").string() + ": found no such file, expected a file");
    EXPECT_THAT(message((scratch / "").string()), HasSubstr("found a folder"));
    EXPECT_THAT(message("/dev/zero"), HasSubstr("found a device or a pipe"));
}

// ---- the embedded ones ----

TEST(EmbeddedMachines, SayWhereEachFigureIsFrom) {
    for (const EmbeddedMachine& row : machine_catalogue()) {
        const Machine machine = load_machine(row.name);
        EXPECT_EQ(machine.name, row.name);
        EXPECT_NE(machine.summary, "");
        const auto sourced = [](const std::vector<Source>& sources, std::string_view key) {
            return std::any_of(sources.begin(), sources.end(), [&](const Source& s) { return s.key == key; });
        };
        for (std::size_t i = 0; i < machine.levels.size(); ++i)
            for (const std::string_view key : {"size_bytes", "line_bytes", "ways", "policy"})
                EXPECT_TRUE(sourced(machine.sources[i], key)) << row.name << " " << i << " " << key;
        ASSERT_TRUE(machine.dram);
        for (const std::string_view key : {"channels", "ranks", "banks", "row_bytes", "burst_bytes",
                                           "channel_bytes", "activate_pj", "read_pj", "write_pj"})
            EXPECT_TRUE(sourced(machine.dram_sources, key)) << row.name << " " << key;
    }
}

TEST(EmbeddedMachines, HaveTheSetsOfTheRealOnes) {
    const auto sets = [](std::string_view name, std::size_t level) {
        return load_machine(name).levels[level].cache.sets();
    };
    EXPECT_EQ(sets("paper-128k", 0), 128u);
    EXPECT_EQ(sets("cpu-sapphire-rapids", 0), 64u);  // the line's bits 6 to 11: within a page of 4 KB
    EXPECT_EQ(sets("cpu-sapphire-rapids", 1), 2048u);
    EXPECT_EQ(sets("cpu-sapphire-rapids", 2), 2048u);  // of one slice
    EXPECT_EQ(sets("gpu-a100", 0), 4u);
    EXPECT_EQ(sets("gpu-a100", 1), 20480u);
}

// Micron TN-40-07: currents [mA] x V x clocks x ns = pJ a device; 8 devices.
TEST(EmbeddedMachines, DramEnergyFollowsFromTheCurrentsOfTheDataSheet) {
    const DramConfig ddr4 = *load_machine("paper-128k").dram;
    const double volt = 1.2, clock = 0.833, devices = 8;
    EXPECT_NEAR(ddr4.activate_pj, volt * (48 * 55 - 43 * 39 - 34 * 16) * clock * devices, 0.5);
    EXPECT_NEAR(ddr4.read_pj, volt * (135 - 43) * 4 * clock * devices, 0.5);
    EXPECT_NEAR(ddr4.write_pj, volt * (123 - 43) * 4 * clock * devices, 0.5);
    const DramConfig hbm2 = *load_machine("gpu-a100").dram;
    EXPECT_NEAR(hbm2.read_pj, (1.51 + 1.17 + 0.80) * 256, 0.5);
}

}  // namespace
}  // namespace regather::cachesim
