// `regather frame`: traces of one capture through one hierarchy.
#include <fmt/format.h>

#include <map>

#include "results/csv.h"
#include "results/frame_row.h"
#include "tests/cli/expect.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using results::FrameRow, results::MachineRow;
using testing::HasSubstr;
using Words = std::vector<std::string>;

std::string walked(const Scratch& scratch, const std::string& rays, const std::string& structure) {
    const fs::path to = scratch / fmt::format("{} {}", rays, structure);
    if (!fs::exists(to))
        expect_done({"walk", box_trace(), "--rays", rays, "--structure", structure, "-o", to.string()});
    return to.string();
}

std::vector<FrameRow> framed(const Words& words) {
    return results::from_csv<FrameRow>(expect_done(Words{"frame"} + words).out, "stdout");
}

/// Bytes to and from memory by part and run.
std::map<std::string, std::uint64_t> bytes_of(const std::vector<FrameRow>& rows) {
    std::map<std::string, std::uint64_t> bytes;
    for (const FrameRow& row : rows)
        bytes[row.run + ' ' + row.part] += row.bytes_in.value_or(0) + row.bytes_out.value_or(0);
    return bytes;
}

template <class R>
Words counts(const std::vector<R>& rows) {
    Words all;
    for (const R& row : rows) {
        std::string& text = all.emplace_back();
        for (const results::Column& column : MachineRow::kind().columns)
            text += results::cell_text(column, static_cast<const MachineRow*>(&row)) + ',';
    }
    return all;
}

TEST(FrameCommand, OneTraceAloneIsItsReplayThroughTheMachine) {
    const Scratch scratch;
    const std::string gather = walked(scratch, "gather", "bvh-4:stack=1");
    for (const std::string order : {"naive", "origin-end"}) {
        const Words machine{"--order",  order,           "--machine", "paper-128k,gpu-a100",
                            "--layout", "depth-first-36"};
        const auto replayed =
            results::from_csv<MachineRow>(expect_done(Words{"replay", gather} + machine).out, "stdout");
        for (const std::string run : {"together", "apart"}) {
            std::vector<FrameRow> rows = framed(Words{gather} + machine + Words{"--unit", "frame"});
            std::erase_if(rows, [&](const FrameRow& row) { return row.run != run; });
            EXPECT_EQ(counts(rows), counts(replayed));
            EXPECT_EQ(rows.front().part, "gather rays");
            EXPECT_EQ(rows.front().unit, "frame");
        }
    }
}

TEST(FrameCommand, RaysShareTheHierarchyAndPhotonsLieElsewhere) {
    const Scratch scratch;
    const Words traces{walked(scratch, "eye", "bvh-2"), walked(scratch, "shadow", "bvh-2"),
                       walked(scratch, "gather", "bvh-2"), box_trace()};
    // All fits: apart each fetches its lines, together only the first does.
    const auto ample = framed(
        traces + Words{"--order", "naive", "--cache", "4M:64:full", "--unit", "pixel", "tile=4", "frame"});
    for (const std::string unit : {"pixel", "tile=4", "frame"}) {
        std::vector<FrameRow> rows = ample;
        std::erase_if(rows, [&](const FrameRow& row) { return row.unit != unit; });
        const auto bytes = bytes_of(rows);
        ASSERT_EQ(bytes.size(), 8u);
        const auto of = [&](const std::string& part) { return bytes.at(part); };
        EXPECT_EQ(of("together photons"), of("apart photons"));
        EXPECT_GT(of("apart photons"), 2000u * 20 / 2);
        const std::uint64_t shared = of("together eye rays") + of("together shadow rays") +
                                     of("together gather rays"),
                            most = of("apart gather rays");
        EXPECT_GE(shared, most);
        EXPECT_LT(shared, most + of("apart eye rays") + of("apart shadow rays"));
    }
    // Another structure is other memory.
    const auto own =
        bytes_of(framed(Words{walked(scratch, "eye", "bvh-4"), walked(scratch, "gather", "bvh-2")} +
                        Words{"--order", "naive", "--cache", "4M:64:full"}));
    EXPECT_EQ(own.at("together eye rays"), own.at("apart eye rays"));
    EXPECT_EQ(own.at("together gather rays"), own.at("apart gather rays"));
    // What does not fit is fetched again after another's turn.
    const auto small = bytes_of(framed(traces + Words{"--order", "naive", "--cache", "2K:64:full"}));
    EXPECT_GT(small.at("together photons"), small.at("apart photons"));
}

