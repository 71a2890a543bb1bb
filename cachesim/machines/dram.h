// cachesim/machines/dram.h -- main memory behind the last cache: bursts, row buffers, energy. The open-page
// model of the data sheets: each bank keeps the row that it used last in its row buffer. A burst to that row
// is a row hit; to a bank without an open row it activates one (row empty); to any other row it precharges
// first (row conflict). Requests are served in the order in which they come; nothing is timed, reordered or
// refreshed.
//
// Energy [pJ]: activations x (activate + precharge) + bursts x (read or write), the increments over standby
// of Micron TN-40-07, "Calculating Memory Power for DDR4 SDRAM". Background and refresh power need time and
// are left out. docs/machines.md has the address mapping and the limits.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "cachesim/cache.h"

namespace regather::cachesim {

/// How a bank is chosen when rows collide.
enum class BankHash : std::uint8_t {
    none,
    xor_row,  ///< bank ^ low bits of the row: permutation-based interleaving (Zhang, Zhu, Zhang, MICRO 2000).
};
inline constexpr std::array<std::string_view, 2> bank_hash_names{"none", "xor-row"};

/// An address, from its low end: byte in the burst, bursts in channel_bytes, channel, the rest of the row,
/// bank, rank, row. A count that is no power of two divides; the others are bit fields.
struct DramConfig {
    std::uint32_t channels = 1;
    std::uint32_t ranks = 1;   ///< Of a channel.
    std::uint32_t banks = 16;  ///< Of a rank. Power of two.
    std::uint32_t row_bytes =
        8192;  ///< Of one row of one bank, all devices of the rank. Power of two from 64.
    std::uint32_t burst_bytes = 64;    ///< Power of two, at most row_bytes.
    std::uint32_t channel_bytes = 64;  ///< Before the next channel's turn. Power of two, burst to row.
    BankHash bank_hash = BankHash::none;
    std::uint32_t activate_pj = 0;  ///< [pJ] of one activation and its precharge.
    std::uint32_t read_pj = 0;      ///< [pJ] of one burst.
    std::uint32_t write_pj = 0;     ///< [pJ] of one burst.
};

inline constexpr std::uint64_t max_dram_banks = 1u << 20;  ///< Of all channels and ranks.

/// Throws trace::UsageError: "FIELD: found X, expected Y".
void check(const DramConfig& config);

struct DramStats {
    std::uint64_t bursts_read = 0, bursts_written = 0;
    std::uint64_t row_hits = 0, row_empty = 0, row_conflicts = 0;  ///< Their sum is that of the bursts.
    friend bool operator==(const DramStats&, const DramStats&) = default;
    DramStats& operator+=(const DramStats& other);
    DramStats& operator-=(const DramStats& earlier);  ///< Of the same memory, and no later.
};

/// [pJ]
std::uint64_t picojoules(const DramConfig& config, const DramStats& stats);

class Dram {
public:
    explicit Dram(const DramConfig& config);  ///< check()s it. No row is open.

    /// All bursts that hold a byte of [address, address + bytes), in ascending order.
    void access(std::uint64_t address, std::uint64_t bytes, Access kind, trace::Region region);

    const DramConfig& config() const { return config_; }
    const DramStats& stats(trace::Region region) const { return stats_[static_cast<std::size_t>(region)]; }
    DramStats total() const;
    std::uint64_t picojoules(const DramStats& stats) const { return cachesim::picojoules(config_, stats); }

    struct Place {
        std::uint64_t channel, rank, bank, row;
        friend bool operator==(const Place&, const Place&) = default;
    };
    Place place(std::uint64_t address) const;  ///< Where a byte lies.

private:
    static constexpr std::uint64_t no_row = ~std::uint64_t{0};

    /// A count of channels or ranks to divide by: a shift if it is a power of two.
    struct Divisor {
        std::uint64_t count;
        int shift;  // -1: none
        explicit Divisor(std::uint64_t n);
        std::uint64_t quotient(std::uint64_t x) const { return shift < 0 ? x / count : x >> shift; }
        std::uint64_t remainder(std::uint64_t x) const { return shift < 0 ? x % count : x & (count - 1); }
    };

    DramConfig config_;
    Divisor channels_, ranks_;
    int burst_shift_, channel_shift_, row_shift_, bank_shift_;
    std::vector<std::uint64_t>
        open_rows_;  // by bank, banks of a rank side by side, then ranks, then channels
    std::array<DramStats, trace::region_count> stats_{};
};

}  // namespace regather::cachesim
