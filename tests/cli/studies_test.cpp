// The commands that say whether pictures can be trusted: reference, converge, stability; and heatmap, frames
// and layers of captures.
#include "capture/images/image.h"
#include "results/convergence_row.h"
#include "results/csv.h"
#include "results/stability_row.h"
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Words = std::vector<std::string>;

TEST(Reference, StoppedAndContinuedItIsTheSameToTheLastBit) {
    const Scratch scratch;
    const std::string once = (scratch / "once").string(), twice = (scratch / "twice").string();
    const auto words = [](const std::string& folder, const char* samples) {
        return Words{"reference", "box", "-o", folder, "--width", "8", "--height", "6", "--samples", samples};
    };
    expect_done(words(once, "5"));
    expect_done(words(twice, "2"));
    expect_done(words(twice, "5"));
    EXPECT_EQ(content(fs::path(once) / "reference.exr"), content(fs::path(twice) / "reference.exr"));
    EXPECT_EQ(content(fs::path(once) / "variance.exr"), content(fs::path(twice) / "variance.exr"));
    expect_refused(bad_usage, words(twice, "6") + Words{"--seed", "2"}, {"seed"});
    expect_refused(bad_usage,
                   {"reference", "room", "-o", twice, "--width", "8", "--height", "6", "--samples", "6"}, {});
}

TEST(Converge, WritesRowsChartsAndStripsAndGoesOnWhereItStopped) {
    const Scratch scratch;
    const std::string folder = (scratch / "out").string();
    write(scratch / "ladder.csv",
          "ladder,mode,photons,k\nphotons,direct,500,20\nphotons,direct,2000,20\nphotons,direct,8000,20\n");
    const Words words{"converge", "box", "-o",      folder, "--seconds", "20",
                      "--width",  "12",  "--seeds", "3",    "--ladder",  (scratch / "ladder.csv").string()};
    const Words reference{"reference", "box", "-o",       (scratch / "truth").string(),
                          "--width",   "12",  "--height", "12",
                          "--samples", "64"};
    expect_done(reference);
    const Words against{"--reference", (scratch / "truth").string()};
    EXPECT_THAT(expect_done(words + against).out, HasSubstr("photons"));
    const std::string csv = content(fs::path(folder) / "converge.csv");
    const auto rows = results::read_csv<results::ConvergenceRow>(fs::path(folder) / "converge.csv");
    ASSERT_EQ(rows.size(), 3u);
    for (const results::ConvergenceRow& row : rows) EXPECT_TRUE(row.rmse && row.total_seconds);
    EXPECT_FALSE(fs::is_empty(fs::path(folder) / "charts"));
    EXPECT_FALSE(fs::is_empty(fs::path(folder) / "strips"));
    expect_done(words + against);
    EXPECT_EQ(content(fs::path(folder) / "converge.csv"),
              csv);  // seconds included: nothing was measured again
    expect_refused(bad_data, words + Words{"--reference", (scratch / "none").string()}, {"none"});
}

TEST(Stability, ReportsEachCaseAndTheExitCode) {
    const Scratch scratch;
    const Outcome outcome =
        expect_done({"stability", "--quick", "--only", "maps", "-o", (scratch / "out").string()});
    EXPECT_THAT(outcome.out, HasSubstr("k = 1"));
    const auto rows = results::read_csv<results::StabilityRow>(scratch / "out" / "stability.csv");
    EXPECT_GE(rows.size(), 10u);
    expect_refused(bad_usage, {"stability", "--only", "map"}, {"map"});
}

TEST(Heatmap, HoldsOneChannelAnOrderingWithTheReplaysBytes) {
    const Scratch scratch;
    const std::string trace = box_trace();
    const Words words{"heatmap", trace,     "--order",
                      "naive",   "hilbert", "--cache",
                      "2K:64:2", "-o",      (scratch / "out").string()};
    expect_done(words);
    EXPECT_TRUE(fs::exists(scratch / "out" / "traffic.exr"));
    EXPECT_TRUE(fs::exists(scratch / "out" / "traffic.png"));
    expect_refused(bad_usage, words, {"traffic.exr"});
    expect_refused(bad_usage, {"heatmap", trace, "--cache", "2K,4K:64:2", "-o", (scratch / "two").string()},
                   {"one cache"});
}

TEST(Heatmap, AnImageWithTooManyPixelsIsBadDataBeforeAnythingIsReplayed) {
    const Scratch scratch;
    const fs::path trace = copied_trace(scratch);
    std::string text = content(trace / "trace.json");
    const std::string before = "\"image_width\": 16";
    ASSERT_NE(text.find(before), std::string::npos);
    write(trace / "trace.json", text.replace(text.find(before), before.size(), "\"image_width\": 50000000"));
    expect_refused(bad_data, {"heatmap", trace.string(), "-o", (scratch / "out").string()},
                   {"trace.json", "50000000 x 16", "at most 67108864 pixels"});
    EXPECT_FALSE(fs::exists(scratch / "out"));
}

