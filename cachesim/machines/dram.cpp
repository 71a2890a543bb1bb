#include "cachesim/machines/dram.h"

#include <fmt/format.h>

#include <bit>

#include "trace/error.h"

namespace regather::cachesim {

namespace {

void expect(bool holds, std::string_view field, std::uint64_t found, const std::string& expected) {
    if (!holds) throw trace::UsageError(fmt::format("{}: found {}, expected {}", field, found, expected));
}

constexpr std::uint32_t least_row_bytes = 64, most_row_bytes = 1u << 20;  // no row has the number of no_row

}  // namespace

void check(const DramConfig& c) {
    const auto power_from = [](std::uint32_t x, std::uint32_t low, std::uint32_t high) {
        return std::has_single_bit(x) && x >= low && x <= high;
    };
    const auto power_text = [](std::uint64_t low, std::uint64_t high) {
        return fmt::format("a power of two from {} to {}", low, high);
    };
    expect(c.channels >= 1, "channels", c.channels, "at least 1");
    expect(c.ranks >= 1, "ranks", c.ranks, "at least 1");
    expect(power_from(c.banks, 1, 1024), "banks", c.banks, power_text(1, 1024));
    expect(power_from(c.row_bytes, least_row_bytes, most_row_bytes), "row_bytes", c.row_bytes,
           power_text(least_row_bytes, most_row_bytes));
    expect(power_from(c.burst_bytes, 1, c.row_bytes), "burst_bytes", c.burst_bytes,
           power_text(1, c.row_bytes));
    expect(power_from(c.channel_bytes, c.burst_bytes, c.row_bytes), "channel_bytes", c.channel_bytes,
           power_text(c.burst_bytes, c.row_bytes));
    expect(std::uint64_t{c.channels} <= max_dram_banks / c.banks / c.ranks, "channels", c.channels,
           fmt::format("at most {} banks in all channels and ranks", max_dram_banks));
}

namespace {

constexpr std::uint64_t DramStats::*dram_counts[] = {&DramStats::bursts_read, &DramStats::bursts_written,
                                                     &DramStats::row_hits, &DramStats::row_empty,
                                                     &DramStats::row_conflicts};

}  // namespace

DramStats& DramStats::operator+=(const DramStats& other) {
    for (const auto count : dram_counts) this->*count += other.*count;
    return *this;
}

DramStats& DramStats::operator-=(const DramStats& earlier) {
    for (const auto count : dram_counts) this->*count -= earlier.*count;
    return *this;
}

namespace {

const DramConfig& checked(const DramConfig& config) {
    check(config);
    return config;
}

}  // namespace

Dram::Divisor::Divisor(std::uint64_t n)
    : count(n), shift(std::has_single_bit(n) ? std::countr_zero(n) : -1) {}

Dram::Dram(const DramConfig& config)
    : config_(checked(config)),
      channels_(config.channels),
      ranks_(config.ranks),
      burst_shift_(std::countr_zero(config.burst_bytes)),
      channel_shift_(std::countr_zero(config.channel_bytes)),
      row_shift_(std::countr_zero(config.row_bytes)),
      bank_shift_(std::countr_zero(config.banks)),
      open_rows_(std::size_t{config.channels} * config.ranks * config.banks, no_row) {}

Dram::Place Dram::place(std::uint64_t address) const {
    const std::uint64_t chunk = address >> channel_shift_, bank_mask = config_.banks - 1;
    Place place;
    place.channel = channels_.remainder(chunk);
    // The channel's own bytes, as if they lay one after the other.
    const std::uint64_t own =
        (channels_.quotient(chunk) << channel_shift_) | (address & (config_.channel_bytes - 1));
    const std::uint64_t piece = own >> row_shift_, rows = piece >> bank_shift_;
    place.bank = piece & bank_mask;
    place.rank = ranks_.remainder(rows);
    place.row = ranks_.quotient(rows);
    if (config_.bank_hash == BankHash::xor_row) place.bank ^= place.row & bank_mask;
    return place;
}

void Dram::access(std::uint64_t address, std::uint64_t bytes, Access kind, trace::Region region) {
    if (bytes == 0) return;
    DramStats& stats = stats_[static_cast<std::size_t>(region)];
    const std::uint64_t last = (address + (bytes - 1)) >> burst_shift_;
    for (std::uint64_t burst = address >> burst_shift_;; ++burst) {
        const Place at = place(burst << burst_shift_);
        std::uint64_t& open = open_rows_[(at.channel * config_.ranks + at.rank) * config_.banks + at.bank];
        ++(open == at.row ? stats.row_hits : open == no_row ? stats.row_empty : stats.row_conflicts);
        open = at.row;
        ++(kind == Access::read ? stats.bursts_read : stats.bursts_written);
        if (burst == last) return;
    }
}

DramStats Dram::total() const {
    DramStats sum;
    for (const DramStats& region : stats_) sum += region;
    return sum;
}

std::uint64_t picojoules(const DramConfig& config, const DramStats& stats) {
    return (stats.row_empty + stats.row_conflicts) * config.activate_pj + stats.bursts_read * config.read_pj +
           stats.bursts_written * config.write_pj;
}

}  // namespace regather::cachesim
