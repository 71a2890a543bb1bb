// `regather walk --rays`: a captured trace's rays as a trace of their own; and in treelet queues.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "results/csv.h"
#include "results/machine_row.h"
#include "spatial/rays/ray_structures.h"
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using trace::Vec3;

fs::path walked(const Scratch& scratch, const std::string& rays, const std::string& structure) {
    const fs::path to = scratch / fmt::format("{} {}", rays, structure);
    expect_done({"walk", box_trace(), "--rays", rays, "--structure", structure, "-o", to.string()});
    return to;
}

std::vector<results::Row> replayed(const fs::path& trace, const std::vector<std::string>& more) {
    return results::from_csv(expect_done(std::vector<std::string>{"replay", trace.string()} + more).out,
                             "stdout");
}

TEST(Rays, OfEveryKindAreATraceInEveryStructure) {
    const Scratch scratch;
    trace::TraceReader original(box_trace());
    for (const std::string kind : {"eye", "shadow", "gather"})
        for (const std::string structure :
             {"ray-bvh", "bvh-2", "bvh-4:leaf=2", "bvh-8:quantised=1,stack=1"}) {
            const fs::path to = walked(scratch, kind, structure);
            expect_done({"info", to.string(), "--verify"});
            trace::TraceReader rays(to);
            const auto origin = original.column<Vec3>(fmt::format("ray_{}_origin", kind)),
                       position = rays.column<Vec3>("query_position");
            EXPECT_TRUE(std::equal(origin.begin(), origin.end(), position.begin(), position.end()));
            EXPECT_EQ(rays.info().photons, 0u);
            EXPECT_EQ(*rays.info().parameters.find("renderer"), *original.info().parameters.find("renderer"));
            EXPECT_EQ(rays.info().scene, "box");
            EXPECT_EQ(rays.info().image_width, 16u);
            const std::vector<results::Row> rows =
                replayed(to, {"--order", "naive", "random", "tiled", "direction-binned", "hilbert", "hashed",
                              "bvh-leaf", "origin-direction", "origin-end", "origin-guess", "--cache",
                              "1K:64:2", "4M:64:full"});
            ASSERT_EQ(rows.size(), 20u);
            for (const results::Row& row : rows) {
                EXPECT_EQ(row.queries, origin.size());
                EXPECT_THAT(row.structure, testing::EndsWith(kind + " rays"));
                EXPECT_THAT(row.layout, testing::StartsWith("depth-first-48:node="));
                EXPECT_EQ(row.oracle_bytes, 0u);
                EXPECT_GE(row.traffic_bytes, row.compulsory_bytes);
                if (*row.cache_bytes > 1024) {
                    EXPECT_EQ(row.traffic_bytes, row.compulsory_bytes);
                }
            }
        }
}

// Where a gather ray ends on a surface that is not specular, the capture asked for photons.
TEST(Rays, EndWhereTheCaptureFoundSurfaces) {
    const Scratch scratch;
    trace::TraceReader original(box_trace()), rays(walked(scratch, "gather", "bvh-4"));
    const auto asked = original.column<Vec3>("query_position"), end = rays.column<Vec3>("query_end");
    const auto asked_pixel = original.column<std::uint32_t>("query_pixel"),
               pixel = rays.column<std::uint32_t>("query_pixel");
    ASSERT_GT(asked.size(), 1000u);
    std::size_t at = 0;
    for (std::size_t q = 0; q < asked.size(); ++q, ++at) {
        while (at < end.size() && (pixel[at] != asked_pixel[q] || trace::length(end[at] - asked[q]) > 2e-4f))
            ++at;
        ASSERT_LT(at, end.size()) << "query " << q;
    }
    EXPECT_GE(*rays.info().counts.find("hits")->whole(), asked.size());
}

TEST(Rays, HitAlikeInEveryStructure) {
    const Scratch scratch;
    for (const std::string kind : {"eye", "shadow", "gather"}) {
        const fs::path first = walked(scratch, kind, "ray-bvh");
        trace::TraceReader renderers(first);
        for (const std::string structure : {"bvh-2:leaf=1", "bvh-8", "bvh-4:quantised=1"}) {
            const trace::TraceReader other(walked(scratch, kind, structure));
            EXPECT_EQ(*other.info().counts.find("hits"), *renderers.info().counts.find("hits"));
            EXPECT_EQ(other.digests().at("query_end"), renderers.digests().at("query_end"));
        }
        EXPECT_EQ(*trace::TraceReader(walked(scratch, kind, "bvh-4")).info().counts.find("triangles"),
                  *renderers.info().counts.find("triangles"));
    }
}

