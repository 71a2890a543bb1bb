#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "tests/cli/expect.h"
#include "tests/column.h"
#include "trace/npy.h"

namespace regather::cli {
namespace {

using testing::HasSubstr;

/// The lines of a CSV without what the cache does with writes, its index and its seed: without the last four
/// cells.
std::string counts(const std::string& csv) {
    std::istringstream lines(csv);
    std::string out;
    for (std::string line; std::getline(lines, line);) {
        for (int cell = 0; cell < 4; ++cell) line.resize(line.rfind(','));
        out += line + '\n';
    }
    return out;
}

class CachesimCommand : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  (std::string("cachesim ") + testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        write_column<std::uint64_t>(file("addresses.npy"),
                                    std::vector<std::uint64_t>{0, 64, 128, 0, 64, 192});
        write_column<std::uint8_t>(file("writes.npy"), std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0});
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    std::string content(const std::string& name) const { return cli::content(file(name)); }
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }
    static Outcome outcome(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "cachesim");
        return regather(arguments);
    }
    /// What is printed, when all is well.
    static std::string run(const std::vector<std::string>& arguments) {
        const Outcome made = outcome(arguments);
        EXPECT_EQ(made.exit_code, 0);
        EXPECT_EQ(made.err, "");
        return made.out;
    }
    static std::string usage_error(const std::vector<std::string>& arguments) {
        const Outcome made = outcome(arguments);
        if (made.exit_code == 0) return "accepted";
        EXPECT_EQ(made.exit_code, bad_usage) << made.err;
        return made.err;
    }

    std::filesystem::path folder_;
};

const std::string header =
    "policy,size_bytes,line_bytes,ways,accesses,hits,misses,compulsory,capacity,conflict,writebacks,"
    "writes_through,traffic_bytes\n";

// Lines of 64 bytes, * written:  0  1  2  0  1* 3        Lines of 128 bytes:  0  0  1  0  0* 1
//   128 bytes, 1 way (2 sets):   m  m  m  m  h  m, 1* goes    1 way (1 set):  m  h  m  m  h  m, 0* goes
//   128 bytes, full (2 ways):    m  m  m  m  m  m, 1* stays   full (1 way):   the same
//   256 bytes, 1 way (4 sets):   m  m  m  h  h  m, 1* stays   1 way (2 sets): m  h  m  h  h  h, 0* stays
//   256 bytes, full (4 ways):    m  m  m  h  h  m, 1* stays   full (2 ways):  the same
TEST_F(CachesimCommand, RowsComeInTheOrderAskedForWithHandCountedMisses) {
    run({file("addresses.npy"), "--writes", file("writes.npy"), "--size", "128,256", "--line", "64,128",
         "--ways", "1,full", "--csv", file("misses.csv")});
    EXPECT_EQ(counts(content("misses.csv")), header +
                                                 "lru,128,64,1,6,1,5,4,1,0,1,0,384\n"
                                                 "lru,128,64,full,6,0,6,4,2,0,1,0,448\n"
                                                 "lru,128,128,1,6,2,4,2,2,0,1,0,640\n"
                                                 "lru,128,128,full,6,2,4,2,2,0,1,0,640\n"
                                                 "lru,256,64,1,6,2,4,4,0,0,1,0,320\n"
                                                 "lru,256,64,full,6,2,4,4,0,0,1,0,320\n"
                                                 "lru,256,128,1,6,4,2,2,0,0,1,0,384\n"
                                                 "lru,256,128,full,6,4,2,2,0,0,1,0,384\n");
}

TEST_F(CachesimCommand, RowsSayHowWritesWereTreatedAndWhichSetALineGoesTo) {
    const std::string table =
        run({file("addresses.npy"), "--size", "1K", "--line", "64", "--ways", "2", "--policy", "lru,random",
             "--write", "through", "--write-miss", "no-allocate", "--index", "hashed", "--seed", "7", "--csv",
             file("misses.csv")});
    EXPECT_THAT(table, testing::StartsWith("policy  size_bytes  line_bytes  ways  "));
    EXPECT_THAT(content("misses.csv"), HasSubstr(",traffic_bytes,write,write_miss,index,seed\nlru,"));
    EXPECT_THAT(content("misses.csv"), HasSubstr(",through,no-allocate,hashed,\nrandom,"));
    EXPECT_THAT(content("misses.csv"), testing::EndsWith(",through,no-allocate,hashed,7\n"));
    EXPECT_THAT(content("misses.json"), HasSubstr("\"results\": \"misses.csv\""));
}

