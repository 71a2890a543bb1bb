// imports/maps/pk3.h -- the .pk3 archives of a game as one: zip files whose entries replace each other.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "imports/archive.h"

namespace regather::imports {

/// ASCII letters only.
std::string lower_case(std::string_view text);

/// Where archives have an entry of the same name, the last archive counts, as in the game. Names in lower
/// case. All refusals are a trace::DataError.
class Pk3Archives {
public:
    explicit Pk3Archives(std::span<const std::filesystem::path> files);

    /// Sorted, those that begin with `folder` and end with `ending`.
    std::vector<std::string> names(std::string_view folder, std::string_view ending) const;
    bool has(const std::string& name) const { return entries_.contains(name); }
    std::vector<std::uint8_t> read(const std::string& name, std::uint64_t most_bytes) const;
    std::string place(const std::string& name) const;    ///< "archive: entry" of an entry, for errors.
    std::string archive(const std::string& name) const;  ///< The file name of its archive.

private:
    struct Entry {
        std::size_t zip = 0;
        std::string name;
    };
    std::vector<Zip> zips_;
    std::map<std::string, Entry> entries_;
};

}  // namespace regather::imports
