#include "trace/file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "tests/scratch.h"
#include "trace/error.h"

namespace regather::trace {
namespace {

using testing::HasSubstr;

template <class Error, class Call>
std::string message(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(File, WhatWasWrittenIsRead) {
    const Scratch scratch;
    const std::string bytes("a\0b\n\xff", 5);
    write_whole(scratch / "new/folder/x", bytes);
    EXPECT_EQ(read_file(scratch / "new/folder/x"), bytes);
    write_whole(scratch / "new/folder/x", "");
    EXPECT_EQ(read_file(scratch / "new/folder/x"), "");
    EXPECT_EQ(read_file("/proc/sys/kernel/ostype"), "Linux\n");  // of a file that says that it has 0 bytes
}

TEST(File, WhatIsNoFileOfBoundedSizeIsRefused) {
    const Scratch scratch;
    write_whole(scratch / "seven", "1234567");
    const auto refusal = [](const std::filesystem::path& path, std::uint64_t most) {
        return message<DataError>([&] { read_file(path, most); });
    };
    EXPECT_EQ(read_file(scratch / "seven", 7), "1234567");
    EXPECT_EQ(refusal(scratch / "seven", 6),
              (scratch / "seven").string() + ": found 7 bytes, expected a file of at most 6 bytes");
    EXPECT_THAT(refusal("/proc/sys/kernel/ostype", 5),
                testing::EndsWith("expected a file of at most 5 bytes"));
    // Where no size is at fault none is spoken of.
    EXPECT_EQ(refusal(scratch / "none", 6),
              (scratch / "none").string() + ": found no such file, expected a file");
    EXPECT_EQ(refusal(scratch.path(), 6), scratch.path().string() + ": found a folder, expected a file");
    EXPECT_THAT(refusal("/dev/zero", 6), HasSubstr("/dev/zero: found a device or a pipe"));
    ASSERT_EQ(::mkfifo((scratch / "pipe").c_str(), 0600), 0);
    EXPECT_THAT(refusal(scratch / "pipe", 6), HasSubstr("pipe: found a device or a pipe"));
    EXPECT_THAT(refusal(scratch / std::string(5000, 'x'), 6),
                HasSubstr("xxx...: found what cannot be read (File name"));
}

TEST(File, AFileThatCannotBeWrittenIsAsItWas) {
    const Scratch scratch;
    write_whole(scratch / "x", "before");
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{1000, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    const std::string refusal =
        message<std::runtime_error>([&] { write_whole(scratch / "x", std::string(5000, 'y')); });
    ::setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(refusal, (scratch / "x").string() + ": cannot be written: File too large");
    EXPECT_EQ(read_file(scratch / "x"), "before");
    EXPECT_FALSE(std::filesystem::exists(scratch / "x.partial"));

    std::filesystem::create_directory(scratch / "folder");
    EXPECT_THAT(message<std::runtime_error>([&] { write_whole(scratch / "folder", "y"); }),
                HasSubstr("folder: cannot be written"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "folder.partial"));
    EXPECT_THAT(message<std::runtime_error>([&] { write_whole(scratch / "x/y", "y"); }),
                HasSubstr("x/y: cannot be written"));
}

TEST(File, WhatIsThereIsOverwrittenOnlyByForce) {
    const Scratch scratch;
    const std::vector<std::filesystem::path> both{scratch / "a", scratch / "b"};
    EXPECT_NO_THROW(refuse_to_overwrite(both, false));
    std::filesystem::create_symlink("nowhere", scratch / "b");  // a rename would replace it
    EXPECT_EQ(message<UsageError>([&] { refuse_to_overwrite(both, false); }),
              (scratch / "b").string() + ": exists; --force overwrites it");
    EXPECT_NO_THROW(refuse_to_overwrite(both, true));
}

TEST(File, TheSecondOfTwoWritersIsRefused) {
    const Scratch scratch;
    const int other = ::open((scratch / "x.partial").c_str(), O_WRONLY | O_CREAT, 0600);
    ASSERT_EQ(::flock(other, LOCK_EX), 0);
    EXPECT_THAT(message<std::runtime_error>([&] { write_whole(scratch / "x", "mine"); }),
                HasSubstr("x: cannot be written: another process is writing it"));
    EXPECT_TRUE(std::filesystem::exists(scratch / "x.partial"));
    ::close(other);  // killed: what it left is overwritten
    write_whole(scratch / "x", "mine");
    EXPECT_EQ(read_file(scratch / "x"), "mine");
}

}  // namespace
}  // namespace regather::trace
