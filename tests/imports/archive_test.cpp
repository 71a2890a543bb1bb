#include "imports/archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/imports/archive.h"
#include "tests/scratch.h"

namespace regather::imports {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string text(const std::vector<std::uint8_t>& bytes) {
    return {bytes.begin(), bytes.end()};
}

void put32(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes.at(at + i) = static_cast<std::uint8_t>(value >> (8 * i));
}

TEST(Zip, WhatWasPutInComesOut) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"one.txt", "first"}, {"folder/two", std::string(100'000, 'x')}});
    const Zip zip = Zip::open(scratch / "a.zip");
    EXPECT_THAT(zip.names(), ElementsAre("one.txt", "folder/two"));
    EXPECT_TRUE(zip.has("one.txt"));
    EXPECT_FALSE(zip.has("two"));
    EXPECT_EQ(text(zip.read("one.txt", 5)), "first");
    EXPECT_EQ(text(zip.read("folder/two", 1'000'000)), std::string(100'000, 'x'));
}

TEST(Zip, AnArchiveWithinAnArchiveIsReadFromMemory) {
    const Scratch scratch;
    write_zip(scratch / "inner.zip", {{"deep", "treasure"}});
    write_zip(scratch / "outer.jar", {{"inner.zip", trace::read_file(scratch / "inner.zip")}});
    Zip inner =
        Zip::from_bytes(Zip::open(scratch / "outer.jar").read("inner.zip", 1000), "outer.jar: inner.zip");
    const Zip moved = std::move(inner);
    EXPECT_EQ(moved.archive(), "outer.jar: inner.zip");
    EXPECT_EQ(text(moved.read("deep", 100)), "treasure");
}

TEST(Zip, AnEntryLargerThanAllowedIsNamedWithItsArchive) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"big", std::string(1001, 'x')}});
    const Zip zip = Zip::open(scratch / "a.zip");
    EXPECT_EQ(zip.read("big", 1001).size(), 1001u);
    EXPECT_THAT(data_error([&] { zip.read("big", 1000); }),
                HasSubstr("a.zip: big: found 1001 bytes, expected at most 1000"));
    EXPECT_THAT(data_error([&] { zip.read("bg", 1000); }), HasSubstr("a.zip: bg: found no such entry"));
}

TEST(Zip, AnEntryThatDeclaresFourGigabytesCostsNothing) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"bomb", "tiny"}});
    std::vector<std::uint8_t> bytes = bytes_of(scratch / "a.zip");
    for (std::size_t i = 0; i + 46 < bytes.size(); ++i)
        if (bytes[i] == 'P' && bytes[i + 1] == 'K' && bytes[i + 2] == 1) put32(bytes, i + 24, 0xfffffff0u);
    const Zip zip = Zip::from_bytes(std::move(bytes), "a.zip");
    EXPECT_THAT(data_error([&] { zip.read("bomb", 1 << 20); }),
                HasSubstr("a.zip: bomb: found 4294967280 bytes, expected at most"));
    EXPECT_NE(data_error([&] { zip.read("bomb", std::uint64_t{1} << 40); }), "");
}

TEST(Zip, AnEntryThatDeclaresLessThanItHoldsIsNotReadToItsEnd) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"bomb", std::string(50'000'000, 'x')}});  // 50 kB of zip
    std::vector<std::uint8_t> bytes = bytes_of(scratch / "a.zip");
    for (std::size_t i = 0; i + 46 < bytes.size(); ++i)
        if (bytes[i] == 'P' && bytes[i + 1] == 'K' && bytes[i + 2] == 1) put32(bytes, i + 24, 10);
    const Zip zip = Zip::from_bytes(std::move(bytes), "a.zip");
    EXPECT_NE(data_error([&] { zip.read("bomb", 1000); }), "");
}

TEST(Zip, TheStartOfAnEntryIsReadAlone) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"long", "0123456789" + std::string(5'000'000, 'x')}, {"short", "abc"}});
    const Zip zip = Zip::open(scratch / "a.zip");
    EXPECT_EQ(text(zip.read_start("long", 10)), "0123456789");
    EXPECT_EQ(text(zip.read_start("short", 10)), "abc");
    EXPECT_THAT(data_error([&] { zip.read_start("gone", 10); }),
                HasSubstr("a.zip: gone: found no such entry"));
}

TEST(SlowZip, MoreThanFourGibibytesInAllAreRefused) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"half", std::string(std::size_t{256} << 20, 'x')}});  // 250 kB of zip
    const Zip zip = Zip::open(scratch / "a.zip");
    for (int i = 0; i < 16; ++i) zip.read("half", 256 << 20);
    EXPECT_THAT(data_error([&] { zip.read("half", 256 << 20); }),
                HasSubstr("bytes with the entries before, expected at most 4294967296"));
}

TEST(Zip, NamesOfEntriesAreShownEscaped) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"a", "x"}});
    const Zip zip = Zip::open(scratch / "a.zip");
    EXPECT_THAT(data_error([&] { zip.read("b\n\x1b[2J", 10); }),
                HasSubstr("a.zip: b\\n\\x1b[2J: found no such entry"));
}

TEST(Zip, DamageIsFoundByTheChecksum) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"stored", "incompressible?"}});
    std::vector<std::uint8_t> bytes = bytes_of(scratch / "a.zip");
    bytes.at(30 + 6 + 4) ^= 1;  // after the local header and the name
    const Zip zip = Zip::from_bytes(std::move(bytes), "a.zip");
    EXPECT_THAT(data_error([&] { zip.read("stored", 1000); }),
                HasSubstr("a.zip: stored: found damaged data (bytes whose checksum is another one)"));
}

TEST(Zip, EveryCutOfAnArchiveIsRefusedOrWhole) {
    const Scratch scratch;
    write_zip(scratch / "a.zip", {{"one", "first"}, {"two", "second"}});
    const std::vector<std::uint8_t> whole = bytes_of(scratch / "a.zip");
    for (std::size_t size = 1; size < whole.size(); ++size)
        EXPECT_THAT(data_error([&] {
                        const Zip zip = Zip::from_bytes(
                            {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, "cut");
                        zip.read("one", 100);
                        zip.read("two", 100);
                    }),
                    HasSubstr("cut: "))
            << size;
}

TEST(Zip, WhatIsNoArchiveIsRefusedByName) {
    const Scratch scratch;
    trace::write_whole(scratch / "a.zip", "plain text, and long enough to be looked at twice");
    EXPECT_THAT(data_error([&] { Zip::open(scratch / "a.zip"); }),
                HasSubstr("a.zip: found no sound zip archive (no directory of entries), expected one"));
    EXPECT_THAT(data_error([&] { Zip::open(scratch / "missing.zip"); }),
                HasSubstr("missing.zip: found no file"));
    EXPECT_THAT(data_error([&] { Zip::open(scratch.path()); }), HasSubstr("found no file"));
}

}  // namespace
}  // namespace regather::imports
