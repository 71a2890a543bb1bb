#include "experiment/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::experiment {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

}  // namespace

std::vector<std::uint32_t> parse_frames(const std::string& text, std::uint32_t count) {
    if (count == 0)
        throw trace::UsageError(fmt::format("frames: found '{}', expected none: the scene has no camera path",
                                            trace::shown(text)));
    const auto refuse = [&] {
        throw trace::UsageError(
            fmt::format("frames: found '{}', expected frames of 0 to {}: A, or A,B,C, or FROM:BELOW[:STEP]",
                        trace::shown(text), count - 1));
    };
    const auto number = [&](std::string_view digits, std::uint32_t most) {
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size() || value > most)
            refuse();
        return value;
    };
    std::vector<std::uint32_t> frames;
    for (const std::string_view part : split(text, ',')) {
        const std::vector<std::string_view> range = split(part, ':');
        if (range.size() > 3) refuse();
        const std::uint32_t first = number(range[0], count - 1);
        const std::uint32_t end = range.size() > 1 ? number(range[1], count) : first + 1;
        const std::uint32_t step = range.size() > 2 ? number(range[2], count) : 1;
        if (step == 0 || end <= first) refuse();
        for (std::uint32_t frame = first; frame < end; frame += step) frames.push_back(frame);
    }
    if (std::set<std::uint32_t>(frames.begin(), frames.end()).size() != frames.size()) refuse();
    return frames;
}

std::filesystem::path frame_folder(const std::filesystem::path& folder, std::uint32_t frame) {
    return folder / fmt::format("frame-{:04}", frame);
}

}  // namespace regather::experiment
