// `regather race`: every ordering runs on every structure and finds the same; what is written; what is
// refused. Times are only checked for being times.
#include <nlohmann/json.hpp>
#include <sstream>

#include "experiment/race.h"
#include "results/csv.h"
#include "spatial/photon_kd.h"
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::StartsWith;

TEST(Timing, MedianSpreadAndDeviationAsDrawnByHand) {
    // sorted 1 2 4 7 16; from the median 4: 3 2 0 3 12, whose median is 3
    const experiment::Timing odd = experiment::timing_of({7, 1, 16, 2, 4});
    EXPECT_EQ(odd.median, 4);
    EXPECT_EQ(odd.min, 1);
    EXPECT_EQ(odd.max, 16);
    EXPECT_EQ(odd.mad, 3);
    // sorted 1 2 4 9: the middle two give 3; from it 2 1 1 6, whose middle two give 1.5
    const experiment::Timing even = experiment::timing_of({9, 1, 4, 2});
    EXPECT_EQ(even.median, 3);
    EXPECT_EQ(even.mad, 1.5);
    EXPECT_EQ(experiment::timing_of({5}).median, 5);
    EXPECT_EQ(experiment::timing_of({5}).mad, 0);
}

std::vector<std::vector<std::string>> cells(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string> row(1);
        bool quoted = false;
        for (const char c : line) {
            if (c == '"')
                quoted = !quoted;
            else if (c == ',' && !quoted)
                row.emplace_back();
            else
                row.back() += c;
        }
        rows.push_back(row);
    }
    return rows;
}

std::vector<std::string> small_race(const std::vector<std::string>& more) {
    return std::vector<std::string>{"race", (captured_box() / "trace").string(), "--repeats", "2"} + more;
}

TEST(Race, ARowForEveryOrderingOnEveryStructure) {
    const Scratch scratch;
    const std::string csv = (scratch / "race.csv").string();
    const std::string table =
        expect_done(small_race({"--order", "hilbert:tile=4", "naive", "direction-binned:bins=2,tile=4",
                                "kd-leaf", "--csv", csv}))
            .out;
    const auto rows = cells(content(csv));
    ASSERT_EQ(rows.size(), 1u + 4 * 2);
    EXPECT_THAT(rows[0], ElementsAre("scene", "structure", "ordering", "tile", "bins", "parameters",
                                     "queries", "photons", "k", "threads", "repeats", "order_seconds_median",
                                     "search_seconds_median", "search_seconds_min", "search_seconds_max",
                                     "search_seconds_mad", "net_gain_seconds", "radius", "gathered"));
    const std::string queries = std::to_string(trace::TraceReader(captured_box() / "trace").info().queries);
    const std::string orderings[] = {"hilbert", "naive", "direction-binned", "kd-leaf"};
    for (std::size_t r = 1; r < rows.size(); ++r) {
        ASSERT_EQ(rows[r].size(), rows[0].size());
        EXPECT_EQ(rows[r][0], "box");
        EXPECT_EQ(rows[r][1], r % 2 == 1 ? "left-balanced" : "bucketed");
        EXPECT_EQ(rows[r][2], orderings[(r - 1) / 2]);
        EXPECT_EQ(rows[r][6], queries);
        EXPECT_EQ(rows[r][7], "2000");
        EXPECT_EQ(rows[r][8], "20");
        const double min = std::stod(rows[r][13]), median = std::stod(rows[r][12]),
                     max = std::stod(rows[r][14]);
        EXPECT_LE(min, median);
        EXPECT_LE(median, max);
        EXPECT_GE(std::stod(rows[r][15]), 0);
    }
    EXPECT_EQ(rows[1][3], "4");
    EXPECT_EQ(rows[1][5], "hilbert:tile=4,bits=16");
    EXPECT_EQ(rows[5][4], "2");
    // Naive is the yardstick: it orders nothing and gains nothing.
    for (const std::size_t r : {3u, 4u}) {
        EXPECT_EQ(rows[r][11], "0.000000");
        EXPECT_EQ(rows[r][16], "0.000000");
    }
    EXPECT_THAT(table, StartsWith("box | " + queries +
                                  " queries | 2000 photons | k 20 | 1 thread | medians of 2 repeats\n"));
    EXPECT_THAT(table, HasSubstr("bucketed"));
    EXPECT_THAT(table, HasSubstr("\nhilbert:tile=4,bits=16 "));
    EXPECT_THAT(table, HasSubstr("rows: " + csv));
    const auto json = nlohmann::json::parse(content(scratch / "race.json"));
    EXPECT_EQ(json.at("trace_checksum"), trace::TraceReader(captured_box() / "trace").checksum());
}

