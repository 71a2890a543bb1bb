// `regather walk` of what another program has walked: columns of elements and visits.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cachesim/cache_list.h"
#include "experiment/traffic_map.h"
#include "reorder/catalogue.h"
#include "replay/layouts/catalogue.h"
#include "results/csv.h"
#include "results/detail_row.h"
#include "tests/cli/expect.h"
#include "tests/column.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::UnorderedElementsAre;
using trace::Vec3;

/// Seven elements: nodes 0, 2 and 5 of 16 bytes with 1, 3, 4 and 6 of 40, 8, 8 and 100 below them.
///   0 -> 1, 2;  2 -> 3, 5;  5 -> 4, 6
class Visits : public testing::Test {
protected:
    Visits() {
        fs::create_directories(columns_);
        column<std::uint32_t>("visit_element", {0, 1, 0, 2, 3, 0, 2, 5, 6, 4, 0});
        column<std::uint32_t>("query_visits", {2, 3, 0, 5, 1});
        column<Vec3>("query_position", {{0, 0, 0}, {1, 5, 1}, {2, 2, 2}, {3, 1, 3}, {4, 4, 0}});
        column<std::uint32_t>("element_bytes", {16, 40, 16, 8, 8, 16, 100});
    }
    template <class T>
    void column(const std::string& name, const std::vector<T>& rows) const {
        write_column<T>(columns_ / (name + ".npy"), rows);
    }
    void tree() const {
        column<std::uint32_t>("element_region", {3, 2, 3, 2, 2, 3, 2});
        column<std::uint32_t>("element_parent", {0, 0, 0, 2, 5, 2, 5});
    }
    void addresses() const {
        column<std::uint64_t>("element_address", {4096, 5000, 4112, 6000, 6008, 4128, 7000});
    }
    std::vector<std::string> words(const std::vector<std::string>& more = {}) const {
        return std::vector<std::string>{"walk", columns_.string(), "-o", trace_.string()} + more;
    }
    std::vector<results::Row> rows(const std::vector<std::string>& more) const {
        return results::from_csv(expect_done(std::vector<std::string>{"replay", trace_.string()} + more).out,
                                 "stdout");
    }
    void refused(const std::vector<std::string>& parts) const {
        expect_refused(bad_data, words(), parts);
        EXPECT_FALSE(fs::exists(trace_ / "trace.json"));
    }

    const Scratch scratch_;
    const fs::path columns_ = scratch_ / "mine", trace_ = scratch_ / "trace";
};

TEST_F(Visits, FourColumnsAreEnough) {
    EXPECT_THAT(expect_done(words()).out, HasSubstr("7 elements, 5 queries, 11 elements visited"));
    EXPECT_THAT(expect_done({"info", trace_.string(), "--verify"}).out,
                testing::AllOf(HasSubstr("visits, 7 elements"), HasSubstr("2.2 nodes visited"),
                               HasSubstr("the walks were brought")));
    // Bytes of all visits: 56 + 40 + 0 + 156 + 16. Elements lie at 0, 16, 56, 72, 80, 88 and 104 up to 204.
    const std::vector<results::Row> found = rows({"--order", "naive", "--cache", "1K:32:full"});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].structure, "visits");
    EXPECT_EQ(found[0].layout, "heap-own");
    EXPECT_EQ(found[0].raw_bytes, 268u);
    EXPECT_EQ(found[0].oracle_bytes, 0u);
    // All elements are visited: seven lines of 32 bytes. Lines touched: 1 + 2 | 1 + 2 + 1 | 1 + 2 + 2 + 4 + 1
    // | 1.
    EXPECT_EQ(found[0].compulsory_bytes, 7u * 32);
    EXPECT_EQ(found[0].traffic_bytes, 7u * 32);
    EXPECT_EQ(found[0].accesses, 18u);
}

