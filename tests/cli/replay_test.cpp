// `regather replay`: rows for every ordering, and damaged traces.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reorder/catalogue.h"
#include "results/csv.h"
#include "tests/cli/expect.h"
#include "tests/column.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr, testing::StartsWith;

/// But for those that read where a ray ends.
std::vector<std::string> every_ordering() {
    std::vector<std::string> words{"--order"};
    for (const reorder::Entry& entry : reorder::catalogue())
        if (entry.name != "origin-end" && entry.name != "origin-guess") words.emplace_back(entry.name);
    return words;
}

TEST(Replay, EveryOrderingGetsARowForEachCache) {
    const Scratch scratch;
    const fs::path csv = scratch / "rows.csv";
    const std::string trace = box_trace();
    expect_done(std::vector<std::string>{"replay", trace} + every_ordering() +
                std::vector<std::string>{"--cache", "4K:128:8", "2K:64:full", "--csv", csv.string()});
    EXPECT_THAT(
        content(csv),
        StartsWith(
            "scene,frame,ordering,tile,bins,structure,layout,policy,cache_bytes,line_bytes,ways,queries,"
            "accesses,raw_bytes,oracle_bytes,compulsory_bytes,misses,traffic_bytes,reorder_bytes,key_ops,"
            "moved_records,buffered_bytes,recast_rays,order_seconds,replay_seconds"));
    const std::vector<results::Row> rows = results::read_csv(csv);
    const std::vector<std::string> orderings = every_ordering();
    ASSERT_EQ(rows.size(), 2 * (orderings.size() - 1));
    const trace::TraceReader reader(trace);
    const std::uint64_t nodes = reader.info().visited_nodes, photons = reader.info().found_photons;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const results::Row& row = rows[r];
        EXPECT_EQ(row.ordering, orderings[1 + r / 2]);
        EXPECT_EQ(row.scene, "box");
        EXPECT_EQ(row.cache_bytes, r % 2 == 0 ? 4096u : 2048u);
        EXPECT_EQ(row.ways, r % 2 == 0 ? 8u : 0u);
        EXPECT_EQ(row.queries, reader.info().queries);
        EXPECT_EQ(row.raw_bytes, 20 * nodes);
        EXPECT_EQ(row.oracle_bytes, 20 * photons);
        EXPECT_EQ(row.traffic_bytes, row.misses.value_or(0) * row.line_bytes.value_or(0));
        EXPECT_GE(row.accesses, nodes);
        // All 2000 photons are 40,000 bytes: no fewer than one line, no more than all of them.
        EXPECT_GT(row.compulsory_bytes, 0u);
        EXPECT_LE(row.compulsory_bytes, 40'064u);
        EXPECT_GE(row.traffic_bytes, row.compulsory_bytes);
        EXPECT_TRUE(row.order_seconds && row.replay_seconds);
    }
}

TEST(Replay, ACacheThatHoldsAllMissesOnlyTheCompulsory) {
    const std::string csv =
        expect_done({"replay", box_trace(), "--order", "random", "--cache", "1M:128:full"}).out;
    const results::Row row = results::from_csv(csv, "stdout").at(0);
    EXPECT_EQ(row.traffic_bytes, row.compulsory_bytes);
}

TEST(Replay, EachLayoutGetsRowsOfItsOwn) {
    const std::string trace = box_trace();
    const auto rows = [&](std::vector<std::string> layouts) {
        return results::from_csv(
            expect_done(std::vector<std::string>{"replay", trace, "--order", "random", "naive", "--cache",
                                                 "4K:128:8", "1M:128:full"} +
                        layouts)
                .out,
            "stdout");
    };
    const std::vector<std::string> names{"heap-20", "van-emde-boas-20", "clusters-16:line=64,top=2"};
    const std::vector<results::Row> alone = rows({}),
                                    all = rows(std::vector<std::string>{"--layout"} + names);
    ASSERT_EQ(all.size(), 12u);
    const std::uint64_t nodes = trace::TraceReader(trace).info().visited_nodes,
                        queries = trace::TraceReader(trace).info().queries;
    for (std::size_t r = 0; r < all.size(); ++r) {
        EXPECT_EQ(all[r].layout, names[r / 4]);
        EXPECT_GE(all[r].traffic_bytes, all[r].compulsory_bytes);
        if (r % 2 == 1) {
            EXPECT_EQ(all[r].traffic_bytes, all[r].compulsory_bytes) << "a cache for all of it";
        }
        EXPECT_EQ(all[r].oracle_bytes, all[0].oracle_bytes);
    }
    for (std::size_t r = 0; r < 4; ++r) {
        EXPECT_EQ(all[r].misses, alone[r].misses);
        EXPECT_EQ(all[r].net_benefit_bytes, alone[r].net_benefit_bytes);
    }
    EXPECT_EQ(all[4].raw_bytes, 20 * nodes);
    // The root and, mostly, one or both of its children are on chip.
    EXPECT_LT(all[8].raw_bytes, 16 * (nodes - queries));
    EXPECT_GE(all[8].raw_bytes, 16 * (nodes - 3 * queries));
    // Some other lines are missed: the layout has come through.
    EXPECT_NE(all[4].misses, all[0].misses);
}

