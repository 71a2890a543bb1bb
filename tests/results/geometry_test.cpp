#include "results/geometry.h"

#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::results {
namespace {

Row row_of(Geometry geometry) {
    Row row;
    row.cache_bytes = geometry.cache_bytes;
    row.line_bytes = geometry.line_bytes;
    row.ways = geometry.ways;
    return row;
}

TEST(Geometry, ReadsWhatPeopleWrite) {
    EXPECT_EQ(parse_geometry("128K:128:8"), (Geometry{131072, 128, 8}));
    EXPECT_EQ(parse_geometry("1M:64:full"), (Geometry{1048576, 64, 0}));
    EXPECT_EQ(parse_geometry("512:32:1"), (Geometry{512, 32, 1}));
    for (const char* bad :
         {"", "128K", "128K:128", "128K:128:", ":128:8", "128K:128:8:1", "128k:128:8", "0:128:8", "128K:0:8",
          "128K:128:0", "128K:128:-1", "99999999999999M:128:8", "1K 128:128:8"})
        EXPECT_THROW(parse_geometry(bad), trace::UsageError) << bad;
}

TEST(Geometry, IsWrittenWithUnits) {
    EXPECT_EQ(geometry_text({131072, 128, 8}), "128 KiB, 128 B lines, 8-way");
    EXPECT_EQ(geometry_text({1536 * 1024, 64, 0}), "1.5 MiB, 64 B lines, fully associative");
    EXPECT_EQ(geometry_text({512, 2048, 1}), "512 B, 2 KiB lines, direct mapped");
}

TEST(Geometry, BytesHaveThreeDigitsAndADecimalUnit) {
    EXPECT_EQ(decimal_bytes(0), "0 B");
    EXPECT_EQ(decimal_bytes(999), "999 B");
    EXPECT_EQ(decimal_bytes(1000), "1.00 kB");
    EXPECT_EQ(decimal_bytes(15300000), "15.3 MB");
    EXPECT_EQ(decimal_bytes(999499), "999 kB");
    EXPECT_EQ(decimal_bytes(999500), "1.00 MB");
    EXPECT_EQ(decimal_bytes(9994999999), "9.99 GB");
    EXPECT_EQ(decimal_bytes(9995000000), "10.0 GB");
    EXPECT_EQ(decimal_bytes(211000000000), "211 GB");
    EXPECT_EQ(decimal_count(26214400), "26.2 M");
    EXPECT_EQ(decimal_count(100), "100");
}

TEST(Geometry, TheCommonestWinsAndThePapersAmongEquals) {
    const Geometry small{4096, 64, 4}, large{1 << 20, 128, 8}, paper{};
    EXPECT_EQ(commonest_geometry({}), std::nullopt);
    std::vector<Row> rows = {row_of(small), row_of(large), row_of(large)};
    EXPECT_EQ(commonest_geometry(rows), large);
    rows = {row_of(small), row_of(paper), row_of(large)};
    EXPECT_EQ(commonest_geometry(rows), paper);
    rows = {row_of(paper), row_of(small), row_of(large)};
    EXPECT_EQ(commonest_geometry(rows), paper);
    rows = {row_of(large), row_of(small)};
    EXPECT_EQ(commonest_geometry(rows), large);
    rows[0].ways.reset();
    EXPECT_EQ(commonest_geometry(rows), small);
}

}  // namespace
}  // namespace regather::results