TEST_F(Visits, OrderingsLayoutsCachesAndChartsRunOnThem) {
    tree();
    addresses();
    column<Vec3>("query_direction", {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {0, -1, 0}});
    column<std::uint32_t>("query_pixel", {0, 1, 1, 2, 3});
    column<std::uint32_t>("query_leaf_kd", {3, 2, 1, 0, 0});
    column<std::uint32_t>("query_leaf_bvh", {0, 0, 1, 1, 2});
    column<std::uint32_t>("query_stratum", {5u << 16 | 7, 1, 40000u << 16, 9, 65535});
    expect_done(words({"--width", "2"}));
    expect_done({"info", trace_.string(), "--verify"});
    std::vector<std::string> all{"--order"};
    std::size_t orderings = 0;
    for (const reorder::Entry& entry : reorder::catalogue()) {
        if (entry.name.starts_with("origin-")) continue;  // of rays
        all.emplace_back(entry.name);
        ++orderings;
    }
    all.emplace_back("--layout");
    std::size_t layouts = 0;
    for (const replay::LayoutOrder& order : replay::layout_orders()) {
        if (order.name == "hilbert" || order.name == "morton") continue;  // want positions of what is walked
        all.push_back(std::string(order.name) + "-own");
        ++layouts;
    }
    const fs::path csv = scratch_ / "rows.csv";
    expect_done(std::vector<std::string>{"replay", trace_.string(), "--cache", "128:32:2", "1K:32:full",
                                         "--classes", "--buffers", "--csv", csv.string()} +
                all);
    const std::vector<results::Row> found = results::read_csv(csv);
    EXPECT_EQ(found.size(), 2 * layouts * orderings);
    for (const results::Row& row : found) {
        EXPECT_EQ(row.raw_bytes, 268u) << row.layout;
        EXPECT_GE(row.traffic_bytes, row.compulsory_bytes);
    }
    const fs::path detail = scratch_ / "detail.csv";
    expect_done({"detail", trace_.string(), "--order", "naive", "hilbert", "--cache", "128:32:2", "--csv",
                 detail.string()});
    EXPECT_THAT(content(detail), testing::AllOf(HasSubstr(",nodes,2,"), HasSubstr(",other,3,")));
    expect_done({"replay", trace_.string(), "--order", "naive", "--machine", "paper-128k"});
    expect_done(
        {"chart", detail.string(), "--kind", "traffic-by-depth", "-o", (scratch_ / "charts").string()});
    expect_done({"chart", csv.string(), "-o", (scratch_ / "charts").string()});
    EXPECT_FALSE(fs::is_empty(scratch_ / "charts"));
}

