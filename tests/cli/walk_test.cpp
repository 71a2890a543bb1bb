// `regather walk`: a trace from columns that somebody else wrote.
#include <cmath>
#include <limits>

#include "results/csv.h"
#include "tests/cli/expect.h"
#include "tests/column.h"
#include "trace/folder.h"
#include "trace/npy.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using trace::Vec3;

constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();

/// As numpy.save writes it: a header of 128 bytes.
std::string numpy_file(const std::string& descr, const std::string& shape, const std::string& rows) {
    std::string file("\x93NUMPY\x01\x00\x76\x00", 10);
    file += "{'descr': '" + descr + "', 'fortran_order': False, 'shape': " + shape + ", }";
    file.resize(127, ' ');
    return file + '\n' + rows;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

class Walk : public testing::Test {
protected:
    Walk() {
        fs::create_directories(columns_);
        std::vector<Vec3> photons;
        for (int i = 0; i < 64; ++i) photons.push_back({float(i % 4), float(i / 4 % 4), float(i / 16)});
        column("photon_position", photons);
        column("query_position", std::vector<Vec3>{{0, 0, 0}, {1.5f, 1.5f, 1.5f}, {3, 3, 3}, {9, 9, 9}});
    }
    template <class T>
    void column(const std::string& name, const std::vector<T>& rows) const {
        write_column<T>(columns_ / (name + ".npy"), rows);
    }
    std::vector<std::string> words(const std::vector<std::string>& more = {}) const {
        return std::vector<std::string>{"walk", columns_.string(), "-o", trace_.string(), "--k", "8"} + more;
    }
    void expect_replayed(const std::string& ordering, std::uint64_t queries) const {
        const std::string csv =
            expect_done({"replay", trace_.string(), "--order", ordering, "--cache", "1K:64:2"}).out;
        EXPECT_EQ(results::from_csv(csv, "stdout").at(0).queries, queries);
        EXPECT_NO_THROW(trace::TraceReader(trace_).verify_all());
    }
    void refused(const std::vector<std::string>& parts) const {
        expect_refused(bad_data, words(), parts);
        EXPECT_FALSE(fs::exists(trace_ / "trace.json"));
    }

    const Scratch scratch_;
    const fs::path columns_ = scratch_ / "mine", trace_ = scratch_ / "trace";
};

TEST_F(Walk, TwoColumnsAreEnough) {
    EXPECT_THAT(expect_done(words()).out, HasSubstr("64 photons, 4 queries"));
    expect_replayed("hilbert", 4);
    EXPECT_THAT(expect_done({"info", trace_.string()}).out,
                testing::AllOf(HasSubstr("scene      mine"), HasSubstr("4 x 1 pixels"),
                               HasSubstr("8.0 photons found")));
}

TEST_F(Walk, EveryColumnServesItsOrdering) {
    column("query_pixel", std::vector<std::uint32_t>{0, 3, 5, 7});
    column("query_direction", std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}});
    column("query_weight", std::vector<Vec3>(4, {1, 1, 1}));
    column("query_leaf_kd", std::vector<std::uint32_t>{3, 2, 1, 0});
    column("query_leaf_bvh", std::vector<std::uint32_t>{0, 0, 1, 1});
    expect_done(words({"--width", "4"}));
    EXPECT_THAT(expect_done({"info", trace_.string()}).out, HasSubstr("4 x 2 pixels"));
    for (const char* ordering : {"naive", "tiled", "direction-binned", "kd-leaf", "bvh-leaf"})
        expect_replayed(ordering, 4);
}

TEST_F(Walk, ColumnsOfNumPyAreTaken) {
    write(columns_ / "query_position.npy", numpy_file("<f4", "(2, 3)", bytes_of<float>({0, 0, 0, 1, 2, 3})));
    write(columns_ / "query_pixel.npy", numpy_file("<u4", "(2,)", bytes_of<std::uint32_t>({1, 0})));
    expect_done(words());
    expect_replayed("tiled", 2);
}

TEST_F(Walk, QueriesThatAreNowhereFindNothing) {
    column("query_position", std::vector<Vec3>{{nan, 0, 0}, {0, infinity, 0}, {0, 0, -infinity}});
    EXPECT_THAT(expect_done(words()).out, HasSubstr("3 queries, 0 nodes visited"));
    expect_replayed("hilbert", 3);
    expect_replayed("hashed", 3);
}

TEST_F(Walk, NoQueriesAndNoPhotonsAreATrace) {
    column("query_position", std::vector<Vec3>{});
    expect_done(words());
    expect_replayed("morton", 0);
    column("query_position", std::vector<Vec3>{{1, 1, 1}});
    column("photon_position", std::vector<Vec3>{});
    expect_done(words({"--force"}));
    expect_replayed("naive", 1);
}

TEST_F(Walk, ColumnsOfDifferentLengthAreRefused) {
    column("query_pixel", std::vector<std::uint32_t>{0, 1, 2});
    refused({"query_pixel.npy", "found 3 rows", "expected 4"});
}

TEST_F(Walk, AnotherTypeIsRefusedWithTheOneExpected) {
    write(columns_ / "query_position.npy", numpy_file("<f8", "(1, 3)", bytes_of<double>({0, 0, 0})));
    refused({"query_position.npy", "<f8", "<f4", "float32 x 3"});
    write(columns_ / "query_position.npy", numpy_file(">f4", "(1, 3)", bytes_of<float>({0, 0, 0})));
    refused({"query_position.npy", "big-endian"});
    write(columns_ / "query_position.npy", numpy_file("<f4", "(3,)", bytes_of<float>({0, 0, 0})));
    refused({"query_position.npy", "shape (3,)", "(rows, 3)"});
    fs::remove(columns_ / "query_position.npy");
    refused({"query_position.npy", "No such file"});
}

TEST_F(Walk, APhotonThatIsNowhereIsRefused) {
    column("photon_position", std::vector<Vec3>{{0, 0, 0}, {0, nan, 0}});
    refused({"photon_position.npy", "row 1", "nan", "finite"});
}

TEST_F(Walk, APixelWithoutAnImageIsRefused) {
    column("query_pixel", std::vector<std::uint32_t>{0, 1, 2, 0xffffffffu});
    refused({"query_pixel.npy", "row 3", "4294967295"});
}

TEST_F(Walk, AColumnThatNobodyReadsIsRefusedWithTheNearestName) {
    column("query_wieght", std::vector<Vec3>{{1, 1, 1}});
    refused({"found an unknown column \"query_wieght\", expected \"query_weight\"", "query_leaf_bvh"});
    fs::remove(columns_ / "query_wieght.npy");
    write(columns_ / "notes.txt", "not a column");
    expect_done(words());
}

TEST_F(Walk, AFinishedTraceOutlivesBadColumns) {
    expect_done(words());
    const auto before = contents(trace_);
    expect_refused(bad_usage, words(), {"finished trace", "--force"});
    column("photon_position", std::vector<Vec3>{{nan, 0, 0}});
    expect_refused(bad_data, words({"--force"}), {"photon_position.npy"});
    EXPECT_EQ(contents(trace_), before);
}

TEST_F(Walk, TheColumnsFolderIsNoPlaceForTheTrace) {
    const auto before = contents(columns_);
    expect_refused(bad_usage, {"walk", columns_.string(), "-o", columns_.string(), "--force"},
                   {"photon_position.npy"});
    EXPECT_EQ(contents(columns_), before);
}

}  // namespace
}  // namespace regather::cli
