// `regather run` of an experiment over structures and layouts.
#include <signal.h>

#include "experiment/experiment.h"
#include "results/csv.h"
#include "tests/cli/expect.h"
#include "tests/cli/refused_experiment.h"
#include "trace/error.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr;

const char* const experiment = R"({
    "scene": "box",
    "capture": {"width": 16, "height": 16, "photons": 2000, "k": 20, "gather_rays": 8, "shadow_rays": 4},
    "caches": [{"size": ["2K", "4K"], "line": 128, "ways": 4}],
    "classes": true,
    "buffers": true,
    "layouts": ["heap-20", "van-emde-boas-32"],
    "structures": [
        "left-balanced-kd",
        {"structure": "octree", "leaf": [2, 8], "found": 1, "layouts": ["depth-first-20", "van-emde-boas-12+6:node=16"]}
    ],
    "orderings": ["naive", {"ordering": "hilbert", "tile": [4, 8]}, "direction-binned:tile=8,bins=4"]
})";

/// All columns but the seconds, a row a text.
std::vector<std::string> told(std::vector<results::Row> rows) {
    std::vector<std::string> all;
    for (results::Row& row : rows) {
        row.order_seconds = row.replay_seconds = {};
        all.push_back(results::to_csv(std::span<const results::Row>(&row, 1)));
    }
    return all;
}

class RunStructures : public testing::Test {
protected:
    RunStructures() { write(file_, experiment); }
    std::vector<std::string> words() const { return {"run", file_.string(), "-o", folder_.string()}; }
    std::vector<std::string> told_rows() const { return told(results::read_csv(folder_ / "rows.csv")); }
    /// The folders of other structures than the captured one.
    std::vector<std::string> walks() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_ / "walks"))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
    /// As the command would refuse it.
    void refused(const std::string& before, const std::string& after,
                 const std::vector<std::string>& parts) const {
        std::string text = experiment;
        const auto at = text.find(before);
        ASSERT_NE(at, text.npos) << before;
        expect_refused(file_, text.replace(at, before.size(), after), "experiment.json: line ", parts);
    }

    const Scratch scratch_;
    const fs::path file_ = scratch_ / "experiment.json", folder_ = scratch_ / "out";
};

TEST_F(RunStructures, RowsAreThoseOfWalkAndReplay) {
    expect_done(words());
    EXPECT_THAT(walks(), ElementsAre("octree-leaf-2-found-1", "octree-leaf-8-found-1"));
    std::vector<results::Row> separate;
    const auto replay = [&](const fs::path& trace, const std::vector<std::string>& layouts) {
        const auto rows =
            results::from_csv(expect_done(std::vector<std::string>{
                                              "replay", trace.string(), "--order", "naive", "hilbert:tile=4",
                                              "hilbert:tile=8", "direction-binned:tile=8,bins=4", "--cache",
                                              "2K,4K:128:4", "--classes", "--buffers", "--layout"} +
                                          layouts)
                                  .out,
                              "stdout");
        separate.insert(separate.end(), rows.begin(), rows.end());
    };
    replay(folder_ / "trace", {"heap-20", "van-emde-boas-32"});
    for (const std::string leaf : {"2", "8"}) {
        expect_done({"walk", (folder_ / "trace").string(), "--structure", "octree:found=1,leaf=" + leaf, "-o",
                     (scratch_ / leaf).string()});
        replay(scratch_ / leaf, {"depth-first-20", "van-emde-boas-12+6:node=16"});
    }
    ASSERT_EQ(separate.size(), 3u * 2 * 4 * 2);
    EXPECT_EQ(told_rows(), told(separate));
    EXPECT_EQ(separate.back().structure, "octree:leaf=8,found=1");
    EXPECT_EQ(separate.back().layout, "van-emde-boas-12+6:node=16");
}

TEST_F(RunStructures, ChartsAndProvenanceAreOfAllOfThem) {
    const std::string out = expect_done(words()).out;
    EXPECT_THAT(out, HasSubstr((folder_ / "charts/traffic-by-layout.svg").string()));
    EXPECT_THAT(content(folder_ / "charts/traffic-by-layout.svg"),
                testing::AllOf(HasSubstr("octree:leaf=2,found=1, depth-first-20"),
                               HasSubstr("left-balanced-kd, van-emde-boas-32")));
    for (const fs::path& trace : {folder_ / "trace", folder_ / "walks/octree-leaf-2-found-1",
                                  folder_ / "walks/octree-leaf-8-found-1"})
        EXPECT_THAT(content(folder_ / "rows.json"), HasSubstr(trace::TraceReader(trace).checksum()));
}

