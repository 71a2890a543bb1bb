// `regather walk`: a trace from columns that somebody else wrote.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "results/csv.h"
#include "spatial/photons/structures.h"
#include "tests/cli/expect.h"
#include "tests/column.h"
#include "tests/numpy.h"
#include "trace/folder.h"
#include "trace/npy.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using trace::Vec3;

constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();

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
    column("query_stratum", std::vector<std::uint32_t>{0, 1, 0xffffffff, 7});
    expect_done(words({"--width", "4"}));
    EXPECT_THAT(expect_done({"info", trace_.string()}).out, HasSubstr("4 x 2 pixels"));
    for (const char* ordering : {"naive", "tiled", "direction-binned", "kd-leaf", "bvh-leaf", "strata"})
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

// --- a trace's queries in another structure ---

TEST(WalkAgain, InEveryStructureTheSamePhotonsAreFound) {
    const Scratch scratch;
    const std::string from = box_trace();
    const trace::TraceReader original(from);
    for (const spatial::StructureEntry& entry : spatial::structures()) {
        if (!entry.build || !entry.is_exact) continue;
        const bool buckets = entry.parameters.size() > 1;
        const std::string name(entry.name),
            spec = buckets ? fmt::format("{}:{}=5", name, entry.parameters[0].name) : name,
            to = (scratch / name).string();
        expect_done({"walk", from, "--structure", spec, "-o", to});
        expect_done({"info", to, "--verify"});
        const trace::TraceReader found(to);
        EXPECT_EQ(found.info().structure, spec);
        EXPECT_EQ(found.info().found_photons, original.info().found_photons);
        EXPECT_EQ(found.info().scene, "box");
        for (const char* column : {"photon", "query_position", "query_pixel", "ray_gather_origin"})
            EXPECT_EQ(found.digests().at(column), original.digests().at(column)) << column;
        EXPECT_EQ(found.digests().at("walk") == original.digests().at("walk"), !buckets);
        if (!buckets) {
            EXPECT_EQ(found.info().visited_nodes > original.info().visited_nodes, name != "left-balanced-kd");
        }
        const std::vector<results::Row> rows =
            results::from_csv(expect_done({"replay", to, "--order", "random", "naive", "--layout", "heap-20",
                                           buckets ? "depth-first-32:node=16" : "depth-first-32", "--cache",
                                           "4K:128:8", "4M:128:full"})
                                  .out,
                              "stdout");
        ASSERT_EQ(rows.size(), 8u);
        for (const results::Row& row : rows) {
            EXPECT_EQ(row.structure, spec);
            EXPECT_GE(row.traffic_bytes, row.compulsory_bytes);
            if (*row.cache_bytes > 4096) {
                EXPECT_EQ(row.traffic_bytes, row.compulsory_bytes);
            }
        }
        EXPECT_THAT(rows[0].layout, testing::StartsWith(buckets ? "heap-20:node=" : "heap-20"));
    }
}

TEST(WalkAgain, ASearchThatIsNotExactSaysWhatItFinds) {
    const Scratch scratch;
    const std::string from = box_trace(), few = (scratch / "few").string(),
                      many = (scratch / "many").string(), back = (scratch / "back").string();
    EXPECT_THAT(expect_done({"structures"}).out, testing::ContainsRegex("block-hashing +1 +no"));
    const std::string told =
        expect_done({"walk", from, "--structure", "block-hashing:tables=2,blocks=3", "-o", few}).out;
    expect_done({"walk", few, "--structure", "block-hashing:block=64,found=1", "-o", many});
    expect_done({"walk", few, "--structure", "octree", "-o", back});
    const trace::TraceReader original(from), a(few), b(many), exact(back);
    for (const std::string& to : {few, many})
        EXPECT_THAT(expect_done({"info", to, "--verify"}).out,
                    HasSubstr("same way, and misses as many of the nearest photons\n"));
    EXPECT_THAT(expect_done({"info", back, "--verify"}).out, HasSubstr("and walks the same way\n"));
    const auto count = [](const trace::TraceReader& trace, const char* key) {
        return *trace.info().counts.find(key)->whole();
    };
    EXPECT_EQ(count(a, "nearest_photons"), original.info().found_photons);
    EXPECT_EQ(count(b, "nearest_photons"), original.info().found_photons);
    EXPECT_LT(count(a, "nearest_found"), count(b, "nearest_found"));
    EXPECT_LE(count(b, "nearest_found"), original.info().found_photons);
    EXPECT_THAT(told, HasSubstr(fmt::format(", recall {:.4f} of {} nearest photons",
                                            static_cast<double>(count(a, "nearest_found")) /
                                                static_cast<double>(count(a, "nearest_photons")),
                                            original.info().found_photons)));
    EXPECT_EQ(exact.info().counts, original.info().counts);
    const std::vector<results::Row> rows =
        results::from_csv(expect_done({"replay", many, "--order", "naive", "hilbert", "--layout", "heap-20",
                                       "van-emde-boas-14+6", "--cache", "4K:128:8"})
                              .out,
                          "stdout");
    ASSERT_EQ(rows.size(), 4u);
    for (const results::Row& row : rows) EXPECT_GE(row.traffic_bytes, row.compulsory_bytes);
    // Whoever says that more was found is refused.
    auto json = nlohmann::json::parse(content(fs::path(few) / "trace.json"));
    json["counts"]["nearest_found"] = count(a, "nearest_found") + 1;
    write(fs::path(few) / "trace.json", json.dump());
    expect_refused(bad_data, {"info", few, "--verify"},
                   {"counts.nearest_found", fmt::format("expected {}", count(a, "nearest_found"))});
}

