// trace/free_memory.h -- how much memory there is to be had.
#pragma once
#include <cstdint>
#include <string_view>

namespace regather::trace {

/// What Linux could give without swapping (MemAvailable), or what the container may have if that is less
/// (memory.max of cgroup v2) [bytes]; 0 where neither is told.
std::uint64_t free_memory();

/// Of the texts of /proc/meminfo and of memory.max; "max" or no text: not limited.
std::uint64_t free_memory_in(std::string_view meminfo, std::string_view limit);

}  // namespace regather::trace
