#include "reorder/key_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <numeric>

#include "reorder/catalogue.h"
#include "tests/numpy.h"
#include "tests/reorder/workload.h"
#include "tests/scratch.h"
#include "trace/error.h"

namespace regather::reorder {
namespace {

using testing::AllOf, testing::HasSubstr, testing::StartsWith;

class File : public testing::Test {
protected:
    /// Writes it and gives its spec.
    std::string file(const std::string& bytes, const std::string& name = "mine.npy") {
        std::ofstream(scratch_ / name, std::ios::binary) << bytes;
        return "file:" + (scratch_ / name).string();
    }
    template <class T>
    std::string keys(const std::string& descr, const std::vector<T>& values) {
        return file(numpy_file(descr, "(" + std::to_string(values.size()) + ",)", bytes_of(values)));
    }
    static Ordered ordered(const std::string& spec, std::uint32_t queries,
                           std::uint64_t onchip = default_onchip_bytes) {
        Queries all = one_per_pixel(queries, 1);
        all.width = std::max(queries, 1u);
        return order(*make_ordering(spec), all.workload(), onchip);
    }
    static std::string refusal(const std::string& spec, std::uint32_t queries) {
        try {
            ordered(spec, queries);
        } catch (const trace::DataError& error) {
            return error.what();
        } catch (const trace::UsageError& error) {
            return std::string("usage: ") + error.what();
        }
        return "accepted";
    }
    const Scratch scratch_;
};

using Numbers = std::vector<std::uint32_t>;

TEST_F(File, SmallerKeysRunFirstAndEqualOnesInCaptureOrder) {
    EXPECT_EQ(ordered(keys<std::int64_t>("<i8", {7, -1, 7, 0, -5, 7}), 6).permutation,
              (Numbers{4, 1, 3, 0, 2, 5}));
    EXPECT_EQ(ordered(keys<std::uint16_t>("<u2", {65535, 1, 65534, 1}), 4).permutation,
              (Numbers{1, 3, 2, 0}));
}

TEST_F(File, EveryWidthOfNumPysWholeNumbersHasItsSigns) {
    const auto extremes = [&]<class T>(const std::string& descr, T) {
        using Limits = std::numeric_limits<T>;
        const T below_zero = std::is_signed_v<T> ? static_cast<T>(-1) : static_cast<T>(0);
        EXPECT_EQ(ordered(keys<T>(descr, {Limits::max(), 1, below_zero, Limits::min()}), 4).permutation,
                  std::is_signed_v<T> ? (Numbers{3, 2, 1, 0}) : (Numbers{2, 3, 1, 0}))
            << descr;
    };
    extremes("|i1", std::int8_t{});
    extremes("<i2", std::int16_t{});
    extremes("<i4", std::int32_t{});
    extremes("<i8", std::int64_t{});
    extremes("|u1", std::uint8_t{});
    extremes("<u2", std::uint16_t{});
    extremes("<u4", std::uint32_t{});
    extremes("<u8", std::uint64_t{});
}

TEST_F(File, IsAStableSortOfTheKeysWhateverTheyAre) {
    ASSERT_TRUE(rc::check([&] {
        const auto values = *rc::gen::container<std::vector<std::int32_t>>(rc::gen::inRange(-4, 5));
        Numbers expected(values.size());
        std::iota(expected.begin(), expected.end(), 0u);
        std::stable_sort(expected.begin(), expected.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return values[a] < values[b]; });
        RC_ASSERT(ordered(keys("<i4", values), static_cast<std::uint32_t>(values.size())).permutation ==
                  expected);
    }));
}

TEST_F(File, APermutationIsTheOrderItself) {
    EXPECT_EQ(ordered(keys<std::int64_t>("<i8", {3, 0, 2, 1}) + ",as=permutation", 4).permutation,
              (Numbers{3, 0, 2, 1}));
    // The same numbers as keys: query 1 has the least.
    EXPECT_EQ(ordered(keys<std::int64_t>("<i8", {3, 0, 2, 1}), 4).permutation, (Numbers{1, 3, 2, 0}));
    EXPECT_EQ(ordered(keys<std::uint8_t>("|u1", {}) + ",as=permutation", 0).permutation, Numbers{});
}

TEST_F(File, KeysAreFreeAndTheirSortIsCharged) {
    // 300 apart: 9 bits, two digits.
    const Cost cost = ordered(keys<std::int64_t>("<i8", {-100, 200, 5}), 3).cost;
    EXPECT_EQ(cost.keys, 3u);
    EXPECT_EQ(cost.key_ops, 0u);
    EXPECT_EQ(cost.sort_passes, 2u);
    EXPECT_EQ(cost.moved_records, 6u);
    EXPECT_EQ(cost.buffered_bytes, 3 * 28u);
    EXPECT_EQ(cost.reorder_bytes, 0u);
    EXPECT_EQ(ordered(keys<std::int64_t>("<i8", {-100, 200, 5}), 3, 3 * 28 - 1).cost.reorder_bytes,
              2 * 3 * 28u);
    EXPECT_EQ(ordered(keys<std::int64_t>("<i8", {9, 9, 9}), 3).cost.sort_passes, 0u);
    Numbers ranks(257);
    std::iota(ranks.begin(), ranks.end(), 0u);
    EXPECT_EQ(ordered(keys("<u4", ranks) + ",as=permutation", 257).cost.sort_passes, 2u);
    ranks.pop_back();  // ranks of 256 queries are 8 bits
    EXPECT_EQ(ordered(keys("<u4", ranks) + ",as=permutation", 256).cost.sort_passes, 1u);
}

TEST_F(File, ItsBufferIsThatOfASort) {
    const auto ordering = make_ordering(keys<std::int64_t>("<i8", {2, 1, 0}));
    const Queries queries = one_per_pixel(3, 1);
    const Ordered by_key = order(*ordering, queries.workload(), 28);
    const BufferUse use = ordering->buffer_use(queries.workload(), 28, by_key.permutation);
    ASSERT_TRUE(use.known && use.batches);
    EXPECT_EQ(use.batches->ends, (std::vector<std::uint64_t>{3}));
    EXPECT_EQ(use.batches->record_bytes, 28u);
}

TEST_F(File, IsNamedByItsNameAndChecksumAndFoundAgainByThem) {
    const std::string spec = keys<std::uint8_t>("|u1", {2, 1, 0});
    const ParsedOrdering parsed = parse_ordering(spec);
    EXPECT_EQ(parsed.spec.name, "file:mine.npy");
    EXPECT_THAT(parsed.spec.text, testing::MatchesRegex("file:mine\\.npy,as=keys,xxh3=[0-9a-f]{16}"));
    EXPECT_EQ(parsed.spec.tile, std::nullopt);
    EXPECT_EQ(parse_ordering(parsed.spec.text, scratch_.path()).spec.text, parsed.spec.text);
    // Other rows under the same name.
    keys<std::uint8_t>("|u1", {2, 0, 1});
    EXPECT_NE(parse_ordering(spec).spec.text, parsed.spec.text);
    try {
        parse_ordering(parsed.spec.text, scratch_.path());
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("mine.npy: found checksum "), HasSubstr(" as xxh3 says")));
    }
}