TEST(WalkAgain, WalksThatTellWhatWasFoundReadPowerOfThatAlone) {
    const Scratch scratch;
    const std::string from = box_trace();
    for (const char* spec : {"left-balanced-kd:found=1", "median-kd:leaf=6,found=1",
                             "hashed-grid:cell=6,found=1", "octree:leaf=6,found=1"}) {
        const std::string to = (scratch / spec).string();
        expect_done({"walk", from, "--structure", spec, "-o", to});
        expect_done({"info", to, "--verify"});
        const trace::TraceReader walked(to);
        EXPECT_EQ(walked.info().structure, spec);
        const std::vector<results::Row> rows =
            results::from_csv(expect_done({"replay", to, "--order", "naive", "--layout", "depth-first-20",
                                           "depth-first-16", "depth-first-14+6", "--cache", "4K:128:8"})
                                  .out,
                              "stdout");
        ASSERT_EQ(rows.size(), 3u);
        // 6 of 20 bytes are read of the found photons alone, not of all that were looked at.
        const std::uint64_t looked = (*rows[0].raw_bytes - *rows[1].raw_bytes) / 4;
        EXPECT_GT(looked, walked.info().found_photons);
        EXPECT_EQ(*rows[2].raw_bytes, *rows[0].raw_bytes - 6 * (looked - walked.info().found_photons))
            << spec;
    }
    expect_refused(bad_usage, {"replay", from, "--order", "naive", "--layout", "heap-14+6"},
                   {"expected found=1"});
}

TEST(WalkAgain, CandidatesAreColumnsBesideTheSameWalks) {
    const Scratch scratch;
    const std::string from = box_trace();
    for (const char* spec : {"left-balanced-stack-free", "midpoint-kd:leaf=6,found=1", "grid:cell=6"}) {
        const std::string plain = (scratch / "plain").string(), to = (scratch / "to").string();
        expect_done({"walk", from, "--structure", spec, "-o", plain, "--force"});
        EXPECT_THAT(expect_done({"walk", from, "--structure", spec, "--candidates", "-o", to, "--force"}).out,
                    HasSubstr("photons entered the list a query"));
        EXPECT_THAT(expect_done({"info", to, "--verify"}).out,
                    testing::AllOf(HasSubstr("query_candidate_bytes"),
                                   HasSubstr("same way, with the same candidates\n")));
        const trace::TraceReader without(plain), with(to);
        EXPECT_EQ(with.digests().at("walk"), without.digests().at("walk")) << spec;
        EXPECT_FALSE(without.has("candidate"));
        EXPECT_EQ(with.digests().at("query_candidate_bytes").rows, with.info().queries);
        // Walked once more, they are another search's and are left behind unless they are asked for.
        const std::string again = (scratch / "again").string();
        expect_done({"walk", to, "--structure", "octree", "-o", again, "--force"});
        EXPECT_FALSE(trace::TraceReader(again).has("candidate"));
        EXPECT_FALSE(trace::TraceReader(again).has("query_candidate_bytes"));
    }
}

TEST_F(Walk, CandidatesAreToldOfColumnsToo) {
    expect_done(words({"--candidates"}));
    expect_done({"info", trace_.string(), "--verify"});
    trace::TraceReader trace(trace_);
    EXPECT_EQ(trace.column<std::uint32_t>("query_candidate_bytes").size(), 4u);
    EXPECT_FALSE(trace.column<std::uint8_t>("candidate").empty());
}

TEST(WalkAgain, WhatDoesNotFitIsRefused) {
    const Scratch scratch;
    const std::string from = box_trace(), to = (scratch / "t").string();
    expect_refused(bad_usage, {"walk", from, "--rays", "gather", "--candidates", "-o", to},
                   {"--candidates: found --rays"});
    expect_refused(bad_usage, {"walk", from, "--structure", "median", "-o", to},
                   {"unknown \"median\"", "nearest: median-kd"});
    expect_refused(bad_usage, {"walk", from, "--structure", "median-kd:leaf=65", "-o", to},
                   {"leaf is 65, expected 1 to 64"});
    expect_refused(bad_usage, {"walk", from, "--structure", "left-balanced-stack-free:leaf=4", "-o", to},
                   {"takes none"});
    expect_refused(bad_usage, {"walk", from, "--structure", "visits", "-o", to},
                   {"structure visits", "expected columns of visits"});
    expect_refused(bad_usage, {"walk", from, "--structure", "grid:cell=0", "-o", to},
                   {"cell is 0, expected 1 to 64"});
    expect_refused(bad_usage, {"walk", from, "--allow-overlaps", "-o", to}, {"without visit_element.npy"});
    expect_refused(bad_usage, {"walk", from, "--structure", "median-kd", "--k", "4", "-o", to},
                   {"expected no --k"});
    expect_refused(bad_usage, {"walk", from, "--structure", "median-kd", "-o", from, "--force"},
                   {"another folder"});
    EXPECT_FALSE(fs::exists(scratch / "t"));
}