TEST(Rays, NodesTrianglesAndStackAreToldApart) {
    const Scratch scratch;
    const fs::path plain = walked(scratch, "gather", "bvh-2"),
                   spilled = walked(scratch, "gather", "bvh-2:stack=1"), csv = scratch / "detail.csv";
    const std::vector<std::string> one{"--order", "naive", "--cache", "1K:64:2", "--layout"};
    const auto raw = [&](const fs::path& trace, const std::string& layout) {
        return *replayed(trace, one + std::vector<std::string>{layout})[0].raw_bytes;
    };
    // 64 bytes a node, 48 or 36 a triangle, 8 an entry.
    const trace::TraceReader without(plain), with(spilled);
    EXPECT_EQ(raw(spilled, "heap-48") - raw(plain, "heap-48"),
              8 * (with.info().visited_nodes - without.info().visited_nodes));
    EXPECT_GT(with.info().visited_nodes, without.info().visited_nodes);
    const std::uint64_t twelve = raw(plain, "heap-48") - raw(plain, "heap-36");
    EXPECT_EQ(twelve % 12, 0u);
    EXPECT_GT(twelve, 0u);
    EXPECT_EQ((raw(plain, "depth-first-36:node=128") - raw(plain, "depth-first-36")) % 64, 0u);
    EXPECT_LT(raw(plain, "depth-first-36:top=2"), raw(plain, "depth-first-36"));
    expect_done(
        {"detail", spilled.string(), "--order", "naive", "--cache", "1K:64:2", "--csv", csv.string()});
    for (const char* region : {",nodes,", ",triangles,", ",stack,"})
        EXPECT_THAT(content(csv), HasSubstr(region));
    EXPECT_THAT(content(csv), testing::Not(HasSubstr(",photons,")));
    expect_done({"heatmap", spilled.string(), "--order", "naive", "-o", (scratch / "map").string()});
}

TEST(Rays, WhatDoesNotFitIsRefused) {
    const Scratch scratch;
    const std::string to = (scratch / "t").string();
    const auto refused = [&](int code, const std::vector<std::string>& words,
                             const std::vector<std::string>& parts) {
        expect_refused(code, std::vector<std::string>{"walk", box_trace(), "-o", to} + words, parts);
        EXPECT_FALSE(fs::exists(to));
    };
    refused(bad_usage, {"--rays", "gathr"}, {"--rays: found \"gathr\"", "\"gather\""});
    refused(bad_usage, {"--rays", "eye", "--structure", "median-kd"}, {"unknown \"median-kd\"", "bvh-4"});
    refused(bad_usage, {"--rays", "eye", "--structure", "bvh-4:leaf=9"},
            {"bvh-4: leaf is 9, expected 1 to 8"});
    refused(bad_usage, {"--rays", "eye", "--structure", "bvh-4:quantised=2"}, {"quantised is 2"});
    refused(bad_usage, {"--rays", "eye", "--structure", "ray-bvh:leaf=2"}, {"leaf", "stack"});
    refused(bad_usage, {"--structure", "bvh-4"}, {"--structure: found bvh-4", "--rays"});
    refused(bad_usage, {"--scene", "box"}, {"--scene", "--rays"});
    refused(bad_usage, {"--rays", "eye", "--k", "5"}, {"--rays", "--k"});
    refused(bad_usage, {"--rays", "eye", "--scene", "nowhere"}, {"nowhere", "--scene"});
    refused(bad_data, {"--rays", "eye", "--scene", "room"}, {"parameters.scene_checksum", "--scene"});
    refused(bad_data, {"--rays", "specular"}, {"ray_specular_origin.npy", "no such column"});
    expect_refused(bad_usage, {"walk", box_trace(), "--rays", "eye", "-o", box_trace(), "--force"},
                   {"another folder"});

    for (const char* order : {"origin-end", "origin-guess"})
        expect_refused(bad_data, {"replay", box_trace(), "--order", order},
                       {"query_", "no such column", "regather walk TRACE --rays KIND"});
    const fs::path rays = walked(scratch, "eye", "bvh-4:leaf=3");
    expect_refused(bad_data, {"walk", rays.string(), "--rays", "eye", "-o", to},
                   {"parameters.scene_checksum"});
    expect_refused(bad_data, {"walk", rays.string(), "-o", to}, {"photon.npy", "rays are not searches"});
    expect_refused(bad_data, {"race", rays.string(), "--order", "naive"}, {"radius"});
    const auto replay = [&](const char* layout) {
        return std::vector<std::string>{"replay", rays.string(), "--order", "naive", "--layout", layout};
    };
    expect_refused(bad_usage, replay("heap-20"), {"unknown record of a triangle \"20\"", "36, 48"});
    expect_refused(bad_usage, replay("heap-48:node=64"), {"node is 64, expected 128 to 1024"});
    expect_refused(bad_usage, {"replay", box_trace(), "--order", "naive", "--layout", "heap-48"},
                   {"unknown record \"48\""});
    expect_refused(bad_data, {"replay", box_trace(), "--order", "origin-end"},
                   {"query_end.npy", "no such column"});
}