TEST_F(Visits, AHeatMapAndASampleAreOfThem) {
    const fs::path map = scratch_ / "map";
    expect_done(words({"--width", "3"}));  // five queries, a pixel each: 3 x 2
    expect_done(
        {"heatmap", trace_.string(), "--order", "naive", "--cache", "1K:32:full", "-o", map.string()});
    // Lines of 32 bytes that are first touched by each query: 0 and 1 | 2 | | 3 to 6 | .
    trace::TraceReader trace(trace_);
    const auto maps =
        experiment::traffic_maps(trace, experiment::parse_orderings(std::vector<std::string>{"naive"}),
                                 cachesim::parse_caches("1K:32:full")[0], {});
    EXPECT_THAT(maps.at(0).bytes, ElementsAre(64, 32, 0, 128, 0, 0));
    EXPECT_TRUE(fs::exists(map / "traffic.png"));

    // Elements 64 KiB apart are all on set 0 of a cache with so large ways: by most seeds no sample is of it.
    column<std::uint64_t>("element_address", {0, 65536, 131072, 196608, 262144, 327680, 393216});
    column<std::uint32_t>("query_visits", {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
    column<Vec3>("query_position", std::vector<Vec3>(11));
    column<std::uint32_t>("visit_element", {0, 1, 2, 3, 4, 5, 6, 6, 5, 4, 3});
    expect_done(words({"--force"}));
    const std::vector<std::string> sampled{"replay",  trace_.string(), "--order",  "naive",
                                           "--cache", "64K:64:4",      "--sample", "16"};
    expect_refused(bad_data, sampled, {"sampling", "no touched line", "seed 1"});
}

TEST_F(Visits, AtTheirAddressesTheyShareTheLinesThatTheyShared) {
    tree();
    addresses();
    expect_done(words());
    // 4096 .. 4144 is one line of 64, so are 5000 .. 5040 and 6000 .. 6016; 7000 .. 7100 are two.
    const std::vector<results::Row> found = rows({"--order", "random", "--cache", "4K:64:full"});
    EXPECT_EQ(found.at(0).layout, "given-own");
    EXPECT_EQ(found.at(0).traffic_bytes, 64u * (1 + 1 + 1 + 2));
    // The roots' level is on chip: the line of the nodes is still read for 2 and 5.
    EXPECT_EQ(
        rows({"--order", "random", "--layout", "given-own:top=1", "--cache", "4K:64:full"}).at(0).raw_bytes,
        268u - 4 * 16);
}

TEST_F(Visits, ElementsAreNumberedByRegion) {
    tree();
    column<std::uint32_t>("element_level", {7, 1, 2, 3, 4, 5, 6});
    expect_done(words());
    trace::TraceReader trace(trace_);
    // 1, 3, 4 and 6 are `other`, which comes first; then 0, 2 and 5.
    EXPECT_THAT(trace.column<std::uint32_t>("element_region"), ElementsAre(2, 2, 2, 2, 3, 3, 3));
    EXPECT_THAT(trace.column<std::uint32_t>("element_bytes"), ElementsAre(40, 8, 8, 100, 16, 16, 16));
    EXPECT_THAT(trace.column<std::uint32_t>("element_level"), ElementsAre(1, 3, 4, 6, 7, 2, 5));
    EXPECT_THAT(trace.column<std::uint32_t>("element_parent"), ElementsAre(4, 5, 6, 6, 4, 4, 5));
}

TEST_F(Visits, CountsMayHaveEightBytes) {
    column<std::uint64_t>("query_visits", {2, 3, 0, 5, 1});
    expect_done(words());
    EXPECT_EQ(trace::TraceReader(trace_).info().visited_nodes, 11u);
}

TEST_F(Visits, NoQueriesAndNoElementsAreATrace) {
    column<std::uint32_t>("visit_element", {});
    column<std::uint32_t>("query_visits", {});
    column<Vec3>("query_position", {});
    column<std::uint32_t>("element_bytes", {});
    expect_done(words());
    expect_done({"info", trace_.string(), "--verify"});
    EXPECT_EQ(rows({"--order", "hilbert"}).at(0).traffic_bytes, 0u);
}

TEST_F(Visits, ListsThatDoNotAddUpAreRefused) {
    column<std::uint32_t>("query_visits", {2, 3, 0, 7, 1});
    refused({"query_visits.npy: row 3: found 7", "at most 6", "the 11 rows of visit_element.npy"});
    column<std::uint32_t>("query_visits", {2, 3, 0, 5, 0});
    refused({"query_visits.npy: found 10 visits in 5 rows, expected 11"});
    column<std::uint32_t>("query_visits", {2, 3, 6});
    refused({"query_visits.npy: found 3 rows, expected 5 as in query_position.npy"});
    column<float>("query_visits", {1});
    refused({"query_visits.npy", "'<f4'", "uint32 or uint64"});
    fs::remove(columns_ / "query_visits.npy");
    refused({"query_visits.npy", "No such file"});
}

TEST_F(Visits, ElementsBeyondTheStructureAreRefused) {
    column<std::uint32_t>("visit_element", {0, 1, 0, 2, 3, 0, 7, 5, 6, 4, 0});
    refused(
        {"visit_element.npy: row 6: found 7, expected an element below 7, the rows of element_bytes.npy"});
}

TEST_F(Visits, BytesThatTwoElementsShareAreRefusedUnlessAllowed) {
    column<std::uint64_t>("element_address", {4096, 5000, 4112, 6000, 6007, 4128, 7000});
    refused({"element_address.npy: row 4: found 6007, expected at least 6008, where element 3 ends",
             "--allow-overlaps"});
    expect_done(words({"--allow-overlaps"}));
    expect_done({"info", trace_.string(), "--verify"});
    EXPECT_EQ(rows({"--order", "naive"}).at(0).layout, "given-own");
    // A trace that says nothing of them is refused.
    auto json = nlohmann::json::parse(content(trace_ / "trace.json"));
    json["parameters"].erase("overlaps");
    write(trace_ / "trace.json", json.dump());
    expect_refused(bad_data, {"replay", trace_.string(), "--order", "naive"}, {"element_address.npy: row 4"});
}

TEST_F(Visits, ColumnsOfElementsAreCheckedByRow) {
    const auto with = [&]<class T>(const char* name, const std::vector<T>& values,
                                   const std::vector<std::string>& parts) {
        column<T>(name, values);
        refused(parts);
        fs::remove(columns_ / (std::string(name) + ".npy"));
    };
    using U = std::uint32_t;
    with("element_region", std::vector<U>{3, 3, 1, 3, 3, 3, 3},
         {"element_region.npy: row 2: found 1, expected one of 0 photons, 2 other, 3 nodes"});
    with("element_region", std::vector<U>{3, 3},
         {"element_region.npy: found 2 rows, expected 7 as in element_bytes"});
    with("element_parent", std::vector<U>{0, 0, 0, 2, 5, 7, 5}, {"element_parent.npy: row 5: found 7"});
    with("element_parent", std::vector<U>{0, 0, 3, 5, 5, 2, 5}, {"element_parent.npy: row 2", "circle"});
    with("element_level", std::vector<U>{0, 1, 1, 65536, 1, 1, 1}, {"element_level.npy: row 3: found 65536"});
    with("element_address", std::vector<std::uint64_t>{0, 16, 99, 200, 300, 400, ~0ull - 50},
         {"element_address.npy: row 6", "100 bytes"});
    with("element_color", std::vector<U>{1}, {"unknown column \"element_color\"", "element_level"});
    column<U>("element_bytes", {16, 40, 16, 8, 8, 16, (1u << 24) + 1});
    refused({"element_bytes.npy: row 6: found 16777217, expected at most 16777216"});
    fs::remove(columns_ / "element_bytes.npy");
    refused({"element_bytes.npy", "No such file"});
}

TEST_F(Visits, WhatContradictsBroughtWalksIsRefused) {
    expect_refused(bad_usage, words({"--candidates"}),
                   {"--candidates: found visits that are brought, expected photons that are searched for"});
    for (const char* option : {"--k", "--radius", "--structure"})
        expect_refused(bad_usage, words({option, std::string(option) == "--structure" ? "grid" : "5"}),
                       {"visit_element.npy", option});
    expect_refused(bad_usage, words({"--allow-overlaps"}),
                   {"--allow-overlaps", "without element_address.npy"});
    column<Vec3>("photon_position", {{0, 0, 0}});
    refused({"photon_position.npy beside visit_element.npy"});
    fs::remove(columns_ / "photon_position.npy");
    expect_done(words());
    const auto before = contents(trace_);
    column<std::uint32_t>("query_visits", {2, 3, 0, 5, 0});
    expect_refused(bad_data, words({"--force"}), {"query_visits.npy"});
    EXPECT_EQ(contents(trace_), before);
    // There is nothing to search again, nor to race.
    expect_refused(bad_data,
                   {"walk", trace_.string(), "--structure", "grid", "-o", (scratch_ / "t").string()},
                   {"photon.npy", "the walks were brought as visits"});
    expect_refused(bad_data, {"race", trace_.string(), "--order", "naive"}, {"parameters.radius"});
    for (const char* layout : {"heap-20", "given-own", "depth-first-own", "hilbert-own"})
        expect_refused(bad_usage, {"replay", trace_.string(), "--order", "naive", "--layout", layout},
                       {"layout"});
    const auto with_layout = [&](const char* layout) {
        return std::vector<std::string>{"replay", trace_.string(), "--order", "naive", "--layout", layout};
    };
    expect_refused(bad_usage, with_layout("heap-own:node=8"),
                   {"heap-own: node: found 8, expected none", "elements say"});
    expect_refused(bad_usage, with_layout("heap-own:line=64"),
                   {"heap-own: line: found 64, expected none", "only clusters"});
}

}  // namespace
}  // namespace regather::cli
