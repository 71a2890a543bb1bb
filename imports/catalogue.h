// imports/catalogue.h -- the importers, in one table.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "imports/scene_file.h"

namespace regather::imports {

/// What is asked of an importer; which of it a kind takes, beside the files, stands in the table.
struct Request {
    std::vector<std::filesystem::path> files;
    std::string home, map;
    std::string up = "y";  ///< "x", "y" or "z".
    double size = 1;       ///< [m]
};

struct Importer {
    std::string_view kind, summary;
    std::vector<std::string_view> takes;    ///< "home", "map", "up", "size": of a Request.
    std::vector<std::string_view> endings;  ///< Of the names of its files: ".pk3".
    ImportedScene (*import)(const Request&);
};

/// The one table of importers. Each throws as its function in homes/, maps/, furniture/ and mesh.h, and
/// trace::UsageError for several files where one is due.
std::span<const Importer> catalogue();

/// Which kind reads files of such a name, its ending in letters of any case; "" for none.
std::string_view kind_of_file(const std::filesystem::path& file);

/// For people: name, counts, origin, licence, three lines.
std::string summary_of(const ImportedScene& scene);

}  // namespace regather::imports