TEST_F(File, ItsPathMayHoldCommasColonsAndWhatNamesALibrary) {
    std::filesystem::create_directories(scratch_ / "a,b=c:d");
    const std::string bytes = numpy_file("|u1", "(2,)", bytes_of<std::uint8_t>({1, 0}));
    for (const char* name : {"a,b=c:d/x.so:y.npy", "keys", "k,as=keys"})
        EXPECT_EQ(ordered(file(bytes, name), 2).permutation, (Numbers{1, 0})) << name;
}

TEST_F(File, RefusesWhatIsNoColumnOfWholeNumbers) {
    const std::string expected = "expected whole numbers (int8 to int64 or uint8 to uint64, little-endian)";
    const auto typed = [&](const std::string& descr, const std::string& rows) {
        return refusal(file(numpy_file(descr, "(2,)", rows)), 2);
    };
    EXPECT_THAT(typed("<f8", bytes_of<double>({1, 2})),
                AllOf(HasSubstr("mine.npy: found type '<f8'"), HasSubstr(expected)));
    EXPECT_THAT(typed("|b1", bytes_of<std::uint8_t>({1, 0})), HasSubstr("found type '|b1'"));
    EXPECT_THAT(typed(">i4", bytes_of<std::int32_t>({1, 0})), HasSubstr("found big-endian type '>i4'"));
    EXPECT_THAT(refusal(file(numpy_file("<i4", "(2, 1)", bytes_of<std::int32_t>({1, 0}))), 2),
                HasSubstr("found shape (2,1), expected shape (rows,)"));
    EXPECT_THAT(refusal(file(numpy_file("<i4", "()", bytes_of<std::int32_t>({1}))), 1),
                HasSubstr("found shape ()"));
    EXPECT_THAT(refusal(file(numpy_file("<i4", "(3,)", bytes_of<std::int32_t>({1, 0}))), 3),
                HasSubstr("found 8 bytes of rows, expected 3 rows x 4 bytes"));
    EXPECT_THAT(refusal(file("not NumPy's at all"), 2), HasSubstr("no NumPy magic"));
    EXPECT_THAT(refusal("file:" + (scratch_ / "none.npy").string(), 2),
                HasSubstr("none.npy: found No such file"));
    EXPECT_THAT(refusal("file:" + scratch_.path().string(), 2), HasSubstr("expected a .npy file"));
}

TEST_F(File, RefusesAnotherNumberOfRows) {
    const std::string spec = keys<std::int32_t>("<i4", {0, 1, 2});
    EXPECT_THAT(refusal(spec, 4), HasSubstr("mine.npy: found 3 rows, expected 4, one for each query"));
    EXPECT_THAT(refusal(spec + ",as=permutation", 2),
                HasSubstr("found 3 rows, expected 2, one for each query"));
}

TEST_F(File, RefusesPermutationsThatLoseOrRepeatAQuery) {
    const auto permutation = [&](const std::vector<std::int16_t>& values) {
        return refusal(keys("<i2", values) + ",as=permutation", 4);
    };
    EXPECT_EQ(permutation({3, 1, 0, 2}), "accepted");
    EXPECT_THAT(permutation({3, 1, 2, 1}),
                HasSubstr("row 3: found 1, as in row 1, expected each query once"));
    EXPECT_THAT(permutation({3, 1, 4, 0}), HasSubstr("row 2: found 4, expected a query from 0 to 3"));
    EXPECT_THAT(permutation({-1, 1, 2, 0}), HasSubstr("row 0: found -1, expected a query from 0 to 3"));
}

TEST_F(File, RefusesSpecsThatAreNone) {
    EXPECT_EQ(refusal("file", 1), "usage: file: found no path, expected file:KEYS.npy");
    EXPECT_EQ(refusal("file:", 1), "usage: file: found no path, expected file:KEYS.npy");
    const std::string spec = keys<std::int32_t>("<i4", {0});
    EXPECT_EQ(refusal(spec + ",as=ranks", 1),
              "usage: file: as is \"ranks\"; nearest: keys; known: keys, permutation");
    EXPECT_THAT(refusal(spec + ",at=keys", 1),
                StartsWith("usage: file: unknown parameter \"at\"; nearest: as;"));
}

}  // namespace
}  // namespace regather::reorder
