#include "trace/npy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/column.h"
#include "tests/scratch.h"

namespace regather::trace {
namespace {

std::string message_of(const std::filesystem::path& path, const ColumnType& type) {
    try {
        const MappedColumn column(path, type);
    } catch (const DataError& error) {
        return error.what();
    }
    return "accepted";
}

void overwrite(const std::filesystem::path& path, std::size_t at, std::string_view bytes) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(at));
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

TEST(Npy, RowsComeBackAsTheyWere) {
    const Scratch scratch;
    const std::vector<Vec3> rows{{1, 2, 3}, {-0.0f, 1e30f, 5}};
    const ColumnDigest digest = write_column<Vec3>(scratch / "a.npy", rows);
    EXPECT_EQ(digest.rows, 2u);
    const MappedColumn column(scratch / "a.npy", column_type<Vec3>());
    ASSERT_EQ(column.size(), 2u);
    EXPECT_EQ(column.rows<Vec3>()[1], rows[1]);
    EXPECT_EQ(column.checksum(), digest.checksum);
}

TEST(Npy, TheChecksumIsThePublishedXxh3OfTheRows) {
    // XXH3_64bits of no bytes is 2D06800538D394C2 (xxHash's own test vectors, seed 0).
    const Scratch scratch;
    EXPECT_EQ(write_column<float>(scratch / "empty.npy", {}).checksum, 0x2d06800538d394c2u);
}

TEST(Npy, ARowCountOfZeroIsAColumn) {
    const Scratch scratch;
    write_column<std::uint32_t>(scratch / "a.npy", {});
    EXPECT_EQ(MappedColumn(scratch / "a.npy", column_type<std::uint32_t>()).size(), 0u);
}

TEST(Npy, AColumnMayBeOfOneTypeOrAnother) {
    const Scratch scratch;
    const ColumnType &four = column_type<std::uint32_t>(), &eight = column_type<std::uint64_t>();
    write_column<std::uint32_t>(scratch / "four.npy", std::vector<std::uint32_t>{5, 6, 7});
    write_column<std::uint64_t>(scratch / "eight.npy", std::vector<std::uint64_t>{8, 1ull << 40});
    write_column<float>(scratch / "real.npy", std::vector<float>{1});
    const MappedColumn narrow(scratch / "four.npy", four, eight), wide(scratch / "eight.npy", four, eight);
    EXPECT_EQ(narrow.row_bytes(), 4u);
    EXPECT_EQ(narrow.rows<std::uint32_t>()[2], 7u);
    EXPECT_EQ(wide.row_bytes(), 8u);
    EXPECT_EQ(wide.rows<std::uint64_t>()[1], 1ull << 40);
    try {
        const MappedColumn column(scratch / "real.npy", four, eight);
        ADD_FAILURE() << "taken";
    } catch (const DataError& error) {
        EXPECT_NE(std::string(error.what())
                      .find("found type '<f4', expected '<u4' or '<u8' (uint32 or uint64, "
                            "little-endian)"),
                  std::string::npos)
            << error.what();
    }
}

TEST(Npy, HeadersOfOtherWritersAreRead) {
    // As numpy.save writes three uint32: 128-byte header, no blank before ')'.
    const Scratch scratch;
    std::string file("\x93NUMPY\x01\x00\x76\x00", 10);
    file += "{'descr': '<u4', 'fortran_order': False, 'shape': (3,), }";
    file.resize(127, ' ');
    file += '\n';
    file += std::string("\x07\0\0\0\x08\0\0\0\x09\0\0\0", 12);
    std::ofstream(scratch / "a.npy", std::ios::binary) << file;
    const MappedColumn column(scratch / "a.npy", column_type<std::uint32_t>());
    ASSERT_EQ(column.size(), 3u);
    EXPECT_EQ(column.rows<std::uint32_t>()[2], 9u);
}

/// A file as another writer makes it, with a header of any length.
void write_npy(const std::filesystem::path& path, const std::string& dictionary, std::size_t header_bytes,
               std::span<const std::uint64_t> rows) {
    std::string header = dictionary;
    header.resize(header_bytes - 1, ' ');
    header += '\n';
    std::string file("\x93NUMPY\x01\x00", 8);
    file += {static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)};
    file += header;
    file.append(reinterpret_cast<const char*>(rows.data()), rows.size_bytes());
    std::ofstream(path, std::ios::binary) << file;
}

