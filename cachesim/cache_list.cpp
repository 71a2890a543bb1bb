#include "cachesim/cache_list.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <set>

#include "trace/error.h"
#include "trace/size.h"
#include "trace/text.h"

namespace regather::cachesim {

std::vector<std::string_view> list_parts(std::string_view list, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t next; (next = list.find(separator)) != list.npos; list.remove_prefix(next + 1))
        parts.push_back(list.substr(0, next));
    parts.push_back(list);
    return parts;
}

std::uint32_t parse_line_bytes(std::string_view text) {
    const std::uint64_t bytes = trace::parse_size(text);
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        throw trace::UsageError(fmt::format("line: found '{}', expected less than 4G", trace::shown(text)));
    return static_cast<std::uint32_t>(bytes);
}

std::uint32_t parse_ways(std::string_view text) {
    if (text == "full") return fully_associative;
    std::uint32_t ways = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, ways);
    if (error != std::errc{} || end != last || ways == 0)
        throw trace::UsageError(fmt::format("ways: found '{}', expected a whole number from 1 to {}, or full",
                                            trace::shown(text), std::numeric_limits<std::uint32_t>::max()));
    return ways;
}

std::vector<CacheConfig> multiplied_out(std::string_view sizes, std::string_view lines,
                                        std::string_view ways) {
    std::vector<CacheConfig> caches;
    for (const std::string_view size : list_parts(sizes))
        for (const std::string_view line : list_parts(lines))
            for (const std::string_view way : list_parts(ways))
                caches.push_back({trace::parse_size(size), parse_line_bytes(line), parse_ways(way)});
    return caches;
}

std::vector<CacheConfig> parse_caches(std::string_view text) {
    const std::vector<std::string_view> fields = list_parts(text, ':');
    if (fields.size() != 3)
        throw trace::UsageError(
            fmt::format("cache: found '{}', expected SIZE:LINE:WAYS as in 128K:128:8, 16K:64:full or "
                        "16K,32K:128:1,2,4",
                        trace::shown(text)));
    try {
        std::vector<CacheConfig> caches = multiplied_out(fields[0], fields[1], fields[2]);
        for (const CacheConfig& cache : caches) check(cache);
        return caches;
    } catch (const trace::UsageError& error) {
        throw trace::UsageError(fmt::format("cache {}: {}", trace::shown(text), error.what()));
    }
}

std::vector<CacheConfig> parse_caches(std::span<const std::string> texts) {
    std::vector<CacheConfig> caches;
    std::set<std::string> seen;
    for (const std::string& text : texts)
        for (const CacheConfig& cache : parse_caches(std::string_view(text))) {
            if (!seen.insert(cache_text(cache)).second)
                throw trace::UsageError(fmt::format("cache {}: found {} twice, expected each cache once",
                                                    trace::shown(text), cache_text(cache)));
            caches.push_back(cache);
        }
    return caches;
}

std::string ways_text(std::uint32_t ways) {
    return ways == fully_associative ? "full" : std::to_string(ways);
}

std::string cache_text(const CacheConfig& cache) {
    return fmt::format("{}:{}:{}", cache.size_bytes, cache.line_bytes, ways_text(cache.ways));
}

}  // namespace regather::cachesim