TEST(Race, NaiveRunsWhetherAskedForOrNot) {
    const Scratch scratch;
    const std::string csv = (scratch / "race.csv").string();
    expect_done(small_race({"--order", "morton", "--structure", "bucketed", "--csv", csv}));
    const auto rows = cells(content(csv));
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[1][2], "naive");
    EXPECT_EQ(rows[2][2], "morton");
}

TEST(Race, APartOfTheQueriesAnotherKThreadsAndCopiedPositions) {
    const Scratch scratch;
    const std::string csv = (scratch / "race.csv").string();
    expect_done(small_race({"--order", "hilbert", "random", "--queries", "501", "--k", "5000", "--threads",
                            "3", "--gathered", "--structure", "bucketed,left-balanced", "--csv", csv}));
    const auto rows = cells(content(csv));
    ASSERT_EQ(rows.size(), 7u);
    for (std::size_t r = 1; r < rows.size(); ++r) {
        EXPECT_EQ(rows[r][6], "501");
        EXPECT_EQ(rows[r][8], "5000");
        EXPECT_EQ(rows[r][9], "3");
        EXPECT_EQ(rows[r][17], "");   // unlimited, as captured
        EXPECT_EQ(rows[r][18], "1");  // --gathered
        EXPECT_EQ(rows[r][1], r % 2 == 1 ? "bucketed" : "left-balanced");
    }
}

TEST(Race, FilesAreOverwrittenOnlyByForce) {
    const Scratch scratch;
    const std::string csv = (scratch / "race.csv").string();
    write(csv, "precious");
    const auto words = small_race({"--order", "naive", "--csv", csv});
    expect_refused(bad_usage, words, {"race.csv", "--force"});
    EXPECT_EQ(content(csv), "precious");
    expect_done(words + std::vector<std::string>{"--force"});
    EXPECT_THAT(content(csv), StartsWith("scene,structure,"));
}

TEST(Race, ImpossibleValuesAreRefused) {
    const Scratch scratch;
    expect_refused(bad_usage, small_race({"--order", "hilbrt"}), {"hilbrt", "hilbert"});
    expect_refused(bad_usage, small_race({"--structure", "grid"}), {"--structure", "'grid'", "bucketed"});
    expect_refused(bad_usage, small_race({"--queries", "99999999"}), {"--queries", "99999999", "at most"});
    expect_refused(bad_usage, small_race({"--threads", "0"}), {"--threads", "0"});
    expect_refused(bad_usage, {"race", "x", "--repeats", "0"}, {"--repeats", "0"});
    expect_refused(bad_usage, small_race({"--k", "-1"}), {"--k", "-1"});
    expect_refused(bad_usage, small_race({"--csv", (scratch / "race.json").string()}),
                   {"race.json", ".json"});
    expect_refused(bad_data, {"race", (scratch / "none").string()}, {"none", "no such folder"});
    EXPECT_TRUE(fs::is_empty(scratch.path()));
}

TEST(Race, ADamagedTraceIsRefused) {
    const Scratch scratch;
    const fs::path trace = copied_trace(scratch);
    std::string bytes = content(trace / "photon.npy");
    bytes.back() = static_cast<char>(bytes.back() ^ 1);
    write(trace / "photon.npy", bytes);
    expect_refused(bad_data, {"race", trace.string()}, {"photon.npy"});
}