TEST_F(CachesimCommand, SizesStraddleLines) {
    write_column<std::uint32_t>(file("sizes.npy"), std::vector<std::uint32_t>{65, 64, 1, 1, 1, 129});
    // Lines: 0 1 | 1 | 2 | 0 | 1 | 3 4 5: 9 accesses, and each of the 6 lines is fetched once.
    run({file("addresses.npy"), "--sizes", file("sizes.npy"), "--size", "1K", "--line", "64", "--ways",
         "full", "--csv", file("misses.csv")});
    EXPECT_EQ(counts(content("misses.csv")), header + "lru,1024,64,full,9,3,6,6,0,0,0,0,384\n");
}

TEST_F(CachesimCommand, DinTextGoesToStdoutWithoutACsv) {
    std::ofstream(file("program.din")) << "2 0\n0 40\n1 44\n2 4\n";
    // Lines 0, 1, 1*, 0; the dirty line is written back at the end.
    EXPECT_EQ(counts(run({file("program.din"), "--size", "4K", "--line", "64", "--ways", "2"})),
              header + "lru,4096,64,2,4,2,2,2,0,0,1,0,192\n");
}

/// The rows of tests/cachesim/din/NAME.din, whose outcomes stand in its comments, access by access.
class WorkedByHand : public CachesimCommand {
protected:
    void SetUp() override {
        CachesimCommand::SetUp();
        source_ = std::getenv("REGATHER_SOURCE_DIR");
        if (source_ == nullptr) GTEST_SKIP() << "REGATHER_SOURCE_DIR is set by ctest";
    }
    std::string rows(const std::string& name, std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), std::string(source_) + "/tests/cachesim/din/" + name);
        const Outcome made = outcome(arguments);  // with a note of the comments behind the addresses
        EXPECT_EQ(made.exit_code, 0) << made.err;
        const std::string table = counts(made.out);
        EXPECT_EQ(table.substr(0, header.size()), header);
        return table.substr(header.size());
    }

    const char* source_ = nullptr;
};

TEST_F(WorkedByHand, BeladysString) {
    EXPECT_EQ(rows("belady.din",
                   {"--size", "192,256", "--line", "64", "--ways", "full", "--policy", "fifo,lru,opt"}),
              "fifo,192,64,full,12,3,9,5,4,0,0,0,576\n"
              "lru,192,64,full,12,2,10,5,5,0,0,0,640\n"
              "opt,192,64,full,12,5,7,5,2,0,0,0,448\n"
              "fifo,256,64,full,12,2,10,5,3,2,0,0,640\n"
              "lru,256,64,full,12,4,8,5,3,0,0,0,512\n"
              "opt,256,64,full,12,6,6,5,1,0,0,0,384\n");
}

TEST_F(WorkedByHand, AScanThroughFourWays) {
    EXPECT_EQ(
        rows("scan.din", {"--size", "256", "--line", "64", "--ways", "4", "--policy", "lru,plru,srrip,opt"}),
        "lru,256,64,4,10,2,8,6,2,0,0,0,512\n"
        "plru,256,64,4,10,3,7,6,1,0,0,0,448\n"
        "srrip,256,64,4,10,4,6,6,0,0,0,0,384\n"
        "opt,256,64,4,10,4,6,6,0,0,0,0,384\n");
}

TEST_F(WorkedByHand, FourWaysToWrite) {
    const auto row = [&](const char* write, const char* write_miss) {
        return rows("writes.din", {"--size", "128", "--line", "64", "--ways", "2", "--write", write,
                                   "--write-miss", write_miss});
    };
    EXPECT_EQ(row("back", "allocate"), "lru,128,64,2,7,2,5,3,2,0,3,0,512\n");
    EXPECT_EQ(row("through", "allocate"), "lru,128,64,2,7,2,5,3,2,0,0,3,332\n");
    EXPECT_EQ(row("back", "no-allocate"), "lru,128,64,2,7,3,4,3,1,0,1,2,200\n");
    EXPECT_EQ(row("through", "no-allocate"), "lru,128,64,2,7,3,4,3,1,0,0,3,140\n");
}

