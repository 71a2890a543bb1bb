// `regather run`: a whole experiment, taken up where it stopped.
#include "experiment/experiment.h"

#include <signal.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/version.h"
#include "experiment/kept.h"
#include "results/csv.h"
#include "tests/cli/expect.h"
#include "tests/cli/refused_experiment.h"
#include "tests/column.h"
#include "trace/error.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const char* const small_experiment = R"({
    "scene": "box",
    "capture": {"width": 16, "height": 16, "photons": 2000, "k": 20, "gather_rays": 8, "shadow_rays": 4},
    "caches": [{"size": ["2K", 4096], "line": 128, "ways": 8}],
    "orderings": ["naive", {"ordering": "hilbert", "tile": [4, 8]}, {"ordering": "direction-binned", "tile": 8, "bins": [2, 4]}]
})";
constexpr std::size_t trials = 5, rows = 10;

class Run : public testing::Test {
protected:
    Run() { write(file_, small_experiment); }
    std::vector<std::string> words() const { return {"run", file_.string(), "-o", folder_.string()}; }
    /// The rows of one trial each.
    std::vector<fs::path> parts() const {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder_ / "parts"))
            if (entry.path().filename().string().starts_with("rows-")) found.push_back(entry.path());
        std::sort(found.begin(), found.end());
        return found;
    }
    /// What the replays of all orders share.
    fs::path revisits() const {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder_ / "parts"))
            if (entry.path().filename().string().starts_with("revisits-")) found.push_back(entry.path());
        if (found.size() != 1) throw std::runtime_error("expected one file of revisits");
        return found.front();
    }
    /// As the command would refuse it.
    void refused(const std::string& text, const std::vector<std::string>& parts_of_message) const {
        expect_refused(file_, text, "experiment.json: ", parts_of_message);
    }
    /// The experiment with another text in place of one that occurs once.
    static std::string with(const std::string& before, const std::string& after) {
        std::string text = small_experiment;
        return text.replace(text.find(before), before.size(), after);
    }

    const Scratch scratch_;
    const fs::path file_ = scratch_ / "experiment.json", folder_ = scratch_ / "out";
};

TEST_F(Run, MakesImageRowsAndCharts) {
    const std::string out = expect_done(words()).out;
    for (const char* file : {"image.exr", "image.png", "rows.csv", "rows.json", "trace/trace.json",
                             "charts/traffic-by-tile.svg", "charts/traffic-by-tile.png"}) {
        ASSERT_TRUE(fs::exists(folder_ / file)) << file;
        EXPECT_GT(fs::file_size(folder_ / file), 0u) << file;
    }
    for (const char* file : {"image.png", "rows.csv", "charts/traffic-by-tile.svg"})
        EXPECT_THAT(out, HasSubstr((folder_ / file).string()));
    const std::vector<results::Row> all = results::read_csv(folder_ / "rows.csv");
    ASSERT_EQ(all.size(), rows);
    const std::vector<std::string> names{"naive", "hilbert", "hilbert", "direction-binned",
                                         "direction-binned"};
    for (std::size_t r = 0; r < rows; ++r) {
        EXPECT_EQ(all[r].ordering, names[r / 2]);
        EXPECT_EQ(all[r].cache_bytes, r % 2 == 0 ? 2048u : 4096u);
        EXPECT_EQ(all[r].raw_bytes, all[0].raw_bytes);
        EXPECT_GE(all[r].traffic_bytes, all[r].compulsory_bytes);
    }
    EXPECT_EQ(all[2].tile, 4u);
    EXPECT_EQ(all[4].tile, 8u);
    EXPECT_EQ(all[6].bins, 2u);
    EXPECT_EQ(all[8].bins, 4u);
}

TEST_F(Run, AgreesWithReplay) {
    expect_done(words());
    const auto of_run = results::read_csv(folder_ / "rows.csv");
    const std::string csv = expect_done({"replay", (folder_ / "trace").string(), "--order", "naive",
                                         "hilbert:tile=4", "--cache", "2K:128:8", "4K:128:8"})
                                .out;
    const auto of_replay = results::from_csv(csv, "stdout");
    ASSERT_EQ(of_replay.size(), 4u);
    for (std::size_t r = 0; r < of_replay.size(); ++r) {
        EXPECT_EQ(of_replay[r].parameters, of_run[r].parameters);
        EXPECT_EQ(of_replay[r].misses, of_run[r].misses);
        EXPECT_EQ(of_replay[r].compulsory_bytes, of_run[r].compulsory_bytes);
        EXPECT_EQ(of_replay[r].key_ops, of_run[r].key_ops);
    }
}

