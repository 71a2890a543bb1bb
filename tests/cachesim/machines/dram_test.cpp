#include "cachesim/machines/dram.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::cachesim {
namespace {

constexpr auto region = trace::Region::photons;

/// 1 channel of 2 banks; rows of 256 B, bursts of 64 B: burst, row and bank can be counted by hand.
///   address   0   256   512   768   1024
///   bank      0     1     0     1      0
///   row       0     0     1     1      2
DramConfig two_banks() {
    return {.channels = 1,
            .ranks = 1,
            .banks = 2,
            .row_bytes = 256,
            .burst_bytes = 64,
            .channel_bytes = 64,
            .activate_pj = 1000,
            .read_pj = 10,
            .write_pj = 7};
}

TEST(Dram, FindsARowOpenClosedOrAnotherOpen) {
    Dram dram(two_banks());
    const auto read = [&](std::uint64_t address) { dram.access(address, 1, Access::read, region); };
    read(0);     // bank 0: none open        empty      [0, -]
    read(64);    // bank 0, row 0            hit        [0, -]
    read(256);   // bank 1: none open        empty      [0, 0]
    read(512);   // bank 0, row 1            conflict   [1, 0]
    read(300);   // bank 1, row 0            hit        [1, 0]
    read(0);     // bank 0, row 0            conflict   [0, 0]
    read(1024);  // bank 0, row 2            conflict   [2, 0]
    const DramStats stats = dram.stats(region);
    EXPECT_EQ(stats.row_hits, 2u);
    EXPECT_EQ(stats.row_empty, 2u);
    EXPECT_EQ(stats.row_conflicts, 3u);
    EXPECT_EQ(stats.bursts_read, 7u);
    EXPECT_EQ(stats.bursts_written, 0u);
    EXPECT_EQ(dram.picojoules(stats), 5u * 1000 + 7u * 10);
}

TEST(Dram, MovesEveryBurstThatHoldsAByteOfTheAccess) {
    Dram dram(two_banks());
    dram.access(60, 8, Access::read, region);    // bursts 0 and 1
    dram.access(0, 256, Access::write, region);  // 0 to 3
    dram.access(255, 2, Access::write, region);  // 3 and, in bank 1, 4
    dram.access(100, 0, Access::write, region);  // none
    const DramStats stats = dram.stats(region);
    EXPECT_EQ(stats.bursts_read, 2u);
    EXPECT_EQ(stats.bursts_written, 6u);
    EXPECT_EQ(stats.row_empty, 2u);
    EXPECT_EQ(stats.row_hits, 6u);
    EXPECT_EQ(dram.picojoules(stats), 2u * 1000 + 2u * 10 + 6u * 7);
}

TEST(Dram, ChargesTheRegionThatAsks) {
    Dram dram(two_banks());
    dram.access(0, 1, Access::read, trace::Region::photons);
    dram.access(512, 1, Access::write, trace::Region::reorder_buffer);
    EXPECT_EQ(dram.stats(trace::Region::photons), (DramStats{1, 0, 0, 1, 0}));
    EXPECT_EQ(dram.stats(trace::Region::reorder_buffer), (DramStats{0, 1, 0, 0, 1}));
    EXPECT_EQ(dram.total(), (DramStats{1, 1, 0, 1, 1}));
}

// 3 channels in turn every 128 B, rows of 256 B, 4 banks, 2 ranks. Byte 0x1234 = 4660: chunk 36, byte 52 of
// it; channel 36 % 3 = 0, the channel's chunk 12, its byte 1588; row piece 1588 / 256 = 6: bank 2, rank 1,
// row 0.
TEST(Dram, TakesAnAddressApartFromItsLowEnd) {
    const Dram dram(
        {.channels = 3, .ranks = 2, .banks = 4, .row_bytes = 256, .burst_bytes = 32, .channel_bytes = 128});
    EXPECT_EQ(dram.place(0x1234), (Dram::Place{0, 1, 2, 0}));
    EXPECT_EQ(dram.place(0), (Dram::Place{0, 0, 0, 0}));
    EXPECT_EQ(dram.place(128), (Dram::Place{1, 0, 0, 0}));
    EXPECT_EQ(dram.place(256), (Dram::Place{2, 0, 0, 0}));
    EXPECT_EQ(dram.place(384), (Dram::Place{0, 0, 0, 0}));      // the second half of channel 0's first row
    EXPECT_EQ(dram.place(768), (Dram::Place{0, 0, 1, 0}));      // full: the next bank
    EXPECT_EQ(dram.place(4 * 768), (Dram::Place{0, 1, 0, 0}));  // all banks: the next rank
    EXPECT_EQ(dram.place(8 * 768), (Dram::Place{0, 0, 0, 1}));  // all ranks: the next row
}

TEST(Dram, OpensRowsOfRanksAndChannelsApart) {
    Dram dram(
        {.channels = 2, .ranks = 2, .banks = 1, .row_bytes = 64, .burst_bytes = 64, .channel_bytes = 64});
    // Channel 0 rank 0, channel 1 rank 0, channel 0 rank 1, channel 1 rank 1; then all once more.
    for (const std::uint64_t address : {0, 64, 128, 192, 0, 64, 128, 192})
        dram.access(address, 1, Access::read, region);
    EXPECT_EQ(dram.stats(region), (DramStats{8, 0, 4, 4, 0}));
}

// With two banks, rows 0 and 1 of bank 0 collide; XORed with the row, row 1 lives in the other bank.
TEST(Dram, XorOfTheRowSpreadsRowsThatCollide) {
    DramConfig config = two_banks();
    for (const auto& [hash, conflicts] : {std::pair{BankHash::none, 3u}, {BankHash::xor_row, 0u}}) {
        config.bank_hash = hash;
        Dram dram(config);
        for (const std::uint64_t address : {0, 512, 0, 512}) dram.access(address, 1, Access::read, region);
        EXPECT_EQ(dram.stats(region).row_conflicts, conflicts);
        EXPECT_EQ(dram.place(512).bank, hash == BankHash::none ? 0u : 1u);
    }
}

// 4 banks, 3 ranks, rows of 256 B: banks fill 1 KiB, ranks 3 KiB. Byte 0x1f00 = 7936 is row piece 31: bank 3,
// the 7th of the banks' rows; 7 = 2 x 3 + 1: row 2 of rank 1. The bank is XORed with 2, and not with 7.
TEST(Dram, XorTakesTheRowOfTheRankAndNotThatOfAllRanks) {
    DramConfig config = two_banks();
    config.banks = 4;
    config.ranks = 3;
    config.bank_hash = BankHash::xor_row;
    const Dram dram(config);
    EXPECT_EQ(dram.place(0x1f00), (Dram::Place{0, 1, 3 ^ 2, 2}));
    EXPECT_EQ(dram.place(0x400), (Dram::Place{0, 1, 0, 0}));  // the next rank, its row 0
    EXPECT_EQ(dram.place(0xc00), (Dram::Place{0, 0, 1, 1}));  // all ranks: row 1
    config.ranks = 2;
    EXPECT_EQ(Dram(config).place(0x1f00), (Dram::Place{0, 1, 3 ^ 3, 3}));
    EXPECT_EQ(Dram(config).place(0x400), (Dram::Place{0, 1, 0, 0}));
}

TEST(Dram, ReachesTheLastByteOf64Bits) {
    Dram dram(two_banks());
    dram.access(~std::uint64_t{0} - 7, 8, Access::read, region);
    EXPECT_EQ(dram.stats(region).bursts_read, 1u);
}

TEST(Dram, RefusesWhatCannotBeBuilt) {
    const auto refusal = [](auto change) -> std::string {
        DramConfig config = two_banks();
        change(config);
        try {
            const Dram dram(config);
        } catch (const trace::UsageError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_EQ(refusal([](auto& c) { c.channels = 0; }), "channels: found 0, expected at least 1");
    EXPECT_EQ(refusal([](auto& c) { c.ranks = 0; }), "ranks: found 0, expected at least 1");
    EXPECT_EQ(refusal([](auto& c) { c.banks = 3; }),
              "banks: found 3, expected a power of two from 1 to 1024");
    EXPECT_EQ(refusal([](auto& c) { c.row_bytes = 32; }),
              "row_bytes: found 32, expected a power of two from 64 to 1048576");
    EXPECT_EQ(refusal([](auto& c) { c.burst_bytes = 512; }),
              "burst_bytes: found 512, expected a power of two from 1 to 256");
    EXPECT_EQ(refusal([](auto& c) { c.channel_bytes = 32; }),
              "channel_bytes: found 32, expected a power of two from 64 to 256");
    EXPECT_EQ(refusal([](auto& c) { c.channels = 4'000'000'000; }),
              "channels: found 4000000000, expected at most 1048576 banks in all channels and ranks");
}

}  // namespace
}  // namespace regather::cachesim
