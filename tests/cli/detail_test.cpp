// `regather detail`: rows by region and tree depth and by slice, which sum to what `regather replay` tells.
#include <nlohmann/json.hpp>

#include "reorder/catalogue.h"
#include "results/csv.h"
#include "results/detail_row.h"
#include "results/timeline_row.h"
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr, testing::Not, testing::StartsWith;
using Words = std::vector<std::string>;

TEST(Detail, RowsSumToThoseOfReplay) {
    const Scratch scratch;
    const std::string trace = box_trace(), csv = (scratch / "detail.csv").string(),
                      timeline = (scratch / "timeline.csv").string();
    const Words what{trace,     "--order",  "naive",     "hilbert", "hashed:buckets=16,capacity=4",
                     "--cache", "4K:128:8", "2K:64:full"};
    expect_done(
        Words{"detail"} + what +
        Words{"--no-buffers", "--onchip", "1K", "--csv", csv, "--timeline", timeline, "--slices", "9"});
    const auto replayed = results::from_csv(expect_done(Words{"replay"} + what).out, "stdout");
    const auto rows = results::read_csv<results::DetailRow>(csv);
    const auto slices = results::read_csv<results::TimelineRow>(timeline);
    ASSERT_EQ(replayed.size(), 6u);
    EXPECT_EQ(slices.size(), 6 * 9u);
    for (const results::Row& whole : replayed) {
        const auto is_part = [&](const auto& row) {
            return row.parameters == whole.parameters && row.cache_bytes == whole.cache_bytes;
        };
        std::uint64_t accesses = 0, misses = 0, traffic = 0, classes = 0, depths = 0;
        for (const results::DetailRow& row : rows) {
            if (!is_part(row)) continue;
            EXPECT_EQ(row.region, "photons");
            EXPECT_EQ(row.tree_depth, depths++);
            EXPECT_EQ(row.ways, whole.ways);
            EXPECT_LE(*row.used_bytes, *row.traffic_bytes);
            accesses += *row.accesses;
            misses += *row.misses;
            traffic += *row.traffic_bytes;
            classes += *row.compulsory + *row.capacity + *row.conflict;
        }
        EXPECT_EQ(depths, 11u);  // 2000 photons
        EXPECT_EQ(accesses, whole.accesses);
        EXPECT_EQ(misses, whole.misses);
        EXPECT_EQ(classes, whole.misses);
        EXPECT_EQ(traffic, whole.traffic_bytes);
        std::uint64_t queries = 0, missed = 0;
        for (const results::TimelineRow& slice : slices) {
            if (!is_part(slice)) continue;
            EXPECT_EQ(slice.first_query, queries);
            queries += *slice.queries;
            missed += *slice.misses;
        }
        EXPECT_EQ(queries, whole.queries);
        EXPECT_EQ(missed, whole.misses);
    }
}

TEST(Detail, AnotherLayoutIsToldApartByRegionAndSumsToWhatReplayTells) {
    const Scratch scratch;
    const std::string to = (scratch / "t").string(), csv = (scratch / "rows.csv").string();
    expect_done({"walk", box_trace(), "--structure", "midpoint-kd:leaf=7,found=1", "-o", to});
    const Words what{
        to, "--order", "hilbert", "--cache", "4K:128:8", "--layout", "van-emde-boas-12+6:node=10"};
    expect_done(Words{"detail"} + what + Words{"--csv", csv});
    const auto replayed = results::from_csv(expect_done(Words{"replay"} + what).out, "stdout");
    ASSERT_EQ(replayed.size(), 1u);
    std::map<std::string, std::uint64_t> traffic;
    std::uint64_t sum = 0;
    for (const results::DetailRow& row : results::read_csv<results::DetailRow>(csv)) {
        EXPECT_EQ(row.layout, "van-emde-boas-12+6:node=10");
        traffic[row.region] += *row.traffic_bytes;
        sum += *row.traffic_bytes;
    }
    EXPECT_EQ(sum, replayed[0].traffic_bytes);
    for (const char* region : {"nodes", "photons", "photon_power"}) EXPECT_GT(traffic[region], 0u) << region;
    EXPECT_EQ(traffic["reorder_buffer"], 0u);
}