TEST(Frames, EachHasItsFolderAndTheRowsSayWhich) {
    const Scratch scratch;
    const Words small{"--width",   "8",    "--height",          "8",  "--gather-rays", "4",
                      "--photons", "2000", "--caustic-photons", "500"};
    const std::string folder = (scratch / "out").string();
    EXPECT_THAT(expect_done(Words{"capture", "cornell", "-o", folder, "--frames", "0:30:15"} + small).out,
                HasSubstr("frame 15"));
    for (const std::uint32_t frame : {0u, 15u})
        EXPECT_EQ(trace::TraceReader(fs::path(folder) / (frame == 0 ? "frame-0000" : "frame-0015") / "trace")
                      .info()
                      .frame,
                  frame);
    EXPECT_NE(content(fs::path(folder) / "frame-0000" / "image.exr"),
              content(fs::path(folder) / "frame-0015" / "image.exr"));
    expect_refused(bad_usage, Words{"capture", "cornell", "-o", folder + "2", "--frames", "0:99"} + small,
                   {"frames", "0:99"});
    expect_refused(bad_usage, Words{"capture", "box", "-o", folder + "2", "--frames", "0"} + small,
                   {"no camera path"});
    EXPECT_FALSE(fs::exists(folder + "2"));
}

// box has no specular surface, so each of 12 x 8 pixels is shaded in one point.
TEST(GuideTrace, HasTheSearchesThatChooseDirections) {
    const Scratch scratch;
    const std::string folder = (scratch / "out").string();
    const Words small{"capture", "box",           "-o", folder,      "--width", "12", "--height",
                      "8",       "--gather-rays", "5",  "--photons", "3000"};
    EXPECT_THAT(expect_done(small + Words{"--sampling", "combined:k=70"}).out,
                HasSubstr("guide map: 3000 photons"));
    const trace::TraceReader guide(folder + "/guide-trace"), trace(folder + "/trace");
    EXPECT_EQ(guide.info().map, "guide");
    EXPECT_EQ(guide.info().k, 70u);
    const auto shaded = guide.info().queries;
    EXPECT_GT(shaded, 80u);
    EXPECT_LE(shaded, 96u);
    EXPECT_EQ(guide.info().found_photons, 70 * shaded);
    EXPECT_EQ(*trace.info().counts.find("guide_queries"), trace::Json(shaded));
    expect_done({"info", folder + "/guide-trace", "--verify"});
    const auto rows =
        results::from_csv(expect_done({"replay", folder + "/guide-trace", "--order", "naive"}).out, "stdout");
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].structure, "left-balanced-kd guide");
    EXPECT_EQ(rows[0].queries, shaded);
    // Its photons are those that gathers search, in the same memory.
    expect_done({"frame", folder + "/guide-trace", folder + "/trace", "--order", "naive", "--unit", "pixel"});
    expect_refused(bad_usage, {"computation", folder + "/trace", folder + "/guide-trace"}, {"guide photons"});

    // A strategy that asks none leaves none behind.
    expect_done(small + Words{"--sampling", "cosine", "--force"});
    EXPECT_FALSE(fs::exists(folder + "/guide-trace"));
}

TEST(CausticMap, HasATraceOfItsOwnThatIsReplayedAsAnyOther) {
    const Scratch scratch;
    const std::string folder = (scratch / "out").string();
    expect_done({"capture", "caustics", "-o", folder, "--width", "12", "--height", "8", "--gather-rays", "4",
                 "--photons", "2000", "--caustic-photons", "3000", "--samples", "2"});
    const auto rows = results::from_csv(
        expect_done({"replay", folder + "/caustic-trace", "--order", "naive", "hilbert"}).out, "stdout");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].structure, "left-balanced-kd caustic");
    EXPECT_THAT(expect_done({"info", folder + "/caustic-trace"}).out, HasSubstr("caustic"));
    EXPECT_THAT(expect_done({"info", "caustics"}).out, HasSubstr("needed     caustics"));
    EXPECT_THAT(expect_done({"info", "box"}).out, HasSubstr("left out   caustics"));
    expect_refused(bad_usage, {"capture", "box", "-o", folder + "2", "--keep", "caustic"}, {"caustics"});
    EXPECT_FALSE(fs::exists(folder + "2"));
}

}  // namespace
}  // namespace regather::cli