TEST_F(Run, FinishedPartsAreKeptAndAMissingOneIsDone) {
    expect_done(words());
    const std::string csv = content(folder_ / "rows.csv");
    std::map<fs::path, fs::file_time_type> written{
        {folder_ / "trace/trace.json", fs::last_write_time(folder_ / "trace/trace.json")}};
    for (const fs::path& part : parts()) written[part] = fs::last_write_time(part);
    ASSERT_EQ(written.size(), trials + 1);

    EXPECT_THAT(expect_done(words()).out, HasSubstr("kept the finished capture"));
    EXPECT_EQ(content(folder_ / "rows.csv"), csv);  // the measured seconds, too
    for (const auto& [path, time] : written) EXPECT_EQ(fs::last_write_time(path), time) << path;

    const fs::path lost = parts().front();
    fs::remove(lost);
    expect_done(words());
    ASSERT_TRUE(fs::exists(lost));
    for (const auto& [path, time] : written)
        EXPECT_EQ(fs::last_write_time(path) == time, path != lost) << path;
}

TEST_F(Run, AnotherTrialIsAddedToTheFinishedOnes) {
    expect_done(words());
    const std::string before = content(folder_ / "rows.csv");
    write(file_, with("\"naive\",", "\"naive\", \"morton\","));
    expect_done(words());
    EXPECT_EQ(results::read_csv(folder_ / "rows.csv").size(), rows + 2);
    write(file_, small_experiment);
    expect_done(words());
    EXPECT_EQ(content(folder_ / "rows.csv"), before);
}

TEST_F(Run, AnotherCaptureNeedsForce) {
    expect_done(words());
    const auto before = contents(folder_);
    write(file_, with("\"k\": 20", "\"k\": 21"));
    expect_refused(bad_usage, words(), {"other parameters", "--force"});
    EXPECT_EQ(contents(folder_), before);
    expect_done(words() + std::vector<std::string>{"--force"});
    EXPECT_NE(content(folder_ / "rows.csv"), before.at("rows.csv"));
}

/// The rows without the seconds that were measured.
std::vector<std::vector<std::uint64_t>> counts(const fs::path& csv) {
    std::vector<std::vector<std::uint64_t>> all;
    for (const results::Row& row : results::read_csv(csv))
        all.push_back({*row.cache_bytes, *row.queries, *row.accesses, *row.misses, *row.compulsory_bytes,
                       *row.key_ops});
    return all;
}

TEST_F(Run, ADamagedPartIsMadeAgain) {
    expect_done(words());
    const auto before = counts(folder_ / "rows.csv");
    const fs::path part = parts().front();
    const std::string whole = content(part);
    // A digit changed that leaves valid rows; kept_test.cpp has all other damage.
    std::string changed = whole;
    const std::size_t digit = whole.rfind(",0.") - 1;
    changed[digit] = changed[digit] == '1' ? '2' : '1';
    for (const std::string& damaged : {whole.substr(0, whole.size() - 20), changed}) {
        write(part, damaged);
        expect_done(words());
        EXPECT_EQ(counts(folder_ / "rows.csv"), before);
        EXPECT_NE(content(part), damaged);
    }
}

TEST_F(Run, APartOfAnotherRevisionOrLibraryIsMadeAgain) {
    // Of each kept file the second line says what it depends on.
    const std::string library = (scratch_ / "mine.so").string();
    fs::copy(PLUGIN_DIRECTORY "/by_height.so", library);
    write(file_, with("\"naive\"", "\"" + library + "\""));
    expect_done(words());
    const std::size_t before = parts().size();
    expect_done(words());
    EXPECT_EQ(parts().size(), before);
    write(library, content(library) + " ");  // another library, which does the same
    expect_done(words());
    EXPECT_EQ(parts().size(), before + 1);
    for (const fs::path& part : parts())
        EXPECT_THAT(content(part), HasSubstr("for rows " + git_revision() + " "));
}

