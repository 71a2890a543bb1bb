#include "meshes/notes.h"

#include <fmt/format.h>

#include <algorithm>

namespace regather::meshes {

namespace {

constexpr std::size_t most_kinds = 24;

}  // namespace

void Notes::add(std::string_view kind, std::uint64_t times) {
    if (times == 0) return;
    const auto found =
        std::find_if(kinds_.begin(), kinds_.end(), [&](const auto& one) { return one.first == kind; });
    if (found != kinds_.end())
        found->second += times;
    else if (kinds_.size() < most_kinds)
        kinds_.emplace_back(kind, times);
    else
        others_ += times;
}

std::vector<std::string> Notes::lines() const {
    std::vector<std::string> lines;
    for (const auto& [kind, times] : kinds_) lines.push_back(fmt::format("{}: {}", kind, times));
    if (others_ > 0) lines.push_back(fmt::format("others of further kinds are not read: {}", others_));
    return lines;
}

}  // namespace regather::meshes