TEST(Replay, ALayoutThatIsNotOneIsRefused) {
    const std::string trace = box_trace();
    expect_refused(2, {"replay", trace, "--order", "naive", "--layout", "heaps-20"}, {"nearest: heap"});
    expect_refused(2,
                   {"replay", trace, "--order", "naive", "--layout", "clusters-20", "clusters-20:line=128"},
                   {"clusters-20:line=128 twice"});
}

TEST(Replay, TheJsonBesideTheCsvSaysHowItCameToBe) {
    const Scratch scratch;
    const std::string trace = box_trace(), csv = (scratch / "rows.csv").string();
    expect_done({"replay", trace, "--order", "naive", "--csv", csv});
    const auto json = nlohmann::json::parse(content(scratch / "rows.json"));
    EXPECT_EQ(json.at("command_line"),
              (nlohmann::json{"regather", "replay", trace, "--order", "naive", "--csv", csv}));
    EXPECT_EQ(json.at("trace_checksum"), trace::TraceReader(trace).checksum());
    EXPECT_FALSE(json.at("git_revision").get<std::string>().empty());
    EXPECT_THAT(expect_done({"info", trace}).out, HasSubstr(json.at("trace_checksum").get<std::string>()));
}

TEST(Replay, FilesAreOverwrittenOnlyByForce) {
    const Scratch scratch;
    const std::vector<std::string> words{"replay", box_trace(), "--order",
                                         "naive",  "--csv",     (scratch / "rows.csv").string()};
    write(scratch / "rows.csv", "precious");
    expect_refused(bad_usage, words, {"rows.csv", "--force"});
    EXPECT_EQ(contents(scratch.path()), (std::map<std::string, std::string>{{"rows.csv", "precious"}}));
    expect_done(words + std::vector<std::string>{"--force"});
    EXPECT_THAT(content(scratch / "rows.csv"), StartsWith("scene,frame,"));

    fs::remove(scratch / "rows.csv");
    write(scratch / "rows.json", "an experiment of the same name");
    expect_refused(bad_usage, words, {"rows.json", "--force"});
    EXPECT_EQ(contents(scratch.path()),
              (std::map<std::string, std::string>{{"rows.json", "an experiment of the same name"}}));
}

TEST(Replay, ACsvMayNotTakeTheProvenancesName) {
    const Scratch scratch;
    expect_refused(
        bad_usage,
        {"replay", box_trace(), "--order", "naive", "--csv", (scratch / "rows.json").string(), "--force"},
        {"rows.json", ".json"});
    EXPECT_TRUE(fs::is_empty(scratch.path()));
}

TEST(Replay, AUsersLibraryIsAnOrdering) {
    const std::string library = PLUGIN_DIRECTORY "/by_height.so", trace = box_trace();
    const std::string csv = expect_done({"replay", trace, "--reorderer", library, "--cache", "4K:128:8"}).out;
    EXPECT_EQ(results::from_csv(csv, "stdout").at(0).ordering, "by-height");
    expect_refused(bad_usage, {"replay", trace, "--reorderer", library + ":fast"}, {"by_height.so", "fast"});
}

/// A key for each query of the small capture that turns its order round.
std::vector<std::int32_t> turned_round() {
    const trace::TraceReader trace(captured_box() / "trace");
    std::vector<std::int32_t> keys(trace.info().queries);
    for (std::size_t q = 0; q < keys.size(); ++q) keys[q] = -static_cast<std::int32_t>(q);
    return keys;
}

