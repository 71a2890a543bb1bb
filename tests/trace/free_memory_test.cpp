// The memory that Linux says is to be had, in texts as it writes them.
#include "trace/free_memory.h"

#include <gtest/gtest.h>

namespace regather::trace {
namespace {

constexpr std::string_view meminfo =
    "MemTotal:       24597780 kB\nMemFree:          507032 kB\nMemAvailable:    3000001 kB\nBuffers: 7 kB\n";

TEST(FreeMemory, IsWhatIsAvailableOrTheLimitIfThatIsLess) {
    EXPECT_EQ(free_memory_in(meminfo, "max\n"), 3000001u * std::uint64_t{1024});
    EXPECT_EQ(free_memory_in(meminfo, ""), 3000001u * std::uint64_t{1024});
    EXPECT_EQ(free_memory_in(meminfo, "1073741824\n"), 1073741824u);
    EXPECT_EQ(free_memory_in(meminfo, "9223372036854771712\n"), 3000001u * std::uint64_t{1024});
}

TEST(FreeMemory, WithoutATextIsTheOther) {
    EXPECT_EQ(free_memory_in("", "1073741824\n"), 1073741824u);
    EXPECT_EQ(free_memory_in("MemTotal: 5 kB\n", "max\n"), 0u);
    EXPECT_EQ(free_memory_in("", ""), 0u);
}

TEST(FreeMemory, OfThisMachineIsSome) {
    EXPECT_GT(free_memory(), 0u);
}

}  // namespace
}  // namespace regather::trace
