// tests/capture/counts.h -- what a capture has counted, by name.
#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "trace/json.h"

namespace regather::capture {

inline std::uint64_t count(const trace::Json& counts, std::string_view name) {
    const trace::Json* const found = counts.find(name);
    if (!found || !found->whole()) throw std::runtime_error("no such count: " + std::string(name));
    return *found->whole();
}

}  // namespace regather::capture