TEST(FrameCommand, EachTraceHasItsOrderAndLayout) {
    const Scratch scratch;
    const fs::path csv = scratch / "frame.csv";
    const Words words{"frame",
                      walked(scratch, "gather", "bvh-4"),
                      walked(scratch, "eye", "bvh-4"),
                      box_trace(),
                      "--order",
                      "origin-end:tile=4",
                      "hilbert:tile=4",
                      "hilbert:tile=4",
                      "--layout",
                      "depth-first-36",
                      "depth-first-36",
                      "heap-32",
                      "--unit",
                      "tile=4",
                      "--csv",
                      csv.string()};
    const Outcome done = expect_done(words);
    EXPECT_THAT(done.out, HasSubstr("131072:128:8  tile=4  L1     gather rays"));
    EXPECT_THAT(done.out, HasSubstr("all"));
    const auto rows = results::read_csv<FrameRow>(csv);
    EXPECT_EQ(rows.front().parameters, "origin-end:tile=4,bits=8");
    EXPECT_EQ(rows.front().layout, "depth-first-36:node=128");
    EXPECT_EQ(rows.back().ordering, "hilbert");
    EXPECT_EQ(rows.back().layout, "heap-32");
    const std::string json = content(scratch / "frame.json");
    for (const char* part : {"\"gather rays\": {", "\"photons\": {", "\"fingerprint\""})
        EXPECT_THAT(json, HasSubstr(part));
    expect_refused(bad_usage, words, {"frame.csv: exists", "--force"});
    EXPECT_THAT(expect_done({"results", scratch.path().string()}).out,
                HasSubstr("0 of 1 outdated, 0 not told"));
}

TEST(FrameCommand, WhatIsNoFrameIsRefused) {
    const Scratch scratch;
    const std::string eye = walked(scratch, "eye", "bvh-4"), other = (scratch / "other").string();
    const auto refused = [&](int code, const Words& words, const Words& parts) {
        expect_refused(code, Words{"frame"} + words, parts);
    };
    refused(bad_usage, {eye, eye + "/.", "--order", "naive"}, {"found eye rays as in", "each kind once"});
    refused(bad_usage, {eye, box_trace(), "--order", "naive", "tiled", "random"},
            {"--order: found 3 for 2 traces"});
    refused(bad_usage, {eye, box_trace(), "--order", "naive", "--layout", "heap-36", "heap-36", "heap-20"},
            {"--layout: found 3 for 2 traces"});
    for (const char* unit : {"tile", "tile=", "tile=0", "tile=65537", "tile=4x", "tile=-1", "pixels"})
        refused(bad_usage, {eye, "--order", "naive", "--unit", unit},
                {fmt::format("--unit: found \"{}\", expected pixel, tile=N", unit)});
    refused(bad_usage, {eye, "--order", "naive", "--cache", "100:64:1"},
            {"cache 100:64:1: size_bytes: found 100"});
    refused(bad_usage, {eye, box_trace(), "--order", "naive", "--layout", "heap-36"},
            {"unknown record \"36\""});
    Words again = small_capture(other);
    again.insert(again.end(), {"--seed", "2"});
    expect_done(again);
    refused(bad_data, {eye, other + "/trace", "--order", "naive"},
            {"seed: found 2, expected 1", "one capture"});
    Words finer = small_capture(scratch / "finer") + Words{"--radius", "2"};
    expect_done(finer);
    refused(bad_data, {eye, (scratch / "finer/trace").string(), "--order", "naive"},
            {"parameters: found those of another capture"});
}

}  // namespace
}  // namespace regather::cli
