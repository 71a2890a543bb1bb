// imports/furniture/furniture_catalogue.h -- a furniture catalogue of Sweet Home 3D (.sh3f): a zip of models,
// with a Java properties file that tells who made them.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "imports/archive.h"
#include "imports/left_out.h"

namespace regather::imports {

class FurnitureCatalogue {
public:
    /// Throws trace::DataError when the archive is damaged or has no catalogue.
    explicit FurnitureCatalogue(const std::filesystem::path& file);

    const Zip& zip() const { return zip_; }
    bool has(std::string_view model) const { return zip_.has(model); }
    std::string value(std::string_view key) const;           ///< "" when it is not there.
    std::string creator_of(const std::string& model) const;  ///< Of an entry without the leading slash.

    std::size_t models() const;  ///< How many it describes.
    /// Keys that are not used: "category#" stands for those of all pieces.
    void count_left_out(LeftOut& left_out) const;

private:
    Zip zip_;
    std::map<std::string, std::string, std::less<>> values_;
};

/// Keys and values of a Java properties file (Java SE, Properties.load): Latin-1 with \uXXXX escapes in,
/// UTF-8 on one line out; the last of equal keys counts. `file` names it in the DataError for an escape
/// without four digits.
std::map<std::string, std::string, std::less<>> read_properties(std::string_view text, std::string_view file);

}  // namespace regather::imports