TEST(Rays, ADamagedTraceIsRefused) {
    const Scratch scratch;
    const fs::path rays = walked(scratch, "eye", "bvh-4:leaf=3"), json = rays / "trace.json";
    const std::string whole = content(json);
    const auto refused = [&](const std::string& from, const std::string& to,
                             const std::vector<std::string>& parts) {
        std::string text = whole;
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        write(json, text.replace(at, from.size(), to));
        expect_refused(bad_data, {"replay", rays.string(), "--order", "naive"}, parts);
    };
    refused("bvh-4:leaf=3", "bvh-2:leaf=3", {"tree_child.npy"});
    refused("bvh-4:leaf=3", "bvh-5:leaf=3", {"unknown \"bvh-5\""});
    refused("\"rays\": \"eye\"", "\"rays\": \"all\"", {"parameters.rays", "\"all\"", "\"gather\""});
    refused("\"structure_version\": 1", "\"structure_version\": 2", {"structure_version: found 2"});
    refused("\"photons\": 0", "\"photons\": 3", {"photons: found 3", "rows of photon"});
    refused("\"k\": 0", "\"k\": 5", {"found no photon"});
}

TEST(TreeletQueues, OneTreeletIsThePlainOrderAndSmallOnesCost) {
    const Scratch scratch;
    const std::string gather = walked(scratch, "gather", "bvh-4").string(),
                      csv = (scratch / "t.csv").string();
    const std::vector<std::string> words{
        "replay",     gather,  "--order", "naive", "origin-end:bits=4", "--cache", "1K:64:2",  "16K:64:full",
        "--treelets", "1G,1K", "--queue", "50",    "--onchip",          "1K",      "--buffers"};
    expect_done(words + std::vector<std::string>{"--csv", csv});
    const auto rows = results::read_csv(csv);
    ASSERT_EQ(rows.size(), 12u);
    for (std::size_t order = 0; order < 2; ++order)
        for (std::size_t cache = 0; cache < 2; ++cache) {
            const results::Row &plain = rows[order * 6 + cache], &one = rows[order * 6 + 2 + cache],
                               &small = rows[order * 6 + 4 + cache];
            EXPECT_EQ(one.misses, plain.misses);
            EXPECT_EQ(one.accesses, plain.accesses);
            EXPECT_EQ(one.raw_bytes, plain.raw_bytes);
            EXPECT_EQ(one.compulsory_bytes, plain.compulsory_bytes);
            EXPECT_EQ(one.reorder_bytes, plain.reorder_bytes);
            EXPECT_EQ(one.buffer_traffic_bytes, plain.buffer_traffic_bytes);
            EXPECT_EQ(one.moved_records, plain.moved_records);
            EXPECT_EQ(small.accesses, plain.accesses);
            EXPECT_EQ(small.raw_bytes, plain.raw_bytes);
            const std::uint64_t pushes = *small.moved_records - *plain.moved_records;
            EXPECT_GT(pushes, 0u);
            EXPECT_GE(*small.reorder_bytes - *plain.reorder_bytes, 2 * 48 * pushes);
            EXPECT_GT(small.buffer_traffic_bytes, 0u);
            EXPECT_GE(*small.buffered_bytes - *plain.buffered_bytes, 50u * 48);
        }
    EXPECT_EQ(rows[2].ordering, "naive+treelets");
    EXPECT_EQ(rows[2].parameters, "naive+treelets:treelet=1073741824,rays=50");
    EXPECT_EQ(rows[10].parameters, "origin-end+treelets:bits=4,treelet=1024,rays=50");
    // On the chip nothing goes through memory.
    const auto held = results::from_csv(
        expect_done({"replay", gather, "--order", "naive", "--treelets", "1K", "--queue", "50"}).out,
        "stdout");
    EXPECT_EQ(held[1].reorder_bytes, 0u);
    EXPECT_EQ(held[1].buffer_traffic_bytes, 0u);

    const auto regions = results::from_csv<results::MachineRow>(
        expect_done({"replay", gather, "--order", "naive", "--treelets", "1K", "--queue", "50", "--onchip",
                     "1K", "--machine", "paper-128k"})
            .out,
        "stdout");
    std::map<std::string, std::uint64_t> accesses;
    for (const results::MachineRow& row : regions)
        if (row.level == "L1") accesses[row.ordering + ' ' + row.region] += *row.accesses;
    EXPECT_EQ(accesses.at("naive+treelets nodes"), accesses.at("naive nodes"));
    EXPECT_EQ(accesses.at("naive+treelets triangles"), accesses.at("naive triangles"));
    EXPECT_GT(accesses.at("naive+treelets reorder_buffer"), 0u);
    EXPECT_GT(accesses.at("naive+treelets stack"), 0u);

    expect_refused(bad_usage,
                   {"replay", box_trace(), "--order", "naive", "--treelets", "1K", "--queue", "50"},
                   {"treelets: found walks through left-balanced-kd", "walk --rays"});
    expect_refused(bad_usage, {"replay", gather, "--order", "naive", "--treelets", "0", "--queue", "50"},
                   {"--treelets: found 0, expected 1 to 1073741824 bytes"});
    expect_refused(bad_usage, {"replay", gather, "--order", "naive", "--treelets", "1K", "--queue", "0"},
                   {"--queue", "'0'"});
}

}  // namespace
}  // namespace regather::cli
