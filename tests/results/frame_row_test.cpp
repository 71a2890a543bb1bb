#include "results/frame_row.h"

#include <gtest/gtest.h>

namespace regather::results {
namespace {

FrameRow row(std::string unit, std::string run, std::string part, std::string level, std::uint64_t bytes) {
    FrameRow row;
    row.unit = std::move(unit);
    row.run = std::move(run);
    row.part = std::move(part);
    row.machine = "mine";
    row.level = std::move(level);
    row.bytes_in = bytes;
    return row;
}

TEST(FrameTable, SetsTogetherBesideApartLevelByLevel) {
    std::vector<FrameRow> rows{
        row("pixel", "together", "eye rays", "L1", 300), row("pixel", "together", "eye rays", "L1", 20),
        row("pixel", "together", "eye rays", "L2", 40),  row("pixel", "together", "photons", "L1", 500),
        row("pixel", "together", "photons", "L2", 7),    row("pixel", "apart", "eye rays", "L1", 310),
        row("pixel", "apart", "eye rays", "L2", 100),    row("pixel", "apart", "photons", "L1", 450),
        row("pixel", "apart", "photons", "L2", 7),       row("frame", "together", "photons", "L1", 90)};
    rows[1].bytes_out = 4;
    FrameRow dram = row("pixel", "apart", "photons", "dram", 0);
    dram.bytes_in.reset();
    rows.push_back(dram);
    EXPECT_EQ(text_of(frame_table(rows)),
              "machine  unit   level  part      apart  together  difference\n"
              "mine     pixel  L1     eye rays  310 B     324 B        14 B\n"
              "mine     pixel  L1     photons   450 B     500 B        50 B\n"
              "mine     pixel  L1     all       760 B     824 B        64 B\n"
              "mine     pixel  L2     eye rays  100 B      40 B       -60 B\n"
              "mine     pixel  L2     photons     7 B       7 B         0 B\n"
              "mine     pixel  L2     all       107 B      47 B       -60 B\n"
              "mine     frame  L1     photons     0 B      90 B        90 B\n"
              "mine     frame  L1     all         0 B      90 B        90 B\n");
}

}  // namespace
}  // namespace regather::results
