// Machines at the command line: what is listed, what a trace gives, what is refused.
#include "tests/cli/expect.h"

namespace regather::cli {
namespace {

using testing::HasSubstr;

// Lines of 64 B: A, B, A, C (written), A. L1 has 1 way, L2 has 2 and holds the victims of L1.
//   A: "A|"  B: "B|A"  A: "A|B" from L2  C: "C|AB", dirty  A: "A|BC" from L2; at the end C is written back
// Rows of 64 B, one bank: each burst that reaches memory (A, B, C, then C written) opens another row, but for
// the last.
constexpr const char* din = "0 0\n0 40\n0 4\n1 80\n0 8\n";
constexpr const char* toy = R"({
  "name": "toy",
  "levels": [
    {"name": "L1", "size_bytes": 64, "line_bytes": 64, "ways": 1},
    {"name": "L2", "size_bytes": 128, "line_bytes": 64, "ways": 2, "inclusion": "exclusive"}
  ],
  "dram": {"channels": 1, "banks": 1, "row_bytes": 64, "burst_bytes": 64, "activate_pj": 100, "read_pj": 10, "write_pj": 1}
})";
constexpr const char* header =
    "scene,structure,layout,ordering,parameters,machine,level,region,accesses,hits,misses,sector_misses,"
    "victim_hits,"
    "writebacks,clean_victims,writes_"
    "through,"
    "back_invalidations,prefetches,useful_prefetches,bytes_in,bytes_out,bursts_read,bursts_written,row_hits,"
    "row_empty,row_conflicts,picojoules\n";

TEST(MachineCommand, WritesARowForEachLevelAndOneForTheDram) {
    const Scratch scratch;
    write(scratch / "a.din", din);
    write(scratch / "toy.json", toy);
    const std::string rows =
        ",,,,,toy,L1,other,5,0,5,0,0,1,3,0,0,0,0,320,256,,,,,,\n"
        ",,,,,toy,L2,other,5,2,3,0,0,1,0,0,0,0,0,192,64,,,,,,\n"
        ",,,,,toy,dram,other,,,,,,,,,,,,,,3,1,1,1,2,331\n";
    const std::vector<std::string> words{"cachesim", (scratch / "a.din").string(), "--machine",
                                         (scratch / "toy.json").string()};
    EXPECT_EQ(expect_done(words).out, header + rows);
    // A file gets the same, and is not overwritten; two machines share the pass.
    const std::vector<std::string> to_file =
        words + std::vector<std::string>{"--csv", (scratch / "l.csv").string()};
    expect_done(to_file);
    EXPECT_EQ(content(scratch / "l.csv"), header + rows);
    expect_refused(bad_usage, to_file, {"l.csv: exists", "--force"});
    const std::string both = expect_done({"cachesim", (scratch / "a.din").string(), "--machine",
                                          "paper-128k," + (scratch / "toy.json").string()})
                                 .out;
    // Lines of 128 B: A and B are one line.
    EXPECT_THAT(both, HasSubstr("\n,,,,,paper-128k,L1,other,5,3,2,0,0,1,0,0,0,0,0,256,128,,,,,,\n"));
    EXPECT_THAT(both, testing::EndsWith("\n" + rows));
}

TEST(MachineCommand, ListsWhatIsBuiltInAndShowsTheSourceOfEachFigure) {
    const std::string all = expect_done({"machines"}).out;
    EXPECT_THAT(all, HasSubstr("paper-128k           L1 128K 8-way"));
    EXPECT_THAT(all, HasSubstr("L1D 48K 12-way, L2 2M 16-way, L3 1920K 15-way"));
    EXPECT_THAT(all, HasSubstr("gpu-a100             L1 192K 384-way, L2 40M 16-way"));
    const std::string one = expect_done({"machines", "gpu-a100"}).out;
    EXPECT_THAT(one, HasSubstr("L2: 20480 sets of 16\n"));
    EXPECT_THAT(one, HasSubstr("  activate_pj    909           O'Connor"));
}

TEST(MachineCommand, RefusesBadFilesAndUnknownNames) {
    const Scratch scratch;
    write(scratch / "a.din", din);
    std::string text = toy;
    text.replace(text.find("\"ways\": 2"), 9, "\"ways\": 0");
    write(scratch / "bad.json", text);
    const std::string trace = (scratch / "a.din").string(), bad = (scratch / "bad.json").string();
    expect_refused(bad_data, {"machines", bad}, {"bad.json: line ", ", levels[1].ways: found 0, expected"});
    expect_refused(bad_data, {"cachesim", trace, "--machine", bad}, {", levels[1].ways: found 0"});
    expect_refused(bad_data, {"machines", (scratch / "no.json").string()}, {"no.json: found no such file"});
    expect_refused(bad_usage, {"machines", "gpu-a10"}, {"unknown machine 'gpu-a10'", "\"gpu-a100\""});
    expect_refused(bad_usage, {"cachesim", trace, "--machine", ""}, {"--machine", "''"});
    expect_refused(bad_usage, {"cachesim", trace, "--machine", "paper-128k,"}, {"unknown machine ''"});
    expect_refused(bad_usage, {"cachesim", trace, "--machine", "paper-128k", "--size", "1K"},
                   {"--machine", "--size"});
    expect_refused(bad_usage, {"cachesim", trace, "--size", "1K", "--line", "64"}, {"--ways: found none"});
}

}  // namespace
}  // namespace regather::cli