TEST(Replay, AFileMadeInNumPyIsAnOrderingWhereverOneIsTaken) {
    const Scratch scratch;
    const std::string trace = box_trace(), keys = (scratch / "keys.npy").string(),
                      order = (scratch / "order.npy").string();
    std::vector<std::int32_t> values = turned_round();
    const auto all = static_cast<std::int32_t>(values.size());
    write_column<std::int32_t>(keys, values);
    for (std::int32_t& value : values) value += all - 1;  // as a permutation: the last query first
    write_column<std::int32_t>(order, values);
    const std::vector<std::string> orders{"--order", "file:" + keys, "file:" + order + ",as=permutation"};
    const auto rows =
        results::from_csv(expect_done(std::vector<std::string>{"replay", trace, "--cache", "4K:128:8"} +
                                      orders + std::vector<std::string>{"naive"})
                              .out,
                          "stdout");
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].ordering, "file:keys.npy");
    EXPECT_THAT(rows[0].parameters, StartsWith("file:keys.npy,as=keys,xxh3="));
    EXPECT_THAT(rows[1].parameters, StartsWith("file:order.npy,as=permutation,xxh3="));
    EXPECT_EQ(rows[0].misses, rows[1].misses);
    EXPECT_NE(rows[0].misses, rows[2].misses);
    expect_done(std::vector<std::string>{"detail", trace} + orders);
    expect_done(std::vector<std::string>{"heatmap", trace, "-o", (scratch / "map").string()} + orders);
    expect_done(std::vector<std::string>{"race", trace, "--repeats", "1"} + orders);
    expect_done(
        std::vector<std::string>{"sampling", trace, "--rates", "2", "--seeds", "1", "--cache", "4K:128:1"} +
        orders);
    expect_refused(bad_usage, std::vector<std::string>{"race", trace, "--queries", "10"} + orders,
                   {"--queries: found 10", "a file orders them"});
    expect_refused(
        bad_usage,
        small_capture(scratch / "box") + std::vector<std::string>{"--gather-order", "file:" + keys},
        {"gather_order", "keys.npy"});
}

TEST(Replay, AFileThatIsNoOrderOfTheTraceIsRefused) {
    const Scratch scratch;
    const std::string trace = box_trace(), keys = (scratch / "keys.npy").string();
    const auto refused = [&](const std::string& suffix, const std::vector<std::string>& parts) {
        expect_refused(bad_data, {"replay", trace, "--order", "file:" + keys + suffix}, parts);
    };
    refused("", {"keys.npy", "No such file"});
    write_column<float>(keys, std::vector<float>{1, 2});
    refused("", {"keys.npy", "'<f4'", "whole numbers"});
    std::vector<std::int32_t> values = turned_round();
    values.pop_back();
    write_column<std::int32_t>(keys, values);
    refused("", {"keys.npy", "one for each query"});
    refused(",as=permutation", {"keys.npy", "row 1: found -1"});
}

TEST(Replay, ATraceWithoutStrataSaysWhatToDo) {
    const Scratch scratch;
    const fs::path trace = copied_trace(scratch);
    nlohmann::json info = nlohmann::json::parse(content(trace / "trace.json"));
    info["columns"].erase("query_stratum");
    write(trace / "trace.json", info.dump());
    fs::remove(trace / "query_stratum.npy");
    expect_done({"replay", trace.string(), "--order", "strata:frame=world"});
    expect_refused(bad_data, {"replay", trace.string(), "--order", "strata"},
                   {"query_stratum.npy", "capture the scene again"});
}

TEST(Replay, AColumnThatWasLeftOutIsNamedWithItsReason) {
    const Scratch scratch;
    write_column<trace::Vec3>(scratch / "photon_position.npy", std::vector<trace::Vec3>{{0, 0, 0}});
    write_column<trace::Vec3>(scratch / "query_position.npy", std::vector<trace::Vec3>{{0, 0, 0}});
    expect_done({"walk", scratch.path().string(), "-o", (scratch / "trace").string()});
    for (const auto& [ordering, column] : {std::pair{"direction-binned", "query_direction"},
                                           {"kd-leaf", "query_leaf_kd"},
                                           {"bvh-leaf", "query_leaf_bvh"},
                                           {"strata", "query_stratum"}})
        expect_refused(bad_data, {"replay", (scratch / "trace").string(), "--order", ordering},
                       {std::string(column) + ".npy", "not among the columns given"});
}