TEST_F(WorkedByHand, AStrideThroughTheSets) {
    EXPECT_EQ(rows("stride.din", {"--size", "256,192", "--line", "64", "--ways", "1"}),
              "lru,256,64,1,8,0,8,4,0,4,0,0,512\n"
              "lru,192,64,1,8,3,5,4,1,0,0,0,320\n");
    EXPECT_EQ(rows("stride.din", {"--size", "256", "--line", "64", "--ways", "1", "--index", "hashed"}),
              "lru,256,64,1,8,4,4,4,0,0,0,0,256\n");
    EXPECT_EQ(rows("stride.din", {"--size", "256", "--line", "64", "--ways", "1", "--no-3c"}),
              "lru,256,64,1,8,0,8,,,,0,0,512\n");
}

TEST_F(WorkedByHand, RandomRepeatsWithItsSeed) {
    const auto row = [&](const char* seed) {
        return rows("belady.din", {"--size", "192", "--line", "64", "--ways", "full", "--policy", "random",
                                   "--seed", seed});
    };
    std::set<std::string> different;
    for (const char* const seed : {"0", "1", "2", "3", "4", "5", "6", "7"}) {
        different.insert(row(seed));
        EXPECT_EQ(row(seed), row(seed));
    }
    EXPECT_GT(different.size(), 1u);
}

TEST_F(CachesimCommand, AFileIsOverwrittenOnlyByForce) {
    std::ofstream(file("misses.csv")) << "precious";
    std::vector<std::string> arguments{
        file("addresses.npy"), "--size", "1K", "--line", "64", "--ways", "1", "--csv", file("misses.csv")};
    EXPECT_THAT(usage_error(arguments), HasSubstr("misses.csv: exists; --force overwrites it"));
    EXPECT_EQ(content("misses.csv"), "precious");
    arguments.push_back("--force");
    EXPECT_EQ(usage_error(arguments), "accepted");
    EXPECT_EQ(counts(content("misses.csv")), header + "lru,1024,64,1,6,2,4,4,0,0,0,0,256\n");
    EXPECT_EQ(files(), 4u);  // two columns, rows and their provenance: nothing temporary is left
}

TEST_F(CachesimCommand, ARefusedTraceLeavesNoTable) {
    std::ofstream(file("program.din")) << "0 0\n0 zero\n";
    EXPECT_EQ(outcome({file("program.din"), "--size", "1K", "--line", "64", "--ways", "1", "--csv",
                       file("misses.csv")})
                  .exit_code,
              bad_data);
    EXPECT_EQ(files(), 3u);
}

TEST_F(CachesimCommand, ImpossibleRequestsSayWhatWasFound) {
    const auto with = [&](const char* size, const char* line, const char* ways) {
        return usage_error({file("addresses.npy"), "--size", size, "--line", line, "--ways", ways});
    };
    EXPECT_THAT(with("1000", "64", "1"),
                HasSubstr("--size 1000 --line 64 --ways 1 --policy lru: size_bytes: found 1000, expected"));
    EXPECT_THAT(with("1K", "48", "1"), HasSubstr("line_bytes: found 48, expected a power of two"));
    EXPECT_THAT(with("1K", "64", "3"), HasSubstr("--ways 3 --policy lru: ways: found 3 ways of 16 lines"));
    EXPECT_THAT(with("1K", "64", "0"), HasSubstr("ways: found '0'"));
    EXPECT_THAT(with("1K", "64", "all"),
                HasSubstr("ways: found 'all', expected a whole number from 1 to 4294967295, or full"));
    EXPECT_THAT(with("1K,", "64", "1"), HasSubstr("size: found ''"));
    EXPECT_THAT(with("1K", "4G", "1"), HasSubstr("line: found '4G'"));
}

