#include "cachesim/address_trace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/column.h"
#include "tests/scratch.h"
#include "trace/error.h"
#include "trace/npy.h"

namespace regather::cachesim {
namespace {

using std::filesystem::path;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

class AddressTraceTest : public testing::Test {
protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }

    path text(const std::string& content) const {
        std::ofstream(folder_ / "trace.din", std::ios::binary) << content;
        return folder_ / "trace.din";
    }
    template <class T>
    path column(const std::string& name, const std::vector<T>& rows) const {
        write_column<T>(folder_ / name, rows);
        return folder_ / name;
    }
    path bytes_as(const std::string& name, const trace::ColumnType& type,
                  const std::vector<std::uint8_t>& bytes) const {
        trace::ColumnWriter writer(folder_ / name, type);
        writer.append<std::uint8_t>(bytes);
        writer.finish();
        return folder_ / name;
    }
    path addresses(const std::vector<std::uint64_t>& rows) const { return column("addresses.npy", rows); }

    static std::vector<ByteAccess> read(const AddressFiles& files) {
        AddressTrace trace(files);
        std::vector<ByteAccess> all;
        for (auto records = trace.next(); !records.empty(); records = trace.next())
            all.insert(all.end(), records.begin(), records.end());
        return all;
    }
    /// The message without the folder.
    std::string refusal(const AddressFiles& files) const {
        try {
            read(files);
        } catch (const trace::DataError& error) {
            std::string what = error.what();
            EXPECT_EQ(what.find('\n'), what.npos);
            EXPECT_THAT(what, HasSubstr(folder_.string() + "/"));
            return what.substr(what.find(folder_.string()) + folder_.string().size() + 1);
        }
        return "accepted";
    }