TEST_F(RunStructures, WithoutStructuresTheCapturedOneIsReplayedInEachLayout) {
    std::string text = experiment;
    const auto from = text.find("\"structures\""), to = text.find("\"orderings\"");
    write(file_, text.erase(from, to - from));
    expect_done(words());
    EXPECT_FALSE(fs::exists(folder_ / "walks"));
    const auto rows = results::read_csv(folder_ / "rows.csv");
    ASSERT_EQ(rows.size(), 2u * 4 * 2);
    EXPECT_EQ(rows[7].layout, "heap-20");
    EXPECT_EQ(rows[8].layout, "van-emde-boas-32");
    EXPECT_EQ(rows[8].structure, "left-balanced-kd");
}

TEST_F(RunStructures, FinishedWalksAreKeptAndDeadOnesMadeAgain) {
    expect_done(words());
    const std::string csv = content(folder_ / "rows.csv");
    const fs::path small = folder_ / "walks/octree-leaf-2-found-1",
                   large = folder_ / "walks/octree-leaf-8-found-1";
    const auto time = [](const fs::path& trace) { return fs::last_write_time(trace / "trace.json"); };
    const auto large_time = time(large);
    expect_done(words());
    EXPECT_EQ(content(folder_ / "rows.csv"), csv);  // the measured seconds, too
    EXPECT_EQ(time(large), large_time);

    const std::string json = content(small / "trace.json"), walk = content(small / "walk.npy");
    const auto made_again = [&] {
        expect_done(words());
        EXPECT_EQ(content(small / "trace.json"), json);
        EXPECT_EQ(content(small / "walk.npy"), walk);
        EXPECT_EQ(content(folder_ / "rows.csv"), csv);
        EXPECT_EQ(time(large), large_time);
    };
    fs::remove(small / "trace.json");  // unfinished
    made_again();
    std::string damaged = walk;
    damaged.back() = static_cast<char>(damaged.back() ^ 1);
    write(small / "walk.npy", damaged);
    made_again();
    write(small / "walk.npy", walk.substr(0, walk.size() / 2));
    made_again();
    fs::remove_all(small);  // another structure's under this name
    fs::copy(large, small, fs::copy_options::recursive);
    made_again();
}

TEST_F(RunStructures, WalksOfAnotherCaptureAreMadeAgain) {
    expect_done(words());
    const auto before = told_rows();
    std::string text = experiment;
    write(file_, text.replace(text.find("\"k\": 20"), 7, "\"k\": 21"));
    expect_done(words() + std::vector<std::string>{"--force"});
    EXPECT_EQ(trace::TraceReader(folder_ / "walks/octree-leaf-2-found-1").info().k, 21u);
    for (const std::string& row : told_rows()) EXPECT_THAT(before, testing::Not(testing::Contains(row)));
}

TEST_F(RunStructures, EachFrameIsWalked) {
    write(file_, R"({"scene": "cornell",
        "capture": {"width": 8, "height": 8, "photons": 500, "k": 9, "gather_rays": 2, "shadow_rays": 1, "frames": "3,1"},
        "structures": ["bvh:leaf=4", "left-balanced-kd"], "layouts": ["breadth-first-16"], "orderings": ["naive"]})");
    expect_done(words());
    const auto rows = results::read_csv(folder_ / "rows.csv");
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[1].frame, 3u);
    EXPECT_EQ(rows[2].frame, 1u);
    EXPECT_EQ(rows[2].structure, "bvh:leaf=4");
    EXPECT_EQ(rows[2].layout, "breadth-first-16:node=64");
    EXPECT_EQ(rows[3].layout, "breadth-first-16");
    EXPECT_TRUE(fs::exists(folder_ / "frame-0003/walks/bvh-leaf-4/trace.json"));
}

