#include "experiment/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::experiment {
namespace {

using testing::ElementsAre;

TEST(Frames, AreSingleOnesListsAndRangesWithoutTheirEnd) {
    EXPECT_THAT(parse_frames("7", 30), ElementsAre(7));
    EXPECT_THAT(parse_frames("0,10,29", 30), ElementsAre(0, 10, 29));
    EXPECT_THAT(parse_frames("0:30:5", 30), ElementsAre(0, 5, 10, 15, 20, 25));
    EXPECT_THAT(parse_frames("3:6", 30), ElementsAre(3, 4, 5));
    EXPECT_THAT(parse_frames("0:2,9", 10), ElementsAre(0, 1, 9));
}

TEST(Frames, OutsideThePathOrMisspeltAreRefused) {
    for (const char* text : {"", "30", "0:31", "5:5", "6:5", "0:30:0", "a", "1,", "1:2:3:4", "-1", "0,0",
                             "0:5,4", "1.5", "99999999999"})
        EXPECT_THROW(parse_frames(text, 30), trace::UsageError) << text;
}

}  // namespace
}  // namespace regather::experiment