TEST(Replay, ClassesAddUpToTheMisses) {
    const std::vector<std::string> words{"replay", box_trace(), "--order",           "naive",
                                         "random", "--cache",   "1K,2K:64:1,2,full", "4K:128:32"};
    const auto with =
        results::from_csv(expect_done(words + std::vector<std::string>{"--classes"}).out, "stdout");
    const auto without = results::from_csv(expect_done(words).out, "stdout");
    ASSERT_EQ(with.size(), 14u);
    ASSERT_EQ(without.size(), 14u);
    for (std::size_t r = 0; r < with.size(); ++r) {
        const results::Row& row = with[r];
        EXPECT_EQ(*row.compulsory + *row.capacity + *row.conflict, row.misses);
        EXPECT_EQ(*row.compulsory * *row.line_bytes, row.compulsory_bytes);
        if (row.ways == 0u) {
            EXPECT_EQ(row.conflict, 0u);
        }
        EXPECT_FALSE(row.set_sampling || row.sampled_sets || row.misses_stderr || row.misses_low ||
                     row.misses_high);
        EXPECT_EQ(without[r].misses, row.misses);
        EXPECT_FALSE(without[r].compulsory || without[r].capacity || without[r].conflict);
    }
    // Lists are multiplied out, sizes outermost, ways innermost.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> caches;
    for (std::size_t r = 0; r < 7; ++r) caches.emplace_back(*with[r].cache_bytes, *with[r].ways);
    EXPECT_THAT(caches,
                testing::ElementsAre(testing::Pair(1024, 1), testing::Pair(1024, 2), testing::Pair(1024, 0),
                                     testing::Pair(2048, 1), testing::Pair(2048, 2), testing::Pair(2048, 0),
                                     testing::Pair(4096, 32)));
}

TEST(Replay, ASampleSaysHowFarOffItMayBe) {
    const std::vector<std::string> words{"replay",  box_trace(), "--order",   "naive",
                                         "hilbert", "--cache",   "2K:64:1,2", "4K:128:2"};
    const auto sampled = [&](const std::string& rate, const std::string& seed) {
        return results::from_csv(
            expect_done(words + std::vector<std::string>{"--sample", rate, "--seed", seed}).out, "stdout");
    };
    const auto exact = results::from_csv(expect_done(words).out, "stdout"), some = sampled("4", "1");
    ASSERT_EQ(some.size(), 6u);
    for (std::size_t r = 0; r < some.size(); ++r) {
        const results::Row& row = some[r];
        EXPECT_EQ(row.set_sampling, 4u);
        EXPECT_EQ(row.sampled_sets, *row.cache_bytes / *row.line_bytes / *row.ways / 4);
        ASSERT_TRUE(row.misses_stderr);
        EXPECT_GT(*row.misses_stderr, 0);
        EXPECT_LE(row.misses_low, row.misses);
        EXPECT_LE(row.misses, row.misses_high);
        EXPECT_EQ(row.traffic_bytes, *row.misses * *row.line_bytes);
        EXPECT_EQ(row.accesses, exact[r].accesses);
        EXPECT_FALSE(row.compulsory || row.capacity || row.conflict);
    }
    const auto misses = [](const std::vector<results::Row>& rows) {
        std::vector<std::uint64_t> all;
        for (const results::Row& row : rows) all.push_back(*row.misses);
        return all;
    };
    EXPECT_EQ(misses(sampled("4", "1")), misses(some));
    EXPECT_NE(misses(sampled("4", "2")), misses(some));
    EXPECT_EQ(misses(sampled("1", "2")), misses(exact));  // one of one is all
}