TEST_F(Run, WhatNoOrderChangesIsKeptAndUsedAgain) {
    expect_done(words());
    const auto before = results::read_csv(folder_ / "rows.csv");
    // 1000 more misses of 8 ways in every level show in the trial that is replayed again, and in no other.
    const std::string text = content(revisits());
    const std::size_t key = text.find("\nfor ") + 5, bytes = text.find('\n', text.find("\nxxh3 ") + 1) + 1;
    nlohmann::json kept = nlohmann::json::parse(text.substr(bytes));
    for (nlohmann::json& level : kept.at(0).at("levels"))
        level.at("misses").at(7) = level.at("misses").at(7).get<std::uint64_t>() + 1000;
    experiment::write_kept(revisits(), text.substr(key, text.find('\n', key) - key), kept.dump());
    const std::string part = content(parts().front());
    const std::vector<results::Row> lost = results::from_csv(part.substr(part.find("scene,")), "part");
    fs::remove(parts().front());
    expect_done(words());
    const auto after = results::read_csv(folder_ / "rows.csv");
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t r = 0; r < rows; ++r)
        EXPECT_EQ(*after[r].misses,
                  *before[r].misses + (before[r].parameters == lost[0].parameters ? 1000 : 0));
}

TEST_F(Run, DamagedRevisitsAreCountedAgain) {
    expect_done(words());
    const auto before = counts(folder_ / "rows.csv");
    const fs::path path = revisits();
    const std::string whole = content(path);
    for (const std::string& damaged : {whole.substr(0, whole.size() / 2), std::string("[]")}) {
        fs::remove(parts().front());
        write(path, damaged);
        expect_done(words());
        EXPECT_EQ(counts(folder_ / "rows.csv"), before);
        EXPECT_EQ(content(path), whole);
    }
}

TEST_F(Run, ClassesAreAskedForByKey) {
    write(file_, with("\"caches\"", "\"classes\": true, \"caches\""));
    expect_done(words());
    const auto all = results::read_csv(folder_ / "rows.csv");
    ASSERT_EQ(all.size(), rows);
    for (const results::Row& row : all) {
        EXPECT_EQ(*row.compulsory + *row.capacity + *row.conflict, row.misses);
        EXPECT_FALSE(row.set_sampling);
    }
    // Another method is another part: rows without classes do not come from those with them.
    write(file_, small_experiment);
    expect_done(words());
    for (const results::Row& row : results::read_csv(folder_ / "rows.csv")) EXPECT_FALSE(row.compulsory);
}

TEST_F(Run, ASampleIsAskedForByKey) {
    const std::string sampled = with("\"ways\": 8", "\"ways\": 1");
    const auto asked = [&](const std::string& keys) {
        std::string text = sampled;
        write(file_, text.replace(text.find("\"caches\""), 8, keys + ", \"caches\""));
        expect_done(words());
        return results::read_csv(folder_ / "rows.csv");
    };
    const auto all = asked("\"sample\": 4, \"sample_seed\": 9");
    ASSERT_EQ(all.size(), rows);
    for (const results::Row& row : all) {
        EXPECT_EQ(row.set_sampling, 4u);
        EXPECT_EQ(row.sampled_sets, *row.cache_bytes / 128 / 4);
        EXPECT_LE(row.misses_low, row.misses);
        EXPECT_LE(row.misses, row.misses_high);
    }
    const auto of_replay =
        results::from_csv(expect_done({"replay", (folder_ / "trace").string(), "--order", "naive", "--cache",
                                       "2K,4K:128:1", "--sample", "4", "--seed", "9"})
                              .out,
                          "stdout");
    EXPECT_EQ(all[0].misses, of_replay[0].misses);
    EXPECT_EQ(all[1].misses, of_replay[1].misses);
    // Another seed is another part.
    const auto other = asked("\"sample\": 4, \"sample_seed\": 8");
    EXPECT_NE(std::pair(other[0].misses, other[1].misses), std::pair(all[0].misses, all[1].misses));
}

