// cachesim/cache_list.h -- caches as people write them: "128K:128:8", or lists that are multiplied out,
// "16K,32K:128:1,2,full". The one parser of command lines and experiment files.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/cache.h"

namespace regather::cachesim {

/// "16K,32K" -> "16K", "32K". Never empty; a part may be.
std::vector<std::string_view> list_parts(std::string_view list, char separator = ',');

/// Bytes below 4G. Throws trace::UsageError.
std::uint32_t parse_line_bytes(std::string_view text);
/// 1 up, or "full". Throws trace::UsageError.
std::uint32_t parse_ways(std::string_view text);

/// Every size with every line and number of ways, sizes outermost; none is checked for being possible. Throws
/// trace::UsageError for what is no size, line or ways.
std::vector<CacheConfig> multiplied_out(std::string_view sizes, std::string_view lines,
                                        std::string_view ways);

/// All of SIZE:LINE:WAYS. Throws trace::UsageError for one that is not possible.
std::vector<CacheConfig> parse_caches(std::string_view text);
/// Of several texts, one after the other. Throws for a cache that is there twice, too.
std::vector<CacheConfig> parse_caches(std::span<const std::string> texts);

std::string ways_text(std::uint32_t ways);         ///< "8" or "full"
std::string cache_text(const CacheConfig& cache);  ///< "131072:128:8"

}  // namespace regather::cachesim
