// trace/size.h -- sizes as people write them.
#pragma once
#include <cstdint>
#include <string_view>

namespace regather::trace {

/// Bytes from "4096", "16K", "1M" or "2G" (powers of 1024, either case). Throws UsageError for all
/// else.
std::uint64_t parse_size(std::string_view text);

}  // namespace regather::trace