TEST_F(Run, BadMethodsAreRefusedWithTheirPlace) {
    const auto method = [](const std::string& keys) { return with("\"caches\"", keys + ", \"caches\""); };
    refused(method("\"classes\": 1"), {"classes", "found 1"});
    refused(method("\"classes\": \"yes\""), {"classes", "\"yes\""});
    refused(method("\"sample\": 3"), {"sample", "1/3"});
    refused(method("\"sample\": 0"), {"sample", "found 0"});
    refused(method("\"sample\": 2048"), {"sample", "found 2048"});
    refused(method("\"sample\": \"4\""), {"sample", "\"4\"", "whole number"});
    refused(method("\"sample\": 4"), {"sample", "at least 8 sets"});  // 2 KB of 8 ways are 2 sets
    refused(method("\"classes\": true, \"sample\": 4"), {"classes", "\"sample\""});
    refused(method("\"sample\": 2, \"sample_seed\": -1"), {"sample_seed", "-1"});
    refused(method("\"sample_sed\": 1"), {"sample_sed", "\"sample_seed\""});
    write(file_, method("\"sample\": 3"));
    expect_refused(bad_data, words(), {"experiment.json", "sample", "1/3"});
    EXPECT_FALSE(fs::exists(folder_));
}

using SlowRun = Run;

TEST_F(SlowRun, KilledAfterAnyFileItIsTakenUpAgain) {
    const auto files = [&](const char* where) {
        std::size_t found = 0;
        std::error_code gone;
        for (fs::directory_iterator entry(folder_ / where, gone), end; entry != end && !gone;
             entry.increment(gone))
            ++found;
        return found;
    };
    // One after the other in the same folder: the first column, the trace, what all share, a part, more
    // parts.
    for (const auto& [where, count] :
         {std::pair{"trace", 2}, {".", 3}, {"parts", 1}, {"parts", 2}, {"parts", 4}, {"parts", 6}}) {
        Process run(words());
        run.wait_until(
            [&, where = where, count = count] { return files(where) >= static_cast<std::size_t>(count); });
        run.send(SIGKILL);
        run.outcome();
    }
    EXPECT_EQ(Process(words()).outcome().exit_code, 0);
    EXPECT_EQ(results::read_csv(folder_ / "rows.csv").size(), rows);
    EXPECT_EQ(parts().size(), trials);
    EXPECT_NO_THROW(trace::TraceReader(folder_ / "trace").verify_all());
}

TEST_F(Run, ListsInOneTextAreMultipliedOutAsListsAre) {
    write(file_, with("[\"2K\", 4096]", "\"2K,4K\""));
    const experiment::Experiment loaded = experiment::load_experiment(file_);
    ASSERT_EQ(loaded.trials.front().caches.size(), 2u);
    EXPECT_EQ(loaded.trials.front().caches[0].size_bytes, 2048u);
    EXPECT_EQ(loaded.trials.front().caches[1].size_bytes, 4096u);
}

TEST_F(Run, TheSameRowTwiceIsRefused) {
    refused(with("4096", "\"2K\""), {"orderings", "naive through the cache 2048:128:8 twice"});
    refused(with("[4, 8]", "[4, 4]"), {"orderings", "hilbert:tile=4", "twice"});
    refused(with("\"naive\",", "\"naive\", {\"ordering\": \"naive\"},"), {"orderings", "naive", "twice"});
    // The same ordering through other caches is no repetition.
    write(file_, with("\"naive\",", R"("naive", {"ordering": "naive", "caches": [{"size": "1K"}]},)"));
    EXPECT_NO_THROW(experiment::load_experiment(file_));
}

TEST_F(Run, CachesThatNoOrderingUsesAreRefused) {
    const std::string all = with("\"naive\", ", ""), own = R"("caches": [{"size": "1K"}]})";
    const std::size_t from = all.find("\"orderings\"");
    ASSERT_NE(from, all.npos);
    refused(all.substr(0, from) + R"("orderings": [{"ordering": "naive", )" + own + "]}",
            {"caches: found beside caches of each ordering, expected one or the other"});
    // One ordering has none of its own.
    write(file_, all.substr(0, from) + R"("orderings": ["hilbert", {"ordering": "naive", )" + own + "]}");
    const experiment::Experiment loaded = experiment::load_experiment(file_);
    ASSERT_EQ(loaded.trials.size(), 2u);
    EXPECT_EQ(loaded.trials[0].caches.size(), 2u);
    EXPECT_EQ(loaded.trials[1].caches.size(), 1u);
}

