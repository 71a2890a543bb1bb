// trace/range.h -- refuses a parameter that is out of range.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "trace/error.h"

namespace regather::trace {

/// Throws UsageError that names owner, parameter, value and range.
inline void require_range(std::string_view owner, std::string_view parameter, std::uint64_t value,
                          std::uint64_t min, std::uint64_t max) {
    if (value < min || value > max)
        throw UsageError(fmt::format("{}: {} is {}, expected {} to {}", owner, parameter, value, min, max));
}

}  // namespace regather::trace