TEST(Npy, RowsBehindAHeaderOfAnyLengthAreAligned) {
    const Scratch scratch;
    const std::vector<std::uint64_t> rows{1, ~std::uint64_t{0}, 0x0123456789abcdef};
    for (std::size_t header_bytes = 60; header_bytes < 76; ++header_bytes) {
        write_npy(scratch / "a.npy", "{'descr': '<u8', 'fortran_order': False, 'shape': (3,)}", header_bytes,
                  rows);
        MappedColumn column(scratch / "a.npy", column_type<std::uint64_t>());
        const MappedColumn moved = std::move(column);
        const std::span<const std::uint64_t> found = moved.rows<std::uint64_t>();
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(found.data()) % alignof(std::uint64_t), 0u)
            << header_bytes;
        EXPECT_TRUE(std::ranges::equal(found, rows)) << header_bytes;
        EXPECT_EQ(moved.checksum(), write_column<std::uint64_t>(scratch / "b.npy", rows).checksum);
    }
}

TEST(Npy, Int64IsTakenAsUint64WhenNoValueIsNegative) {
    const Scratch scratch;
    const std::string dictionary = "{'descr': '<i8', 'fortran_order': False, 'shape': (3,)}";
    write_npy(scratch / "a.npy", dictionary, 118,
              std::vector<std::uint64_t>{5, 0, (std::uint64_t{1} << 63) - 1});
    EXPECT_EQ(MappedColumn(scratch / "a.npy", column_type<std::uint64_t>()).rows<std::uint64_t>()[2],
              (std::uint64_t{1} << 63) - 1);
    write_npy(scratch / "a.npy", dictionary, 118, std::vector<std::uint64_t>{5, ~std::uint64_t{2}, 0});
    EXPECT_NE(message_of(scratch / "a.npy", column_type<std::uint64_t>())
                  .find("a.npy: found -3 in row 1, expected no negative value"),
              std::string::npos);
    EXPECT_NE(
        message_of(scratch / "a.npy", column_type<std::uint32_t>()).find("found type '<i8', expected '<u4'"),
        std::string::npos);
}

TEST(Npy, DamageIsRefusedWithTheFileWhatWasFoundAndWhatWasExpected) {
    const Scratch scratch;
    const auto path = scratch / "query_pixel.npy";
    const auto fresh = [&] { write_column<std::uint32_t>(path, std::vector<std::uint32_t>{1, 2, 3}); };
    const auto refused = [&](const char* words) {
        const std::string message = message_of(path, column_type<std::uint32_t>());
        EXPECT_NE(message.find("query_pixel.npy"), std::string::npos) << message;
        EXPECT_NE(message.find(words), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    };
    refused("No such file");
    fresh();
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
    refused("found 11 bytes of rows, expected 3 rows x 4 bytes");
    fresh();
    std::filesystem::resize_file(path, std::filesystem::file_size(path) + 4);
    refused("found 16 bytes of rows");
    fresh();
    std::filesystem::resize_file(path, 40);
    refused("a header that ends early");
    std::filesystem::resize_file(path, 3);
    refused("3 bytes");
    fresh();
    overwrite(path, 0, "PK");
    refused("no NumPy magic");
    fresh();
    overwrite(path, 10, "{'descr': '>u4'");
    refused("big-endian");
    fresh();
    overwrite(path, 10, "{'descr': '<f4'");
    refused("found type '<f4', expected '<u4'");
    fresh();
    overwrite(path, 10, "{'descr': '<u4', 'fortran_order': True , 'shape': (3,), }");
    refused("Fortran");
    fresh();
    overwrite(path, 10, "{'descr': '<u4', 'fortran_order': False, 'shape': (3,1),}");
    refused("shape (3,1)");
    overwrite(path, 10, "{'descr': '<u4', 'fortran_order': False, 'shape': (9999999999999999999999,), }");
    refused("shape (9999999999999999999999,)");
    overwrite(path, 10, "{'descr': '<u4', 'fortran_order': False, 'shape': (4611686018427387907,), }");
    refused("12 bytes of rows");
    overwrite(path, 10,
              "{'descr': '<u4', 'fortran_order': False, 'shape': (3,\x1b\n),}                       ");
    refused("found shape (3,\\x1b\\n), expected");
    overwrite(path, 10, "{'descr': '\x1bz', 'fortran_order': False, 'shape': (3,),}                       ");
    refused("found type '\\x1bz', expected");
}

TEST(Npy, AnUnfinishedColumnIsRefused) {
    const Scratch scratch;
    {
        ColumnWriter writer(scratch / "a.npy", column_type<float>());
        writer.append(std::span<const float>(std::vector<float>{1, 2}));
    }
    EXPECT_NE(message_of(scratch / "a.npy", column_type<float>()).find("expected 0 rows"), std::string::npos);
}

}  // namespace
}  // namespace regather::trace
