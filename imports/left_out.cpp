#include "imports/left_out.h"

#include <fmt/format.h>

#include <charconv>

#include "trace/text.h"

namespace regather::imports {

namespace {

constexpr std::size_t most_names = 60, most_kept = 10'000, most_bytes = 40, most_notes = 24;

}  // namespace

void LeftOut::add(std::string_view kind, std::string_view name, std::uint64_t count) {
    auto& names = kinds_[std::string(kind)];
    const std::string shown = trace::shown(name, most_bytes);
    const auto known = names.find(shown);
    if (known != names.end())
        known->second += count;
    else
        names[names.size() < most_kept ? shown : "other names"] += count;
}

void LeftOut::add_note_of_model(std::string_view note) {
    std::uint64_t count = 1;
    if (const std::size_t colon = note.rfind(": "); colon != std::string_view::npos) {
        const std::string_view digits = note.substr(colon + 2);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
        if (error == std::errc{} && end == digits.data() + digits.size())
            note = note.substr(0, colon);
        else
            count = 1;
    }
    const bool is_kept = notes_.contains(note) || notes_.size() < most_notes;
    OfModels& of_models = notes_[is_kept ? std::string(note) : "other notes"];
    of_models.count += count;
    ++of_models.models;
}

std::vector<std::string> LeftOut::lines() const {
    std::vector<std::string> lines;
    for (const auto& [kind, names] : kinds_) {
        std::string line = fmt::format("left out {}:", kind);
        std::size_t number = 0;
        for (const auto& [name, count] : names) {
            if (number == most_names) break;
            line += fmt::format("{} {} {}", number++ == 0 ? "" : ",", name,
                                count == 1 ? "(once)" : fmt::format("({} times)", count));
        }
        if (names.size() > most_names) line += fmt::format(", and {} names more", names.size() - most_names);
        lines.push_back(std::move(line));
    }
    for (const auto& [what, times] : notes_)
        lines.push_back(fmt::format("models: {}: {}, in {} model{}", what, times.count, times.models,
                                    times.models == 1 ? "" : "s"));
    return lines;
}

}  // namespace regather::imports