TEST_F(CachesimCommand, ImpossiblePoliciesSayWhatWasFound) {
    const auto with = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {file("addresses.npy"), "--size", "768", "--line", "64", "--ways", "3"});
        return usage_error(words);
    };
    EXPECT_EQ(with({"--policy", "lru,srrip,opt", "--csv", file("misses.csv")}), "accepted");
    EXPECT_THAT(
        with({"--policy", "plru"}),
        HasSubstr("--ways 3 --policy plru: ways: found 3 ways with policy plru, expected a power of"));
    EXPECT_THAT(with({"--policy", "mru"}), HasSubstr("policy: found 'mru', expected one of: lru, fifo"));
    EXPECT_THAT(with({"--policy", "lru,"}), HasSubstr("policy: found ''"));
    EXPECT_THAT(with({"--write", "around"}),
                HasSubstr("write: found 'around', expected one of: back, through"));
    EXPECT_THAT(with({"--write-miss", "no"}), HasSubstr("write_miss: found 'no'"));
    EXPECT_THAT(with({"--index", "prime"}),
                HasSubstr("index: found 'prime', expected one of: modulo, hashed"));
    EXPECT_EQ(with({"--index", "hashed", "--no-3c", "--csv", file("hashed.csv")}), "accepted");  // 4 sets
    EXPECT_THAT(with({"--policy", "opt", "--write-miss", "no-allocate"}),
                HasSubstr("write_miss: found no-allocate with policy opt"));
    EXPECT_THAT(with({"--policy", "opt", "--opt-limit", "5", "--csv", file("opt.csv")}),
                HasSubstr("policy opt: found more than 5 line accesses"));
    EXPECT_FALSE(std::filesystem::exists(file("opt.csv")));
}

TEST_F(CachesimCommand, AnImpossibleCombinationIsLeftOutAndSaid) {
    const Outcome made =
        outcome({file("addresses.npy"), "--size", "1K,1000", "--line", "64", "--ways", "1,3"});
    EXPECT_EQ(made.exit_code, 0);
    EXPECT_EQ(counts(made.out), header + "lru,1024,64,1,6,2,4,4,0,0,0,0,256\n");
    EXPECT_EQ(std::count(made.err.begin(), made.err.end(), '\n'), 3) << made.err;
    for (const char* left_out : {"--size 1024 --line 64 --ways 3", "--size 1000 --line 64 --ways 1",
                                 "--size 1000 --line 64 --ways 3"})
        EXPECT_THAT(made.err, HasSubstr(std::string("regather: left out ") + left_out));
    EXPECT_THAT(usage_error({file("addresses.npy"), "--size", "1000", "--line", "64", "--ways", "1,3"}),
                HasSubstr("--size 1000 --line 64 --ways 1"));
    EXPECT_THAT(usage_error({file("addresses.npy"), "--size", "1K,1024", "--line", "64", "--ways", "1"}),
                HasSubstr("found twice"));
}

TEST_F(CachesimCommand, AllLruTellsWhatEachCacheAskedForAloneTells) {
    std::vector<std::uint64_t> addresses;
    for (std::uint64_t i = 0; i < 20'000; ++i) addresses.push_back(i * i % 977 * 40 + i % 3 * 4096);
    write_column<std::uint64_t>(file("many.npy"), addresses);
    run({file("many.npy"), "--all-lru", "--line", "64,128", "--csv", file("all.csv")});
    run({file("many.npy"), "--size", "4K,16K", "--line", "64,128", "--ways", "1,8,full", "--csv",
         file("some.csv")});
    const std::string all = content("all.csv");
    std::istringstream some(content("some.csv"));
    std::size_t rows = 0;
    for (std::string row; std::getline(some, row); ++rows) EXPECT_THAT(all, HasSubstr(row + '\n'));
    EXPECT_EQ(rows, 1u + 12u);
    EXPECT_THAT(usage_error({file("many.npy"), "--all-lru"}), HasSubstr("--line"));
    EXPECT_THAT(usage_error({file("many.npy"), "--all-lru", "--line", "64", "--ways", "33"}),
                HasSubstr("--ways"));
}

TEST_F(CachesimCommand, AllLruLeavesTheTrafficOfATraceWithWritesOpen) {
    run({file("addresses.npy"), "--writes", file("writes.npy"), "--all-lru", "--line", "64", "--no-3c",
         "--csv", file("all.csv")});
    // 0 64 128 0 64 192: one set of one way misses always.
    EXPECT_THAT(content("all.csv"), HasSubstr("lru,64,64,1,6,0,6,,,,,,,back,allocate,modulo,\n"));
}

}  // namespace
}  // namespace regather::cli
