// SIGINT and SIGTERM: what is finished stays, one line says how to go on, and the same command does. Each
// test waits for something that can be seen from outside, with seconds of work still ahead.
#include <signal.h>

#include "cli/interruption.h"
#include "results/convergence_row.h"
#include "results/csv.h"
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Words = std::vector<std::string>;

/// The words' process, ended by `signal` as soon as `seen`.
void expect_interrupted(const Words& words, int signal, const std::function<bool()>& seen,
                        const std::string& kept) {
    Process process(words);
    ASSERT_TRUE(process.wait_until(seen)) << process.outcome().err;
    process.send(signal);
    const Outcome outcome = process.outcome();
    EXPECT_EQ(outcome.exit_code, 128 + signal) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const std::string& part :
         {std::string("interrupted"), std::string("the same command goes on"), kept})
        EXPECT_THAT(outcome.err, HasSubstr(part));
}

/// An experiment of so many trials.
std::string experiment_of(std::size_t trials) {
    std::string orderings;
    for (std::size_t t = 1; t <= trials; ++t)
        orderings +=
            (t == 1 ? "" : ", ") + std::string(R"({"ordering": "tiled", "tile": )") + std::to_string(t) + "}";
    return R"({"scene": "box", "capture": {"width": 64, "height": 64, "photons": 20000, "k": 50, "gather_rays": 8},
        "caches": [{"size": "2K"}], "orderings": [)" +
           orderings + "]}";
}

TEST(SlowSignal, ARunKeepsItsFinishedParts) {
    const Scratch scratch;
    const fs::path folder = scratch / "out";
    const auto parts = [&] {
        std::map<fs::path, fs::file_time_type> found;
        if (fs::exists(folder / "parts"))
            for (const auto& entry : fs::directory_iterator(folder / "parts"))
                if (const std::string name = entry.path().filename().string();
                    name.starts_with("rows-") && name.ends_with(".part"))
                    found[entry.path()] = fs::last_write_time(entry.path());
        return found;
    };
    write(scratch / "many.json", experiment_of(400));
    expect_interrupted(
        {"run", (scratch / "many.json").string(), "-o", folder.string()}, SIGINT,
        [&] { return !parts().empty(); }, "finished parts are there");
    const auto kept = parts();
    EXPECT_FALSE(kept.empty());
    EXPECT_FALSE(fs::exists(folder / "rows.csv"));
    // The first of the trials alone, in place of minutes: their parts are those of the long run.
    write(scratch / "many.json", experiment_of(2));
    EXPECT_THAT(expect_done({"run", (scratch / "many.json").string(), "-o", folder.string()}).out,
                HasSubstr("kept the finished capture"));
    EXPECT_EQ(results::read_csv(folder / "rows.csv").size(), 2u);
    for (const auto& [path, time] : kept) EXPECT_EQ(fs::last_write_time(path), time) << path;
}

TEST(SlowSignal, ACaptureKeepsItsFinishedFrames) {
    const Scratch scratch;
    const Words words{"capture",
                      "cornell",
                      "-o",
                      (scratch / "out").string(),
                      "--width",
                      "48",
                      "--height",
                      "48",
                      "--frames",
                      "0:30",
                      "--gather-rays",
                      "40",
                      "--photons",
                      "20000"};
    const fs::path first = scratch / "out/frame-0000/trace/trace.json",
                   second = scratch / "out/frame-0001/trace";
    expect_interrupted(
        words, SIGTERM, [&] { return fs::exists(second); }, "finished frames are there");
    ASSERT_TRUE(fs::exists(first));
    const auto written = fs::last_write_time(first);
    Words two = words;
    two[9] = "0,1";
    EXPECT_THAT(expect_done(two).out,
                HasSubstr("kept the finished capture in " + (scratch / "out/frame-0000").string()));
    EXPECT_EQ(fs::last_write_time(first), written);
    EXPECT_NO_THROW(trace::TraceReader(second).verify_all());
}

TEST(SlowSignal, AConvergenceKeepsItsRows) {
    const Scratch scratch;
    const fs::path csv = scratch / "out/converge.csv";
    Words truth{"reference", "box", "-o", (scratch / "truth").string(), "--width", "12", "--height", "12"};
    expect_done(truth + Words{"--samples", "8"});
    const auto settings = [](std::size_t count) {
        std::string text = "ladder,mode,photons,k\n";
        for (std::size_t s = 0; s < count; ++s) text += "photons,direct," + std::to_string(500 + s) + ",20\n";
        return text;
    };
    write(scratch / "ladder.csv", settings(4000));
    const Words words{"converge",    "box",
                      "-o",          (scratch / "out").string(),
                      "--seconds",   "600",
                      "--seeds",     "2",
                      "--ladder",    (scratch / "ladder.csv").string(),
                      "--reference", (scratch / "truth").string()};
    expect_interrupted(
        words, SIGINT, [&] { return fs::exists(csv); }, "measured settings are there");
    const auto rows = results::read_csv<results::ConvergenceRow>(csv);
    ASSERT_FALSE(rows.empty());
    write(scratch / "out/strips/partial-photons-slowest.png", "half");
    write(scratch / "ladder.csv", settings(1));
    const std::string before = content(csv);
    expect_done(words);
    EXPECT_EQ(content(csv), before);  // seconds included
    for (const auto& [name, bytes] : contents(scratch / "out"))
        EXPECT_THAT(name, testing::Not(HasSubstr("partial")));
}

TEST(SlowSignal, AReferenceKeepsItsSamples) {
    const Scratch scratch;
    const auto words = [&](const char* samples) {
        return Words{"reference", "box",  "-o", (scratch / "out").string(), "--width", "64", "--height", "64",
                     "--samples", samples};
    };
    expect_interrupted(
        words("1000000"), SIGTERM, [&] { return fs::exists(scratch / "out/reference.json"); },
        "its samples are there");
    EXPECT_TRUE(fs::exists(scratch / "out/reference.exr"));
    EXPECT_THAT(expect_done(words("1")).out, HasSubstr("samples a pixel"));
}

TEST(Interruption, TheFirstSignalIsKeptAndTheSecondKills) {
    EXPECT_EXIT(
        {
            const Interruption interruption;
            const auto listener = interruption.ending({});
            listener("", "", 0, 1);
            ::raise(SIGINT);
            try {
                listener("", "", 0, 1);
            } catch (const Interrupted& interrupted) {
                if (interrupted.signal == SIGINT) ::raise(SIGTERM);
            }
            std::exit(0);
        },
        testing::KilledBySignal(SIGTERM), "");
    EXPECT_EXIT(
        {
            { const Interruption interruption; }
            ::raise(SIGINT);
            std::exit(0);
        },
        testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace regather::cli
