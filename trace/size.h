// trace/size.h -- sizes as people write and read them.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace regather::trace {

/// Bytes from "4096", "16K", "1M" or "2G" (powers of 1024, either case). Throws UsageError for all
/// else.
std::uint64_t parse_size(std::string_view text);

/// The shortest that parse_size() reads, up to M: "4000", "16K", "3M".
std::string size_text(std::uint64_t bytes);

/// A value divided by `base` while it is `from` or more, six times at most, and how often that was.
struct Scaled {
    double value;
    unsigned steps;
};
Scaled scaled_down(double value, double base, double from);

/// Of thousands: k, M, G, T, P, E by steps; empty for none.
inline constexpr std::string_view decimal_prefixes[] = {"", "k", "M", "G", "T", "P", "E"};

}  // namespace regather::trace
