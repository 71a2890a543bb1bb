#include "cli/fault.h"

#include <sys/resource.h>

#include "tests/cli/expect.h"
#include "tests/column.h"
#include "trace/npy.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;

TEST(Fault, AColumnThatIsCutShortWhileItIsReadIsNamed) {
    const Scratch scratch;
    const fs::path path = scratch / "column.npy";
    write_column<std::uint64_t>(path, std::vector<std::uint64_t>(100'000, 7));
    const pid_t child = ::fork();
    if (child == 0) {
        const int err = ::open((scratch / "err").c_str(), O_WRONLY | O_CREAT, 0600);
        ::dup2(err, STDERR_FILENO);
        tell_file_faults();
        const trace::MappedColumn column(path, trace::column_type<std::uint64_t>());
        if (::truncate(path.c_str(), 300) != 0) ::_exit(50);
        ::_exit(column.rows<std::uint64_t>()[90'000] == 7 ? 51 : 52);  // not reached
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), bad_data);
    EXPECT_EQ(
        content(scratch / "err"),
        "regather: " + fs::canonical(path).string() +
            ": found a file that was cut short while it was read, expected the file as it was opened\n");
}

/// Of this process, whose children inherit it: larger than anything that the test itself prints to a file.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

private:
    rlimit before_{};
};

TEST(Fault, AFileThatReachesTheLimitOfSizeIsAFailedRun) {
    const Scratch scratch;
    Outcome outcome;
    {
        const FileSizeLimit limit(2'000'000);
        outcome = Process({"capture", "box", "-o", (scratch / "box").string(), "--width", "4", "--height",
                           "4", "--gather-rays", "1", "--photons", "200000"})  // of 20 bytes
                      .outcome();
    }
    EXPECT_EQ(outcome.exit_code, run_failed) << outcome.err;
    EXPECT_THAT(outcome.err,
                testing::AllOf(testing::StartsWith("regather: "), testing::HasSubstr("File too large")));
    EXPECT_FALSE(fs::exists(scratch / "box/trace/trace.json"));
}

}  // namespace
}  // namespace regather::cli