    const Scratch scratch_;
    const path folder_ = scratch_ / "address trace";
};

constexpr std::uint64_t top = ~std::uint64_t{0};

// ---- din
// -----------------------------------------------------------------------------------------------------------

TEST_F(AddressTraceTest, DinRecordsAreWordsOfFourBytes) {
    EXPECT_THAT(read({text("0 1000\n"
                           "1 0x1006 a comment, 0 2000\n"
                           "2 fff 4\n"
                           "  0x0\t0XABCDEF13\n"
                           "1 ffffffffffffffff\n")}),
                ElementsAre(ByteAccess{0x1000, 4, Access::read}, ByteAccess{0x1004, 4, Access::write},
                            ByteAccess{0xffc, 4, Access::read}, ByteAccess{0xabcdef10, 4, Access::read},
                            ByteAccess{top - 3, 4, Access::write}));
}

TEST_F(AddressTraceTest, DinLinesEndWithLineFeedCarriageReturnOrBothAndBlankOnesAreNone) {
    const auto expected = ElementsAre(ByteAccess{8, 4, Access::read}, ByteAccess{16, 4, Access::write},
                                      ByteAccess{12, 4, Access::read});
    for (const char* content : {"0 8\n1 10\n2 c", "0 8\r1 10\r2 c\r", "0 8\r\n1 10\r\n2 c\r\n",
                                "0 8\r1 10\n2 c\r\n", "\n\r\n0 8 \t\r\r\n \n1 10\n\r2 c\n\n \t \r"})
        EXPECT_THAT(read({text(content)}), expected) << content;
    // A pair is one end, and a blank line counts where a line is named.
    EXPECT_THAT(refusal({text("0 8\r\n\r\n\r9 0\r\n")}), HasSubstr("line 4: found label 9"));
    EXPECT_THAT(refusal({text("\r\n \r\n")}), HasSubstr("line 2: found blank lines only"));
}

/// The two characters of one line end on both sides of the buffer's, wherever in the line the buffer ends.
TEST_F(AddressTraceTest, ALineEndMayLieOnTheEdgeOfABuffer) {
    for (const char* end : {"\r", "\r\n"})
        for (const unsigned shift : {0u, 1u, 2u, 3u, 4u, 5u}) {
            std::string content = std::string("0 ") + std::string(shift, '0') + "0" + end;
            unsigned lines = 1;
            while (content.size() < (1u << 20) + 100) {
                content += "1 4";
                content += end;
                ++lines;
            }
            EXPECT_EQ(read({text(content)}).size(), lines) << shift;
            EXPECT_THAT(refusal({text(content + "7 4")}),
                        HasSubstr("line " + std::to_string(lines + 1) + ":"));
        }
}

TEST_F(AddressTraceTest, WhatStandsBehindAnAddressIsSaidOnce) {
    const auto notes = [&](const std::string& content) {
        AddressTrace trace({text(content)});
        while (!trace.next().empty()) {
        }
        std::vector<std::string> lines = trace.notes();
        for (std::string& line : lines) line = line.substr(line.find("trace.din"));
        return lines;
    };
    EXPECT_THAT(notes("0 8 \t\n1 10\r\n"), testing::IsEmpty());
    EXPECT_THAT(notes("0 8\n1 10 4 \x1b[2J\r\n"),
                ElementsAre("trace.din: line 2: \"4 \\x1b[2J\" behind the address is not read"));
    EXPECT_THAT(
        notes("0 8 a\n1 10 b\n"),
        ElementsAre(
            "trace.din: line 1: \"a\" behind the address is not read, nor what 1 other line has there"));
    EXPECT_THAT(
        notes("0 8\n0 8 a\n1 10 b\n1 10 b\n"),
        ElementsAre(
            "trace.din: line 2: \"a\" behind the address is not read, nor what 2 other lines have there"));
}

TEST_F(AddressTraceTest, DinTextLongerThanABufferKeepsItsOrder) {
    std::string content;
    for (unsigned i = 0; i < 300'000; ++i) {
        char line[40];
        content.append(
            line, static_cast<std::size_t>(std::snprintf(line, sizeof line, "%u %x #%u\n", i % 3, 4 * i, i)));
    }
    ASSERT_GT(content.size(), 4u << 20);
    const std::vector<ByteAccess> records = read({text(content)});
    ASSERT_EQ(records.size(), 300'000u);
    for (unsigned i = 0; i < records.size(); ++i)
        ASSERT_EQ(records[i], (ByteAccess{4 * i, 4, i % 3 == 1 ? Access::write : Access::read})) << i;
    EXPECT_THAT(refusal({text(content + "3 0\n")}), HasSubstr("line 300001: found label 3"));
}

TEST_F(AddressTraceTest, ACommentMayBeLongerThanABuffer) {
    const std::string comment(3 << 20, '7');
    EXPECT_THAT(read({text("0 4 " + comment + "\n1 8\n")}),
                ElementsAre(ByteAccess{4, 4, Access::read}, ByteAccess{8, 4, Access::write}));
    for (const char* end : {"\n", "\r", "\r\n"})
        EXPECT_THAT(refusal({text("0 4 " + comment + end + "9 8\n")}), HasSubstr("line 2: found label 9"));
}

TEST_F(AddressTraceTest, DamagedDinTextIsRefusedWithTheLine) {
    EXPECT_EQ(refusal({text("0 0\n3 10\n")}),
              "trace.din: line 2: found label 3, expected 0 (read), 1 (write) or 2 (instruction)");
    EXPECT_THAT(refusal({text("0 0\n0 4\n0\n")}), HasSubstr("line 3: found no address"));
    EXPECT_THAT(refusal({text("0 0\n\n0 4\n \t\nr 8")}), HasSubstr("line 5: found label \"r\""));
    EXPECT_THAT(refusal({text("# header\n0 4\n")}), HasSubstr("line 1: found label \"#\", expected a label"));
    EXPECT_THAT(refusal({text("0 12g4\n")}), HasSubstr("line 1: found address \"12g4\", expected"));
    EXPECT_THAT(refusal({text("0 0x\n")}), HasSubstr("line 1: found address \"0x\""));
    EXPECT_THAT(refusal({text("r 1000\n")}), HasSubstr("line 1: found label \"r\""));
    EXPECT_THAT(refusal({text("0 0\n0 10000000000000000\n")}),
                HasSubstr("line 2: found address \"10000000000000000\""));
    EXPECT_THAT(refusal({text("0 -4\n")}), HasSubstr("line 1: found address \"-4\""));
    EXPECT_THAT(refusal({text(std::string("\0\x01\x02", 3))}),
                HasSubstr("line 1: found label \"\\x00\\x01\\x02\""));
}

TEST_F(AddressTraceTest, EmptyAndMissingFilesAreRefused) {
    EXPECT_THAT(refusal({text("")}), HasSubstr("trace.din: line 1: found 0 bytes"));
    EXPECT_THAT(refusal({folder_ / "none.din"}), HasSubstr("none.din: found No such file"));
    EXPECT_THAT(refusal({folder_ / "none.npy"}), HasSubstr("none.npy: found No such file"));
    EXPECT_THAT(refusal({addresses({})}), HasSubstr("addresses.npy: found 0 records, expected at least 1"));
    std::filesystem::create_directory(folder_ / "sub");
    EXPECT_THAT(refusal({folder_ / "sub"}), HasSubstr("sub: found a folder, expected a file"));
}

TEST_F(AddressTraceTest, ColumnsBesideDinTextAreAUsageError) {
    const path sizes = column<std::uint8_t>("sizes.npy", {1});
    EXPECT_THROW(read({text("0 0\n"), sizes, {}}), trace::UsageError);
    EXPECT_THROW(read({text("0 0\n"), {}, sizes}), trace::UsageError);
}

// ---- .npy
// ----------------------------------------------------------------------------------------------------------

TEST_F(AddressTraceTest, AColumnAloneReadsAByteEach) {
    EXPECT_THAT(read({addresses({7, top, 0})}),
                ElementsAre(ByteAccess{7, 1}, ByteAccess{top, 1}, ByteAccess{0, 1}));
}

TEST_F(AddressTraceTest, ANumPyFileIsKnownByItsFirstBytes) {
    std::filesystem::rename(addresses({7, 9}), folder_ / "addresses");
    EXPECT_THAT(read({folder_ / "addresses"}), ElementsAre(ByteAccess{7, 1}, ByteAccess{9, 1}));
}

TEST_F(AddressTraceTest, SizesMayHaveThreeTypesAndWritesTwo) {
    const auto expected = ElementsAre(ByteAccess{64, 4, Access::write}, ByteAccess{top - 7, 8, Access::read});
    const path where = addresses({64, top - 7});
    const path writes = column<std::uint8_t>("writes.npy", {1, 0});
    const path flags = bytes_as("flags.npy", {"'|b1'", "", 1, "bool"}, {1, 0});
    EXPECT_THAT(read({where, column<std::uint8_t>("s1.npy", {4, 8}), writes}), expected);
    EXPECT_THAT(read({where, column<std::uint32_t>("s4.npy", {4, 8}), flags}), expected);
    EXPECT_THAT(read({where, column<std::uint64_t>("s8.npy", {4, 8}), writes}), expected);
}

TEST_F(AddressTraceTest, ManyRecordsKeepTheirOrder) {
    std::vector<std::uint64_t> where(100'000);
    std::vector<std::uint32_t> sizes(where.size());
    for (std::size_t i = 0; i < where.size(); ++i) {
        where[i] = i * i;
        sizes[i] = static_cast<std::uint32_t>(1 + i % 1000);
    }
    const std::vector<ByteAccess> records = read({addresses(where), column("sizes.npy", sizes), {}});
    ASSERT_EQ(records.size(), where.size());
    for (std::size_t i = 0; i < where.size(); ++i)
        ASSERT_EQ(records[i], (ByteAccess{where[i], sizes[i]})) << i;
}

/// Old writers pad the header to 16 bytes only, others not at all.
TEST_F(AddressTraceTest, RowsNeedNotBeAligned) {
    const std::string header = "{'descr': '<u8', 'fortran_order': False, 'shape': (2,)}  \n";
    ASSERT_NE((10 + header.size()) % 8, 0u);
    std::string content =
        std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header;
    content += std::string("\x01\x02\0\0\0\0\0\0\x03\0\0\0\0\0\0\x80", 16);
    EXPECT_THAT(read({text(content)}), ElementsAre(ByteAccess{0x201, 1}, ByteAccess{0x8000000000000003, 1}));
}

TEST_F(AddressTraceTest, BadRecordsAreRefusedWithTheirRow) {
    std::vector<std::uint64_t> where(20'000, 64), sizes(20'000, 8);
    std::vector<std::uint8_t> writes(20'000, 0);
    const AddressFiles files{addresses(where), folder_ / "sizes.npy", folder_ / "writes.npy"};
    const auto with = [&](std::uint64_t size, std::uint8_t write) {
        sizes[17'000] = size;
        writes[17'000] = write;
        column("sizes.npy", sizes);
        column("writes.npy", writes);
        return refusal(files);
    };
    EXPECT_EQ(with(8, 1), "accepted");
    EXPECT_EQ(with(max_access_bytes, 0), "accepted");
    EXPECT_EQ(with(0, 0), "sizes.npy: record 17000: found a size of 0 bytes, expected 1 to 1073741824");
    EXPECT_THAT(with(max_access_bytes + 1, 0), HasSubstr("record 17000: found a size of 1073741825 bytes"));
    EXPECT_EQ(with(8, 2), "writes.npy: record 17000: found 2, expected 0 (read) or 1 (write)");
    EXPECT_THAT(with(8, 255), HasSubstr("record 17000: found 255"));
}

TEST_F(AddressTraceTest, AnAccessBeyondTheAddressSpaceIsRefused) {
    const path where = addresses({top - 7, top - 7});
    EXPECT_EQ(refusal({where, column<std::uint8_t>("sizes.npy", {8, 9}), {}}),
              "sizes.npy: record 1: found 9 bytes from address 0xfffffffffffffff8 on, expected a last byte "
              "below 2^64");
}

TEST_F(AddressTraceTest, ColumnsMustHaveTheSameRows) {
    const path where = addresses({1, 2, 3});
    EXPECT_THAT(refusal({where, column<std::uint8_t>("sizes.npy", {1, 1}), {}}),
                testing::StartsWith("sizes.npy: found 2 records, expected 3 as in "));
    EXPECT_THAT(refusal({where, {}, column<std::uint8_t>("writes.npy", {1, 1, 0, 0})}),
                testing::StartsWith("writes.npy: found 4 records, expected 3 as in "));
}

TEST_F(AddressTraceTest, ForeignTypesAreRefused) {
    const path floats = bytes_as("floats.npy", {"'<f8'", "", 8, "float64"}, std::vector<std::uint8_t>(16));
    EXPECT_THAT(refusal({floats}), HasSubstr("floats.npy: found type '<f8'"));
    EXPECT_THAT(refusal({addresses({1, 2}), floats, {}}),
                EndsWith("floats.npy: found type '<f8', expected uint8 or uint32 or uint64, little-endian"));
    EXPECT_THAT(refusal({addresses({1, 2}), text("no column"), {}}), HasSubstr("expected a .npy"));
}

// What numpy.array([64, 130]) is, without a dtype.
TEST_F(AddressTraceTest, SignedColumnsWithoutNegativesAreTaken) {
    const std::vector<std::uint8_t> bytes{64, 0, 0, 0, 0, 0, 0, 0, 130, 0, 0, 0, 0, 0, 0, 0};
    const path where = bytes_as("where.npy", {"'<i8'", "", 8, "int64"}, bytes);
    EXPECT_EQ(read({where, where, {}}),
              read({addresses({64, 130}), column<std::uint8_t>("s.npy", {64, 130}), {}}));
    std::vector<std::uint8_t> negative = bytes;
    negative[15] = 0x80;
    EXPECT_THAT(refusal({bytes_as("bad.npy", {"'<i8'", "", 8, "int64"}, negative)}),
                HasSubstr("bad.npy: found -9223372036854775678 in row 1, expected no negative value"));
}

TEST_F(AddressTraceTest, ThePositionEndsAtTheTotal) {
    const auto end = [](const AddressFiles& files) {
        AddressTrace trace(files);
        EXPECT_LT(trace.position().done, trace.position().total);
        while (!trace.next().empty()) {
        }
        EXPECT_EQ(trace.position().done, trace.position().total);
        return std::pair(trace.position().total, std::string(trace.position().unit));
    };
    EXPECT_EQ(end({addresses({1, 2, 3})}), std::pair(std::uint64_t{3}, std::string("records")));
    EXPECT_EQ(end({text("0 4\n1 8 word")}), std::pair(std::uint64_t{12}, std::string("B")));
}

TEST_F(AddressTraceTest, ATruncatedColumnIsRefused) {
    const path where = addresses({1, 2, 3});
    std::filesystem::resize_file(where, std::filesystem::file_size(where) - 1);
    EXPECT_THAT(refusal({where}),
                HasSubstr("addresses.npy: found 23 bytes of rows, expected 3 rows x 8 bytes"));
}

}  // namespace
}  // namespace regather::cachesim