TEST(Replay, WhatCannotBeSampledIsAUsageError) {
    const std::vector<std::string> words{"replay", box_trace(), "--order", "naive", "--cache"};
    const auto refused = [&](const std::vector<std::string>& more, const std::vector<std::string>& parts) {
        expect_refused(bad_usage, words + more, parts);
    };
    refused({"2K:64:1", "--classes", "--sample", "4"}, {"--classes", "--sample"});
    refused({"2K:64:1", "--sample", "3"}, {"1/3"});
    refused({"2K:64:1", "--sample", "0"}, {"--sample", "'0'", "from 1 to 1024"});
    refused({"2K:64:1", "--sample", "-4"}, {"--sample"});
    refused({"2K:64:1", "--sample", "32"}, {"at least 64 sets"});
    refused({"2K:64:1,full", "--sample", "4"}, {"all"});
    refused({"1K,2K:64", "--sample", "4"}, {"SIZE:LINE:WAYS"});
    refused({"2K:64:1,"}, {"2K:64:1,", "ways", "''"});
    refused({"2K:64:1", "1K,2K:64:1"}, {"2048:64:1 twice"});
    expect_refused(bad_usage, {"replay", "x", "--order", "naive", "hilbert", "hilbert:bits=21"},
                   {"hilbert", "twice"});
}

struct Damage {
    const char* name;
    void (*apply)(const fs::path& column, std::string whole);
};
constexpr Damage damages[] = {
    {"a byte missing at the end",
     [](const fs::path& column, std::string whole) { write(column, whole.substr(0, whole.size() - 1)); }},
    {"a bit flipped in the last row",
     [](const fs::path& column, std::string whole) {
         whole.back() = static_cast<char>(whole.back() ^ 1);
         write(column, whole);
     }},
    {"a byte too many", [](const fs::path& column, std::string whole) { write(column, whole + '\0'); }},
    {"deleted", [](const fs::path& column, std::string) { fs::remove(column); }},
    {"another column under its name",
     [](const fs::path& column, std::string) {
         write_column<std::uint64_t>(column, std::vector<std::uint64_t>{1, 2, 3});
     }},
};

/// The columns of a captured trace that have rows, and so a last one to damage.
std::vector<std::string> damageable(const fs::path& folder) {
    std::vector<std::string> names;
    const trace::TraceReader reader(folder);
    for (const auto& [name, digest] : reader.digests())
        if (digest.rows > 0) names.push_back(name);
    return names;
}

TEST(Damaged, EveryColumnIsRefusedByNameWhateverWasDoneToIt) {
    const Scratch scratch;
    const fs::path trace = copied_trace(scratch);
    const std::vector<std::string> names = damageable(trace);
    ASSERT_GE(names.size(), 17u);
    for (const std::string& name : names)
        for (const Damage& damage : damages) {
            const fs::path column = trace / (name + ".npy");
            const std::string whole = content(column);
            damage.apply(column, whole);
            try {
                trace::TraceReader(trace).verify_all();
                ADD_FAILURE() << name << ": " << damage.name;
            } catch (const trace::DataError& error) {
                EXPECT_THAT(error.what(), HasSubstr(column.string())) << damage.name;
            }
            write(column, whole);
        }
    EXPECT_NO_THROW(trace::TraceReader(trace).verify_all());
}

TEST(Damaged, TheBinaryRefusesEveryColumnAndWritesNothing) {
    const Scratch scratch;
    const fs::path trace = copied_trace(scratch), csv = scratch / "rows.csv";
    std::size_t turn = 0;
    for (const std::string& name : damageable(trace)) {
        const fs::path column = trace / (name + ".npy");
        const std::string whole = content(column);
        damages[turn++ % std::size(damages)].apply(column, whole);
        // Weights, photons and rays are no business of a replay.
        const bool replayed = name == "walk" || (name.starts_with("query_") && name != "query_weight");
        if (replayed)
            expect_refused(bad_data,
                           std::vector<std::string>{"replay", trace.string()} + every_ordering() +
                               std::vector<std::string>{"--csv", csv.string()},
                           {name + ".npy"});
        else
            expect_refused(bad_data, {"info", trace.string(), "--verify"}, {name + ".npy"});
        EXPECT_FALSE(fs::exists(csv));
        EXPECT_FALSE(fs::exists(scratch / "rows.json"));
        write(column, whole);
    }
    expect_done({"info", trace.string(), "--verify"});
}

