#include "trace/free_memory.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace regather::trace {

namespace {

/// The file's text; none where there is no such file.
std::string text_of(const char* path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return std::move(text).str();
}

/// The number at the beginning of a text, after blanks.
std::optional<std::uint64_t> number_in(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() ? std::optional(number) : std::nullopt;
}

}  // namespace

std::uint64_t free_memory_in(std::string_view meminfo, std::string_view limit) {
    constexpr std::string_view name = "MemAvailable:";
    const std::size_t at = meminfo.find(name);
    std::optional<std::uint64_t> available;
    if (at != std::string_view::npos) available = number_in(meminfo.substr(at + name.size()));
    if (available) *available *= 1024;
    const std::optional<std::uint64_t> most = number_in(limit);
    if (available && most) return std::min(*available, *most);
    return available ? *available : most.value_or(0);
}

std::uint64_t free_memory() {
    return free_memory_in(text_of("/proc/meminfo"), text_of("/sys/fs/cgroup/memory.max"));
}

}  // namespace regather::trace
