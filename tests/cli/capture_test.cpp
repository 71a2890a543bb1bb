// `regather capture`: what it makes, what it keeps, what it never destroys.
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Capture, MakesImagesAndATrace) {
    const auto files = contents(captured_box());
    EXPECT_EQ(files.at("image.exr").substr(0, 4), "\x76\x2f\x31\x01");  // OpenEXR's magic number
    EXPECT_EQ(files.at("image.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_TRUE(files.contains("trace/trace.json"));
    for (const auto& [name, bytes] : files) EXPECT_THAT(name, testing::Not(HasSubstr("partial")));
    EXPECT_THAT(expect_done({"info", box_trace(), "--verify"}).out,
                testing::AllOf(HasSubstr("16 x 16 pixels"), HasSubstr("2000 photons, k = 20"),
                               HasSubstr("verified")));
}

TEST(Capture, PackedPhotonsAreTraceAndPictureAndWhatTheyCostIsTold) {
    const Scratch scratch;
    const std::vector<std::string> words =
        small_capture(scratch / "box") + std::vector<std::string>{"--photon-record", "16"};
    EXPECT_THAT(expect_done(words).out,
                testing::AllOf(HasSubstr("photons of 16 bytes: moved by at most"), HasSubstr("FLIP")));
    EXPECT_THAT(expect_done(words).out,
                testing::AllOf(HasSubstr("kept the finished capture"), HasSubstr("photons of 16 bytes")));
    // The walks are of the photons that the trace holds, the queries those of whole photons.
    expect_done({"info", (scratch / "box/trace").string(), "--verify"});
    trace::TraceReader packed(scratch / "box/trace"), whole(captured_box() / "trace");
    EXPECT_NE(packed.digests().at("photon"), whole.digests().at("photon"));
    EXPECT_EQ(packed.digests().at("query_position"), whole.digests().at("query_position"));
    expect_refused(bad_usage, small_capture(scratch / "box"), {"other parameters"});
    expect_refused(bad_usage,
                   small_capture(scratch / "no") + std::vector<std::string>{"--photon-record", "18"},
                   {"--photon-record", "18"});
}

TEST(Capture, AnIrradianceCacheIsToldAndItsOctreeIsATrace) {
    const Scratch scratch;
    using Words = std::vector<std::string>;
    const Words words = small_capture(scratch / "box") + Words{"--irradiance-cache", "bounded:least=1"};
    const auto told = testing::AllOf(HasSubstr("irradiance cache: "), HasSubstr(" points served ("),
                                     HasSubstr("its octree: "));
    EXPECT_THAT(expect_done(words).out, told);
    EXPECT_THAT(expect_done(words).out, testing::AllOf(HasSubstr("kept the finished capture"), told));
    expect_done({"info", (scratch / "box/trace").string(), "--verify"});
    const std::string octree = (scratch / "box/irradiance-trace").string();
    EXPECT_THAT(expect_done({"info", octree, "--verify"}).out, HasSubstr("verified"));
    EXPECT_THAT(expect_done({"replay", octree, "--order", "naive", "hilbert"}).out, HasSubstr("hilbert"));
    const std::string rows = (scratch / "detail.csv").string();
    expect_done({"detail", octree, "--order", "naive", "--cache", "1K:128:2", "--csv", rows});
    EXPECT_THAT(content(rows), testing::AllOf(HasSubstr(",nodes,"), HasSubstr(",irradiance,")));
    // Another capture into the folder leaves no octree of this one.
    expect_done(small_capture(scratch / "box") + Words{"--force"});
    EXPECT_FALSE(fs::exists(octree));
    const auto refused = [&](const Words& with, const std::vector<std::string>& parts) {
        expect_refused(bad_usage, Words{"capture", "box", "-o", (scratch / "no").string()} + with, parts);
        EXPECT_FALSE(fs::exists(scratch / "no"));
    };
    refused({"--irradiance-cache", "bonded"}, {"irradiance cache", "bonded", "nearest: bounded"});
    refused({"--irradiance-cache", "bounded", "--mode", "direct"}, {"--irradiance-cache", "--mode direct"});
    refused({"--irradiance-cache", "bounded", "--gather-rays", "0"},
            {"--irradiance-cache", "--gather-rays 0"});
    refused({"--irradiance-cache", "bounded", "--photon-record", "16"},
            {"--irradiance-cache", "--photon-record 16"});
}

TEST(Capture, TheSameIsKeptAndOthersNeedForce) {
    const Scratch scratch;
    const std::vector<std::string> words =
        small_capture(scratch / "box") + std::vector<std::string>{"--radius", "0.3"};
    EXPECT_THAT(expect_done(words).out, HasSubstr("captured box"));
    const auto first = contents(scratch / "box");
    const auto written = fs::last_write_time(scratch / "box/trace/trace.json");
    EXPECT_THAT(expect_done(words).out, HasSubstr("kept the finished capture"));
    EXPECT_EQ(fs::last_write_time(scratch / "box/trace/trace.json"), written);

    const std::vector<std::string> other = words + std::vector<std::string>{"--seed", "2"};
    expect_refused(bad_usage, other, {"box/trace", "other parameters", "--force"});
    EXPECT_EQ(contents(scratch / "box"), first);
    expect_done(other + std::vector<std::string>{"--force"});
    EXPECT_NE(content(scratch / "box/trace/trace.json"), first.at("trace/trace.json"));
    EXPECT_NE(content(scratch / "box/image.exr"), first.at("image.exr"));

    // The order of the searches changes the time, not the result.
    expect_done(words + std::vector<std::string>{"--gather-order", "random", "--force"});
    EXPECT_EQ(contents(scratch / "box"), first);
}

TEST(Capture, WhileAnotherProcessWritesIntoTheFolderItIsRefused) {
    const Scratch scratch;
    {
        const trace::FolderLock other(scratch / "box/trace");
        expect_refused(bad_usage, small_capture(scratch / "box"), {"box/trace: another process is writing"});
        expect_refused(bad_usage, small_capture(scratch / "box") + std::vector<std::string>{"--force"},
                       {"box/trace: another process is writing"});
        EXPECT_TRUE(contents(scratch / "box").empty());
    }
    expect_done(small_capture(scratch / "box"));
}

// Whatever the two do at the same time, the trace is that of one of them, whole.
TEST(Capture, TwoAtOnceLeaveOneWholeTrace) {
    const Scratch scratch;
    const auto words = [&](const char* seed) {
        return small_capture(scratch / "box") + std::vector<std::string>{"--seed", seed};
    };
    Process one(words("1")), other(words("2"));
    const Outcome first = one.outcome(), second = other.outcome();
    EXPECT_TRUE(first.exit_code == 0 || second.exit_code == 0) << first.err << second.err;
    for (const Outcome* outcome : {&first, &second})
        if (outcome->exit_code != 0) {
            EXPECT_EQ(outcome->exit_code, bad_usage) << outcome->err;
            EXPECT_EQ(std::count(outcome->err.begin(), outcome->err.end(), '\n'), 1) << outcome->err;
        }
    expect_done({"info", (scratch / "box/trace").string(), "--verify"});
}

TEST(Capture, AKeptTraceWithoutItsImageIsNotCalledFinished) {
    const Scratch scratch;
    expect_done(small_capture(scratch / "box"));
    fs::remove(scratch / "box/image.png");
    expect_refused(bad_usage, small_capture(scratch / "box"), {"image.png", "--force"});
    expect_done(small_capture(scratch / "box") + std::vector<std::string>{"--force"});
    EXPECT_TRUE(fs::exists(scratch / "box/image.png"));
}

TEST(Capture, OtherFilesInTheTracesFolderAreSafe) {
    const Scratch scratch;
    fs::create_directories(scratch / "box/trace");
    write(scratch / "box/trace/thesis.tex", "years of work");
    expect_refused(bad_usage, small_capture(scratch / "box") + std::vector<std::string>{"--force"},
                   {"thesis.tex"});
    EXPECT_EQ(contents(scratch / "box"),
              (std::map<std::string, std::string>{{"trace/thesis.tex", "years of work"}}));
}

TEST(Capture, AFileInTheFoldersPlaceIsAFailedRun) {
    const Scratch scratch;
    write(scratch / "box", "a file");
    expect_refused(run_failed, small_capture(scratch / "box"), {"box"});
    EXPECT_EQ(content(scratch / "box"), "a file");
}

/// Whether a capture has come so far: so many files in its folder, whole or begun.
bool has_files(const fs::path& folder, std::size_t count) {
    std::size_t found = 0;
    std::error_code gone;  // files are renamed while one looks
    for (fs::recursive_directory_iterator entry(folder, gone), end; entry != end && !gone;
         entry.increment(gone))
        found += !entry->is_directory(gone);
    return found >= count;
}

TEST(SlowCapture, KilledAfterAnyFileItLeavesNothingThatReplayAccepts) {
    for (const std::size_t files : {1, 4, 12, 18}) {
        const Scratch scratch;
        const std::string folder = (scratch / "room").string();
        Process capture({"capture", "room", "-o", folder, "--width", "32", "--height", "32", "--photons",
                         "20000", "--gather-rays", "40"});
        ASSERT_TRUE(capture.wait_until([&] { return has_files(folder, files); })) << capture.outcome().err;
        capture.send(SIGKILL);
        const int code = capture.outcome().exit_code;
        EXPECT_TRUE(code == -SIGKILL || code == 0) << code;
        const std::vector<std::string> replay{"replay", folder + "/trace", "--order", "naive"};
        if (!fs::exists(folder + "/trace/trace.json"))
            expect_refused(bad_data, replay, {"room/trace"});
        else
            EXPECT_NO_THROW(
                trace::TraceReader(folder + "/trace").verify_all());  // killed after the last step
        // What the interrupted one left is in nobody's way.
        expect_done({"capture", "room", "-o", folder, "--width", "8", "--height", "8", "--photons", "500",
                     "--gather-rays", "4", "--force"});
        EXPECT_NO_THROW(trace::TraceReader(folder + "/trace").verify_all());
    }
}

}  // namespace
}  // namespace regather::cli