TEST_F(Run, AFileOfKeysLiesBesideTheExperiment) {
    expect_done(words());
    std::vector<std::uint16_t> keys(trace::TraceReader(folder_ / "trace").info().queries, 7);
    const auto asked = [&] {
        write_column<std::uint16_t>(scratch_ / "keys.npy", keys);
        write(file_, with("\"naive\"", "\"naive\", \"file:keys.npy\""));
        expect_done(words());
        return results::read_csv(folder_ / "rows.csv");
    };
    const auto level = asked();
    ASSERT_EQ(level.size(), rows + 2);
    EXPECT_EQ(level[2].ordering, "file:keys.npy");
    EXPECT_EQ(level[2].misses, level[0].misses);  // equal keys: capture order
    // Other keys under the same name are another part.
    for (std::size_t q = 0; q < keys.size(); ++q) keys[q] = static_cast<std::uint16_t>(q * 40503);
    EXPECT_NE(asked()[2].misses, level[0].misses);
    write_column<float>(scratch_ / "keys.npy", std::vector<float>{1});
    expect_refused(bad_data, words(), {"keys.npy", "'<f4'"});
}

TEST_F(Run, StrataAreCapturedForTheOrderingThatReadsThem) {
    write(file_, with("\"naive\"", "\"naive\", \"strata:tile=4,strata=2\", \"strata+hashed:tile=4\""));
    expect_done(words());
    EXPECT_TRUE(trace::TraceReader(folder_ / "trace").has("query_stratum"));
    const auto all = results::read_csv(folder_ / "rows.csv");
    ASSERT_EQ(all.size(), rows + 4);
    EXPECT_EQ(all[2].ordering, "strata");
    EXPECT_EQ(all[2].bins, 2u);
    EXPECT_EQ(all[2].key_ops, 0u);
    EXPECT_EQ(all[2].buffered_bytes, 16 * 48u);
    EXPECT_LT(all[2].misses, all[0].misses);
    expect_done(words());  // kept
}

TEST_F(Run, AUsersLibraryIsGivenEveryColumnThatAnOrderingCouldRead) {
    write(file_, R"({"scene": "box", "capture": {"width": 4, "height": 4, "photons": 500, "gather_rays": 2},
        "orderings": [")" PLUGIN_DIRECTORY R"(/plugin_columns.so"]})");
    expect_done(words());
    for (const char* column : {"query_direction", "query_leaf_kd", "query_leaf_bvh"})
        EXPECT_TRUE(trace::TraceReader(folder_ / "trace").has(column)) << column;
    // Refuses when one of them is NULL. A trace of one's own need not have them.
    const std::string library = PLUGIN_DIRECTORY "/plugin_columns.so";
    expect_done({"replay", (folder_ / "trace").string(), "--order", library});
    expect_done({"race", (folder_ / "trace").string(), "--order", library, "--repeats", "1"});
}