TEST(Detail, BuffersThatDoNotFitTheChipAreARegion) {
    const Scratch scratch;
    const auto buffer_traffic = [&](const std::string& onchip) {
        const std::string csv = (scratch / "rows.csv").string();
        expect_done(
            {"detail", box_trace(), "--order", "hilbert", "--onchip", onchip, "--csv", csv, "--force"});
        const auto rows = results::read_csv<results::DetailRow>(csv);
        EXPECT_EQ(rows.size(), 12u);
        EXPECT_EQ(rows.back().region, "reorder_buffer");
        EXPECT_EQ(rows.back().tree_depth, std::nullopt);
        return *rows.back().traffic_bytes;
    };
    EXPECT_EQ(buffer_traffic("1M"), 0u);
    EXPECT_GT(buffer_traffic("1K"), 0u);
}

TEST(Detail, TheTableTellsTrafficAndALibrarysBuffersAreNotKnown) {
    const std::string trace = box_trace();
    const Outcome naive = expect_done({"detail", trace, "--order", "naive", "--cache", "4K:128:8"});
    for (const char* word :
         {"box |", "heap-20 |", "4096:128:8", "structure", "buffers", "overfetch", "3C", "\nnaive "})
        EXPECT_THAT(naive.out, HasSubstr(word));
    EXPECT_THAT(naive.out, Not(HasSubstr("library")));
}

TEST(Detail, ProvenanceLiesBesideBothFiles) {
    const Scratch scratch;
    const std::string trace = box_trace();
    expect_done({"detail", trace, "--order", "naive", "--csv", (scratch / "a.csv").string(), "--timeline",
                 (scratch / "b.csv").string()});
    for (const char* name : {"a.json", "b.json"}) {
        const auto json = nlohmann::json::parse(content(scratch / name));
        EXPECT_EQ(json.at("trace_checksum"), trace::TraceReader(trace).checksum());
        EXPECT_EQ(json.at("command_line").at(1), "detail");
    }
}

TEST(Detail, FilesAreOverwrittenOnlyByForceAndMayNotShareAName) {
    const Scratch scratch;
    const Words words{"detail", box_trace(), "--order", "naive"};
    const std::string csv = (scratch / "rows.csv").string(), other = (scratch / "rows.txt").string();
    write(csv, "precious");
    expect_refused(bad_usage, words + Words{"--csv", csv}, {"rows.csv", "--force"});
    expect_refused(bad_usage, words + Words{"--timeline", csv}, {"rows.csv", "--force"});
    expect_refused(bad_usage, words + Words{"--csv", csv, "--timeline", csv, "--force"},
                   {"--timeline", "rows.csv"});
    expect_refused(bad_usage, words + Words{"--csv", csv, "--timeline", other, "--force"},
                   {"--timeline", "rows.txt"});
    expect_refused(bad_usage, words + Words{"--timeline", (scratch / "t.json").string()},
                   {"--timeline", ".json"});
    EXPECT_EQ(contents(scratch.path()), (std::map<std::string, std::string>{{"rows.csv", "precious"}}));
    expect_done(words + Words{"--csv", csv, "--force"});
    EXPECT_THAT(content(csv), StartsWith("scene,ordering,"));
}

TEST(Detail, BadWordsAreRefused) {
    const Words words{"detail", box_trace(), "--order", "naive"};
    expect_refused(bad_usage, words + Words{"--slices", "0"}, {"--slices", "0"});
    expect_refused(bad_usage, words + Words{"--cache", "4K:100:8"}, {"line_bytes", "100"});
    expect_refused(bad_usage, {"detail", "x", "--order", "naiv"}, {"naive"});
    expect_refused(bad_data, {"detail", "no-such-trace", "--order", "naive"}, {"no-such-trace"});
}

}  // namespace
}  // namespace regather::cli