TEST(Damaged, TraceJsonIsRefusedByFieldAndFileName) {
    const Scratch scratch;
    const fs::path trace = copied_trace(scratch), json = trace / "trace.json", csv = scratch / "rows.csv";
    const std::string whole = content(json);
    const auto refused = [&](const std::vector<std::string>& parts) {
        expect_refused(bad_data,
                       {"replay", trace.string(), "--order", "naive", "tiled", "--csv", csv.string()}, parts);
        EXPECT_FALSE(fs::exists(csv));
    };
    fs::remove(json);
    refused({"trace.json", "finished trace"});
    for (const std::string& garbage :
         {std::string(), std::string("\x01{\n\xff"), whole.substr(0, whole.size() / 2)}) {
        write(json, garbage);
        refused({"trace.json: line ", ", column ", "expected"});
    }
    write(json, "[]");
    refused({"trace.json", "an empty list", "expected an object"});

    const auto with = [&](const char* pointer, const nlohmann::json& value) {
        auto root = nlohmann::json::parse(whole);
        root[nlohmann::json::json_pointer(pointer)] = value;
        write(json, root.dump());
    };
    with("/regather_trace", 99);
    refused({"trace.json", "version 99", "expected 2"});
    with("/queries", 5);
    refused({"trace.json", "queries", "found 5"});
    with("/photons", "many");
    refused({"trace.json", "photons", "\"many\""});
    with("/columns/walk/rows", 5);
    refused({"walk.npy", "expected 5 as in trace.json"});
    with("/columns/walk/xxh3_64", "0");
    refused({"trace.json", "16 hexadecimal digits"});
    with("/image_width", 0);
    refused({"trace.json", "image_width", "found 0"});
    with("/structure", "bvh4");
    refused({"trace.json", "structure: unknown \"bvh4\"", "left-balanced-kd"});
    with("/structure_version", 2);
    refused({"trace.json", "structure_version: found 2, expected 1", "walk the trace again"});
    with("/structure", "median-kd:leaf=8");
    refused({"tree_child.npy", "found no such column"});
}

TEST(Replay, AMachineOfOneLevelMovesWhatThatCacheMoves) {
    const Scratch scratch;
    const std::string trace = box_trace();
    const std::vector<std::string> asked{"replay",          trace,      "--order", "naive",
                                         "hilbert:tile=16", "--layout", "heap-32", "heap-20"};
    const auto through = [&](const char* option, const char* what) {
        std::vector<std::string> words = asked;
        words.insert(words.end(), {option, what});
        return expect_done(words).out;
    };
    const std::string rows = through("--machine", "paper-128k");
    EXPECT_THAT(rows, StartsWith("scene,structure,layout,ordering,parameters,machine,level,region,accesses"));
    const auto exact = results::from_csv(through("--cache", "128K:128:8"), "stdout");
    EXPECT_EQ(exact.size(), 4u);
    for (const results::Row& row : exact)
        EXPECT_THAT(rows, HasSubstr(fmt::format(
                              "box,left-balanced-kd,{},{},{},paper-128k,L1,photons,{},{},{},", row.layout,
                              row.ordering, row.ordering == "naive" ? "naive" : '"' + row.parameters + '"',
                              *row.accesses, *row.accesses - *row.misses, *row.misses)));
    expect_refused(bad_usage,
                   {"replay", trace, "--order", "naive", "--machine", "paper-128k", "--layout", "heap-20",
                    "heap-20:top=0"},
                   {"layout heap-20:top=0: found heap-20 twice"});
    expect_refused(bad_usage, {"replay", trace, "--order", "naive", "--machine", "nobody"}, {"nobody"});
}

TEST(Replay, BuffersThatFitTheChipAddNothingAndOthersAtLeastTheirBytes) {
    const std::string trace = box_trace();
    const auto rows = [&](const std::string& onchip) {
        return results::from_csv(expect_done({"replay", trace, "--order", "naive", "hilbert", "--cache",
                                              "1K:128:8", "--buffers", "--onchip", onchip})
                                     .out,
                                 "stdout");
    };
    for (const results::Row& row : rows("1G")) EXPECT_EQ(row.buffer_traffic_bytes, 0u);
    const auto small = rows("1K");
    EXPECT_EQ(small[0].buffer_traffic_bytes, 0u);  // naive holds nothing back
    EXPECT_GE(*small[1].buffer_traffic_bytes, *small[1].reorder_bytes);
    EXPECT_EQ(small[1].net_benefit_bytes,
              static_cast<std::int64_t>(*small[0].traffic_bytes) -
                  static_cast<std::int64_t>(*small[1].traffic_bytes + *small[1].buffer_traffic_bytes));
}

}  // namespace
}  // namespace regather::cli