TEST_F(RunStructures, WhatDoesNotFitTogetherIsRefusedBeforeTheCapture) {
    refused("\"octree\"", "\"octre\"", {"structures[1]: structure: unknown \"octre\"", "nearest: octree"});
    refused("\"leaf\": [2, 8]", "\"leave\": 2", {"structures[1]", "\"leave\"", "nearest: leaf"});
    refused("\"leaf\": [2, 8]", "\"leaf\": [2, 65]", {"structures[1]", "leaf", "65"});
    refused("\"leaf\": [2, 8]", "\"leaf\": [2, 2]", {"structures[1]", "octree:leaf=2,found=1 a second time"});
    refused("\"left-balanced-kd\",", "\"visits\",", {"structures[0]", "visits"});
    refused("\"left-balanced-kd\",", "7,", {"structures[0]", "found 7", "the name of a structure"});
    refused("\"heap-20\"", "\"heap-21\"", {"layouts[0]", "record \"21\"", "nearest: 20"});
    refused("\"heap-20\"", "\"heep-20\"", {"layouts[0]", "order \"heep\"", "nearest: heap"});
    refused("\"heap-20\"", "\"heap-12+6\"", {"layouts[0]", "12+6", "found=1"});
    refused("\"heap-20\"", "\"heap-20:top=41\"", {"layouts[0]", "top", "41"});
    refused("\"heap-20\"", "\"heap-20:line=64\"", {"layouts[0]", "line: found 64", "only clusters"});
    refused("\"heap-20\"", "\"heap-20:node=8\"",
            {"layouts[0]", "node: found 8", "the inner nodes of left-balanced-kd are photons"});
    refused("\"heap-20\"", "\"van-emde-boas-32\"", {"layouts[1]", "van-emde-boas-32 a second time"});
    refused("\"heap-20\"", "20", {"layouts[0]", "found 20", "the name of a layout"});
    refused("[\"heap-20\", \"van-emde-boas-32\"]", "[]", {"layouts", "at least one"});
    refused("\"found\": 1, ", "", {"structures[1].layouts[1]", "12+6", "found=1"});
    refused("{\"structure\": \"octree\"", "{\"structur\": \"octree\"", {"structures[1]", "structure"});
    // The layouts of the experiment would be without effect.
    refused("\"left-balanced-kd\",", R"({"structure": "left-balanced-kd", "layouts": ["heap-20"]},)",
            {"layouts: found beside layouts of each structure"});
    expect_refused(bad_data, words(), {"experiment.json", "layouts"});
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(RunStructures, TheExperimentOfStructuresAsksForAPlaceARow) {
    const char* const folder = std::getenv("REGATHER_SOURCE_DIR");
    const experiment::Experiment loaded = experiment::load_experiment(
        fs::path(folder == nullptr ? "." : folder) / "scenes/experiments/structures.json");
    ASSERT_EQ(loaded.searched.size(), 9u);
    std::size_t places = 0;
    for (const experiment::Searched& searched : loaded.searched) places += searched.layouts.size();
    EXPECT_EQ(places, 21u);
    EXPECT_EQ(loaded.searched[2].structure, "midpoint-kd:leaf=8,bounds=1,found=1");
    EXPECT_THAT(loaded.searched[2].layouts,
                ElementsAre("depth-first-20:node=8", "van-emde-boas-12+6:node=8"));
}

using SlowRunStructures = RunStructures;

TEST_F(SlowRunStructures, KilledAfterAnyFileItEndsAsIfItHadNotBeen) {
    const fs::path whole = scratch_ / "whole";
    expect_done({"run", file_.string(), "-o", whole.string()});
    // What is killed has 64 structures more ahead of it, so that no run ends before its kill.
    std::string text = experiment;
    std::string leaves = "1";
    for (int leaf = 2; leaf <= 64; ++leaf) leaves += ", " + std::to_string(leaf);
    const std::string last = "\"van-emde-boas-12+6:node=16\"]}";
    ASSERT_NE(text.find(last), text.npos);
    text.insert(text.find(last) + last.size(),
                R"(, {"structure": "median-kd", "leaf": [)" + leaves + R"(], "layouts": ["heap-20"]})");
    write(file_, text);
    const auto files = [&](const fs::path& where) {
        std::size_t found = 0;
        std::error_code gone;
        for (fs::directory_iterator entry(folder_ / where, gone), end; entry != end && !gone;
             entry.increment(gone))
            ++found;
        return found;
    };
    // One after the other in the same folder: within the first walk, after it, parts of the last structure.
    for (const auto& [where, count] : std::vector<std::pair<fs::path, std::size_t>>{
             {"walks/octree-leaf-2-found-1", 3}, {"walks", 2}, {"parts", 30}, {"parts", 34}}) {
        Process run(words());
        ASSERT_TRUE(run.wait_until([&, where = where, count = count] { return files(where) >= count; }))
            << run.outcome().err;
        run.send(SIGKILL);
        EXPECT_EQ(run.outcome().exit_code, -SIGKILL) << where << " " << count;
    }
    write(file_, experiment);
    EXPECT_EQ(Process(words()).outcome().exit_code, 0);
    EXPECT_EQ(told_rows(), told(results::read_csv(whole / "rows.csv")));
}

}  // namespace
}  // namespace regather::cli