TEST(Race, ACausticTraceIsSearchedWithItsOwnRadius) {
    const Scratch scratch;
    const std::string folder = (scratch / "out").string();
    expect_done({"capture", "caustics", "-o", folder, "--width", "12", "--height", "8", "--gather-rays", "4",
                 "--photons", "2000", "--caustic-photons", "3000", "--radius", "5", "--caustic-radius",
                 "0.02"});
    // The searches must find as many photons as those of the capture did, or the race is refused.
    for (const char* trace : {"/trace", "/caustic-trace"})
        expect_done({"race", folder + trace, "--order", "naive", "--repeats", "1"});
}

TEST(Race, AWrongCountInTheTraceIsBadData) {
    const Scratch scratch;
    const fs::path trace = copied_trace(scratch);
    const std::uint64_t found = trace::TraceReader(trace).info().found_photons;
    std::string text = content(trace / "trace.json");
    const std::string before = "\"found_photons\": " + std::to_string(found);
    ASSERT_NE(text.find(before), std::string::npos);
    write(trace / "trace.json",
          text.replace(text.find(before), before.size(), "\"found_photons\": " + std::to_string(found - 1)));
    expect_refused(bad_data, {"race", trace.string(), "--order", "naive", "--repeats", "1"},
                   {"trace.json", "found_photons", std::to_string(found - 1), std::to_string(found)});
}

struct Line {
    std::vector<trace::Photon> heap;
    std::vector<trace::Vec3> position;
    std::vector<std::uint32_t> pixel;
    reorder::Workload work;
    std::vector<reorder::ParsedOrdering> orderings;

    Line() {
        std::vector<trace::Photon> photons(200);
        for (std::size_t i = 0; i < photons.size(); ++i) photons[i].position.x = static_cast<float>(i);
        heap = spatial::left_balanced(photons);
        for (std::uint32_t i = 0; i < 3000; ++i) {
            position.push_back({static_cast<float>(i % 200), 0, 0});
            pixel.push_back(i);
        }
        work.position = position;
        work.pixel = pixel;
        work.bounds = trace::bounds_of(position);
        work.image_width = 3000;
        for (const char* spec : {"random", "naive", "hilbert"})
            orderings.push_back(reorder::parse_ordering(spec));
    }
};

constexpr auto silent = [](std::uint64_t, std::uint64_t) {};

TEST(RaceOfSearches, CountsThePhotonsFoundAndReportsEveryQueryOnce) {
    Line line;
    // Of 200 photons on a line those within 1: three, but two at either end. 3000 queries are 15 on each
    // photon.
    experiment::RaceConfig config{.k = 10,
                                  .radius = 1,
                                  .repeats = 3,
                                  .threads = 2,
                                  .structures = {experiment::structures[0], experiment::structures[1]}};
    std::uint64_t last = 0, all = 0;
    const experiment::Race held = experiment::race(line.heap, line.work, line.orderings, 1, config,
                                                   [&](std::uint64_t done, std::uint64_t total) {
                                                       last = done;
                                                       all = total;
                                                   });
    EXPECT_EQ(held.found_photons, 15u * (198 * 3 + 2 * 2));
    EXPECT_EQ(held.standings.size(), 6u);
    EXPECT_EQ(last, all);
    EXPECT_EQ(all, 3000u * 3 * 2 * 3);
}

TEST(RaceOfSearches, SearchesThatDisagreeAreAFailedRun) {
    Line line;
    // Two photons swapped: the left-balanced search prunes by planes that are wrong now, the buckets are
    // built anew.
    std::swap(line.heap[1], line.heap[2]);
    const experiment::RaceConfig config{
        .k = 3, .repeats = 1, .structures = {experiment::structures[0], experiment::structures[1]}};
    try {
        experiment::race(line.heap, line.work, line.orderings, 1, config, silent);
        FAIL() << "expected an error";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("query"), HasSubstr("bucketed"),
                                                 HasSubstr("left-balanced"), HasSubstr("random")));
    }
}

}  // namespace
}  // namespace regather::cli
