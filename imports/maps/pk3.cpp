#include "imports/maps/pk3.h"

#include <fmt/format.h>

#include "trace/text.h"

namespace regather::imports {

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

Pk3Archives::Pk3Archives(std::span<const std::filesystem::path> files) {
    for (const auto& file : files) {
        const Zip& zip = zips_.emplace_back(Zip::open(file));
        for (const std::string& name : zip.names()) entries_[lower_case(name)] = {zips_.size() - 1, name};
    }
}

std::vector<std::string> Pk3Archives::names(std::string_view folder, std::string_view ending) const {
    std::vector<std::string> result;
    for (const auto& [name, entry] : entries_)
        if (name.size() > folder.size() + ending.size() && name.starts_with(folder) && name.ends_with(ending))
            result.push_back(name);
    return result;
}

std::vector<std::uint8_t> Pk3Archives::read(const std::string& name, std::uint64_t most_bytes) const {
    const Entry& entry = entries_.at(name);
    return zips_[entry.zip].read(entry.name, most_bytes);
}

std::string Pk3Archives::place(const std::string& name) const {
    const Entry& entry = entries_.at(name);
    return fmt::format("{}: {}", zips_[entry.zip].archive(), trace::shown(entry.name, 200));
}

std::string Pk3Archives::archive(const std::string& name) const {
    return std::filesystem::path(zips_[entries_.at(name).zip].archive()).filename().string();
}

}  // namespace regather::imports
