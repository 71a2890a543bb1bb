// `regather race`: every ordering runs on every structure and finds the same; what is written; what is
// refused. Times are only checked for being times.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "results/csv.h"
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::StartsWith;

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
    return std::vector<std::string>{"race", box_trace(), "--repeats", "2"} + more;
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

// Without it the race would search elsewhere than the capture did.
TEST(Race, ATraceWithoutARadiusIsRefused) {
    const Scratch scratch;
    const auto with = [&](const std::string& name, const std::string& radius) {
        const fs::path trace = copied_trace(scratch, name);
        std::string text = content(trace / "trace.json");
        const std::string before = "\"radius\": null,";
        EXPECT_THAT(text, HasSubstr(before));
        write(trace / "trace.json", text.replace(text.find(before), before.size(), radius));
        return trace.string();
    };
    for (const auto& [name, radius, found] : std::vector<std::tuple<const char*, const char*, const char*>>{
             {"missing", "", "nothing"},
             {"negative", "\"radius\": -1,", "-1"},
             {"text", "\"radius\": \"abc\",", "\"abc\""}}) {
        const std::string trace = with(name, radius);
        const std::string message = fmt::format("trace.json: parameters.radius: found {}, expected", found);
        expect_refused(bad_data, {"race", trace, "--repeats", "1"}, {message});
        expect_refused(bad_data, {"info", trace, "--verify"}, {message});
    }
    const fs::path made = copied_trace(scratch, "made");
    nlohmann::json info = nlohmann::json::parse(content(made / "trace.json"));
    info["parameters"] = info["counts"] = nlohmann::json::object();
    write(made / "trace.json", info.dump());
    expect_refused(bad_data, {"race", made.string(), "--repeats", "1"}, {"parameters.radius: found nothing"});
}

}  // namespace
}  // namespace regather::cli