TEST(WalkAgain, ADamagedTreeIsRefusedByColumnAndRow) {
    const Scratch scratch;
    const std::string to = (scratch / "t").string();
    expect_done({"walk", box_trace(), "--structure", "midpoint-kd:leaf=9", "-o", to});
    trace::TraceReader reader(to);
    const auto children = reader.column<std::uint32_t>("tree_child"),
               begins = reader.column<std::uint32_t>("tree_leaf_begin"),
               places = reader.column<std::uint32_t>("tree_photon");
    const auto with = [&](const char* name, std::span<const std::uint32_t> rows, std::size_t at,
                          std::uint32_t value, const std::vector<std::string>& words,
                          const std::vector<std::string>& parts) {
        const fs::path copy = scratch / "copy";
        fs::remove_all(copy);
        fs::copy(to, copy, fs::copy_options::recursive);
        std::vector<std::uint32_t> changed(rows.begin(), rows.end());
        changed.at(at) = value;
        const trace::ColumnDigest digest =
            write_column<std::uint32_t>(copy / (std::string(name) + ".npy"), changed);
        auto json = nlohmann::json::parse(content(copy / "trace.json"));
        json["columns"][name]["xxh3_64"] = fmt::format("{:016x}", digest.checksum);
        write(copy / "trace.json", json.dump());
        std::vector<std::string> all = words;
        all.insert(all.begin() + 1, copy.string());
        expect_refused(bad_data, all, parts);
    };
    const std::vector<std::string> replay{"replay", "--order", "naive"}, verify{"info", "--verify"};
    with("tree_child", children, 4, children[5], replay, {"tree_child.npy: row 5"});
    with("tree_child", children, 7, 2, replay, {"tree_child.npy: row 7: found 2"});
    with("tree_child", children, 0, 0xffffffff, replay, {"tree_child.npy: row 0"});
    with("tree_leaf_begin", begins, 3, begins[2], replay, {"tree_leaf_begin.npy: row 3"});
    with("tree_leaf_begin", begins, 0, 1, replay, {"tree_leaf_begin.npy"});
    with("tree_photon", places, 11, places[12], verify, {"tree_photon.npy: row 11"});
}

TEST(WalkAgain, DamagedElementsAreRefusedByColumnAndRow) {
    const Scratch scratch;
    const std::string to = (scratch / "t").string();
    expect_done({"walk", box_trace(), "--structure", "grid", "-o", to});
    trace::TraceReader reader(to);
    const auto with = [&](const char* name, std::size_t at, std::uint32_t value, const std::string& command,
                          const std::vector<std::string>& parts) {
        const fs::path copy = scratch / "copy";
        fs::remove_all(copy);
        fs::copy(to, copy, fs::copy_options::recursive);
        const auto rows = reader.column<std::uint32_t>(name);
        std::vector<std::uint32_t> changed(rows.begin(), rows.end());
        changed.at(at) = value;
        const trace::ColumnDigest digest =
            write_column<std::uint32_t>(copy / (std::string(name) + ".npy"), changed);
        auto json = nlohmann::json::parse(content(copy / "trace.json"));
        json["columns"][name]["xxh3_64"] = fmt::format("{:016x}", digest.checksum);
        write(copy / "trace.json", json.dump());
        std::vector<std::string> words{command, copy.string()};
        if (command == "info") words.emplace_back("--verify");
        if (command == "replay") words.insert(words.end(), {"--order", "naive"});
        expect_refused(bad_data, words, parts);
    };
    const auto entries =
        static_cast<std::uint32_t>(std::count(reader.column<std::uint32_t>("element_region").begin(),
                                              reader.column<std::uint32_t>("element_region").end(),
                                              static_cast<std::uint32_t>(trace::Region::directory)));
    ASSERT_GT(entries, 10u);
    with("element_region", 3, 1, "replay", {"element_region.npy: row 3: found 1", "5 directory"});
    with("element_region", 3, 3, "replay", {"element_region.npy: row 4: found 5 again", "together"});
    with("element_parent", 1, 2, "info", {"element_parent.npy: row 0", "another structure"});
    with("element_parent", 5, 0xffffffff, "replay", {"element_parent.npy: row 5"});
    with("tree_leaf_begin", 2, 0, "replay", {"tree_leaf_begin.npy: row 2"});
    with("tree_photon", 4, 5, "info", {"tree_photon.npy: row 4"});
}

}  // namespace
}  // namespace regather::cli
