#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cli/commands.h"
#include "trace/error.h"
#include "trace/npy.h"

namespace regather::cli {
namespace {

using testing::HasSubstr;

class CachesimCommand : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  (std::string("cachesim ") + testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        trace::write_column<std::uint64_t>(file("addresses.npy"),
                                           std::vector<std::uint64_t>{0, 64, 128, 0, 64, 192});
        trace::write_column<std::uint8_t>(file("writes.npy"), std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0});
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    std::string content(const std::string& name) const {
        std::ifstream in(file(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }
    static void run(std::vector<std::string> arguments) {
        CLI::App app;
        add_cachesim(app);
        arguments.insert(arguments.begin(), "cachesim");
        std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
        app.parse(arguments);
    }
    static std::string usage_error(const std::vector<std::string>& arguments) {
        try {
            run(arguments);
        } catch (const trace::UsageError& error) {
            return error.what();
        }
        return "accepted";
    }

    std::filesystem::path folder_;
};

const std::string header = "policy,size_bytes,line_bytes,ways,accesses,misses,traffic_bytes\n";

// Lines of 64 bytes, * written:  0  1  2  0  1* 3        Lines of 128 bytes:  0  0  1  0  0* 1
//   128 bytes, 1 way (2 sets):   m  m  m  m  h  m, 1* goes    1 way (1 set):  m  h  m  m  h  m, 0* goes
//   128 bytes, full (2 ways):    m  m  m  m  m  m, 1* stays   full (1 way):   the same
//   256 bytes, 1 way (4 sets):   m  m  m  h  h  m, 1* stays   1 way (2 sets): m  h  m  h  h  h, 0* stays
//   256 bytes, full (4 ways):    m  m  m  h  h  m, 1* stays   full (2 ways):  the same
TEST_F(CachesimCommand, RowsComeInTheOrderAskedForWithHandCountedMisses) {
    run({file("addresses.npy"), "--writes", file("writes.npy"), "--size", "128,256", "--line", "64,128",
         "--ways", "1,full", "--csv", file("misses.csv")});
    EXPECT_EQ(content("misses.csv"), header +
                                         "lru,128,64,1,6,5,384\n"
                                         "lru,128,64,full,6,6,448\n"
                                         "lru,128,128,1,6,4,640\n"
                                         "lru,128,128,full,6,4,640\n"
                                         "lru,256,64,1,6,4,320\n"
                                         "lru,256,64,full,6,4,320\n"
                                         "lru,256,128,1,6,2,384\n"
                                         "lru,256,128,full,6,2,384\n");
}

TEST_F(CachesimCommand, SizesStraddleLines) {
    trace::write_column<std::uint32_t>(file("sizes.npy"), std::vector<std::uint32_t>{65, 64, 1, 1, 1, 129});
    // Lines: 0 1 | 1 | 2 | 0 | 1 | 3 4 5: 9 accesses, and each of the 6 lines is fetched once.
    run({file("addresses.npy"), "--sizes", file("sizes.npy"), "--size", "1K", "--line", "64", "--ways",
         "full", "--csv", file("misses.csv")});
    EXPECT_EQ(content("misses.csv"), header + "lru,1024,64,full,9,6,384\n");
}

TEST_F(CachesimCommand, DinTextGoesToStdoutWithoutACsv) {
    std::ofstream(file("program.din")) << "2 0\n0 40\n1 44\n2 4\n";
    testing::internal::CaptureStdout();
    run({file("program.din"), "--size", "4K", "--line", "64", "--ways", "2"});
    // Lines 0, 1, 1*, 0; the dirty line is written back at the end.
    EXPECT_EQ(testing::internal::GetCapturedStdout(), header + "lru,4096,64,2,4,2,192\n");
}

TEST_F(CachesimCommand, AFileIsOverwrittenOnlyByForce) {
    std::ofstream(file("misses.csv")) << "precious";
    std::vector<std::string> arguments{
        file("addresses.npy"), "--size", "1K", "--line", "64", "--ways", "1", "--csv", file("misses.csv")};
    EXPECT_THAT(usage_error(arguments), HasSubstr("misses.csv: found a file, expected none"));
    EXPECT_EQ(content("misses.csv"), "precious");
    arguments.push_back("--force");
    EXPECT_EQ(usage_error(arguments), "accepted");
    EXPECT_EQ(content("misses.csv"), header + "lru,1024,64,1,6,4,256\n");
    EXPECT_EQ(files(), 3u);  // two columns and the table: nothing temporary is left
}

TEST_F(CachesimCommand, ARefusedTraceLeavesNoTable) {
    std::ofstream(file("program.din")) << "0 0\n0 zero\n";
    EXPECT_THROW(run({file("program.din"), "--size", "1K", "--line", "64", "--ways", "1", "--csv",
                      file("misses.csv")}),
                 trace::DataError);
    EXPECT_EQ(files(), 3u);
}

TEST_F(CachesimCommand, ImpossibleRequestsSayWhatWasFound) {
    const auto with = [&](const char* size, const char* line, const char* ways) {
        return usage_error({file("addresses.npy"), "--size", size, "--line", line, "--ways", ways});
    };
    EXPECT_THAT(with("1K,1000", "64", "1"),
                HasSubstr("--size 1000 --line 64 --ways 1: size_bytes: found 1000, expected"));
    EXPECT_THAT(with("1K", "48", "1"), HasSubstr("line_bytes: found 48, expected a power of two"));
    EXPECT_THAT(with("1K", "64", "8,3"), HasSubstr("--ways 3: ways: found 3 ways of 16 lines"));
    EXPECT_THAT(with("1K", "64", "0"), HasSubstr("--ways: found '0'"));
    EXPECT_THAT(with("1K", "64", "all"),
                HasSubstr("--ways: found 'all', expected a number from 1 up, or full"));
    EXPECT_THAT(with("1K,", "64", "1"), HasSubstr("size: found ''"));
    EXPECT_THAT(with("1K", "4G", "1"), HasSubstr("--line: found 4G"));
}

TEST_F(CachesimCommand, HelpShowsTwoExamples) {
    CLI::App app;
    add_cachesim(app);
    const std::string help = app.get_subcommand("cachesim")->help();
    EXPECT_THAT(help, HasSubstr("regather cachesim addresses.npy --size 16K,128K"));
    EXPECT_THAT(help, HasSubstr("regather cachesim program.din"));
}

}  // namespace
}  // namespace regather::cli