TEST_F(Run, FramesAndPartsToKeepAreBadDataOfTheFile) {
    write(file_, with("\"k\": 20", "\"k\": 20, \"keep\": [\"caustic\"]"));
    expect_refused(bad_data, words(), {"experiment.json", "keep", "caustic"});
    write(file_, with("\"k\": 20", "\"k\": 20, \"frames\": \"0:5\""));
    expect_refused(bad_data, words(), {"experiment.json", "frames", "no camera path"});
    std::string text = with("\"k\": 20", "\"k\": 20, \"frames\": \"0:999\"");
    write(file_, text.replace(text.find("\"box\""), 5, "\"cornell\""));
    expect_refused(bad_data, words(), {"experiment.json", "frames", "0:999"});
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(Run, KeysThatLeaveEachOtherWithoutEffectAreRefused) {
    refused(with("\"caches\"", "\"sample_seed\": 3, \"caches\""), {"sample_seed", "without \"sample\""});
    refused(with("\"k\": 20", "\"k\": 20, \"mode\": \"direct\""), {"gather_rays", "\"direct\""});
    refused(with("\"k\": 20", "\"k\": 20, \"caustic_photons\": 0, \"caustic_k\": 5"),
            {"caustic_k", "\"caustic_photons\": 0"});
}

TEST_F(Run, AnUnlimitedRadiusMayBeWrittenInf) {
    write(file_, with("\"k\": 20", "\"k\": 20, \"radius\": \"inf\", \"caustic_radius\": \"inf\""));
    EXPECT_TRUE(std::isinf(experiment::load_experiment(file_).capture.radius));
    refused(with("\"k\": 20", "\"k\": 20, \"exposure\": \"inf\""), {"exposure", "not negative"});
    refused(with("\"k\": 20", "\"k\": 20, \"radius\": \"far\""), {"radius", "\"inf\""});
}

TEST_F(Run, AFolderOrAVeryLongNameIsNoExperiment) {
    expect_refused(bad_data, {"run", scratch_.path().string(), "-o", folder_.string()},
                   {scratch_.path().string()});
    expect_refused(bad_data, {"run", std::string(5000, 'x'), "-o", folder_.string()}, {"xxx"});
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(Run, ABadExperimentIsBadDataAndLeavesNothing) {
    write(file_, with("\"width\"", "\"widht\""));
    expect_refused(bad_data, words(), {"experiment.json", "capture.widht", "\"width\""});
    write(file_, with("\"naive\"", "\"naif\""));
    expect_refused(bad_data, words(), {"experiment.json", "\"naif\"", "naive"});
    write(file_, with("\"box\"", "\"bx\""));
    expect_refused(bad_data, words(), {"experiment.json", "\"bx\"", "\"box\""});
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(Run, AMisspeltKeyBringsTheNearest) {
    refused(with("\"caches\"", "\"cache\""), {"cache: found unknown key", "\"caches\""});
    refused(with("\"width\"", "\"widht\""), {"capture.widht", "\"width\""});
    refused(with("\"line\"", "\"lines\""), {"caches[0].lines", "\"line\""});
    refused(with("\"bins\"", "\"bin\""), {"orderings[2]", "\"bin\"", "nearest: bins"});
}

TEST_F(Run, BadValuesAreRefusedWithTheirPlace) {
    refused(with("\"naive\"", "\"naif\""), {"orderings[0]", "\"naif\"", "nearest: naive"});
    refused(with("[4, 8]", "[4, 0]"), {"orderings[1]", "tile", "0"});
    refused(with("[4, 8]", "[]"), {"orderings[1].tile", "at least one"});
    refused(with("4096", "5000"), {"caches[0]", "5000"});
    refused(with("\"k\": 20", "\"k\": 0"), {"capture.k", "found 0"});
    refused(with("\"k\": 20", "\"k\": 20, \"gather_order\": \"hilbrt\""), {"capture", "hilbrt", "hilbert"});
    refused(with("\"box\"", "\"bx\""), {"scene", "\"bx\"", "\"box\""});
    refused(with("\"caches\"", "\"onchip\": [\"1M\", \"2M\"], \"caches\""), {"onchip"});
}

TEST_F(Run, WrongTypesAreRefusedWithTheirPlace) {
    refused(with("\"k\": 20", "\"k\": \"20\""), {"capture.k", "\"20\"", "whole number"});
    refused(with("\"k\": 20", "\"k\": 2.5"), {"capture.k", "2.5", "whole number"});
    refused(with("\"k\": 20", "\"k\": -1"), {"capture.k", "-1", "whole number"});
    refused(with("\"box\"", "7"), {"scene", "found 7", "text"});
    refused(with("\"naive\"", "7"), {"orderings[0]", "found 7", "object"});
    refused(with("[4, 8]", "[4, true]"), {"orderings[1].tile", "true"});
    refused(R"({"scene": "box", "orderings": []})", {"orderings", "at least one"});
    refused(R"({"scene": "box"})", {"orderings", "found nothing"});
    refused("[]", {"found an empty list", "object"});
    refused("{\"scene\": ", {"line 1", "end of the file"});
    fs::remove(file_);
    expect_refused(bad_data, words(), {"experiment.json", "no such file"});
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(Run, ASceneIsFoundBesideTheExperiment) {
    write(scratch_ / "mine.json", "{}");
    write(file_, with("\"box\"", "\"mine.json\""));
    expect_refused(bad_data, words(), {(scratch_ / "mine.json").string(), "name"});
}

}  // namespace
}  // namespace regather::cli
