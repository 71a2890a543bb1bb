// imports/furniture/furniture_catalogue.h -- a furniture catalogue of Sweet Home 3D (.sh3f): a zip of models,
// with a Java properties file that tells who made them.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "imports/archive.h"

namespace regather::imports {

class FurnitureCatalogue {
public:
    /// Throws trace::DataError when the archive is damaged or has no catalogue.
    explicit FurnitureCatalogue(const std::filesystem::path& file);

    const Zip& zip() const { return zip_; }
    bool has(std::string_view model) const { return zip_.has(model); }
    std::string value(std::string_view key) const;           ///< "" when it is not there.
    std::string creator_of(const std::string& model) const;  ///< Of an entry without the leading slash.

private:
    Zip zip_;
    std::map<std::string, std::string, std::less<>> values_;
};

/// Keys and values of a Java properties file: Latin-1 with \uXXXX escapes in, UTF-8 out. Lines that go on in
/// the next are not joined.
std::map<std::string, std::string, std::less<>> read_properties(std::string_view text);

}  // namespace regather::imports
