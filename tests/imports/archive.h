// tests/imports/archive.h -- small zip archives, made by hand or with libzip.
#pragma once
#include <gtest/gtest.h>
#include <zip.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "trace/error.h"
#include "trace/file.h"

namespace regather::imports {

using Entries = std::vector<std::pair<std::string, std::string>>;

inline void write_zip(const std::filesystem::path& file, const Entries& entries) {
    int code = 0;
    zip_t* archive = ::zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    if (!archive) throw std::runtime_error("zip_open");
    for (const auto& [name, content] : entries) {
        zip_source_t* source = ::zip_source_buffer(archive, content.data(), content.size(), 0);
        if (::zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) < 0)
            throw std::runtime_error("zip_file_add");
    }
    if (::zip_close(archive) != 0) throw std::runtime_error("zip_close");
}

inline std::vector<std::uint8_t> bytes_of(const std::filesystem::path& file) {
    const std::string text = trace::read_file(file);
    return {text.begin(), text.end()};
}

/// The message of the DataError that `call` throws; "" when it throws none.
template <class Call>
std::string data_error(Call call) {
    try {
        call();
    } catch (const trace::DataError& error) {
        return error.what();
    }
    return "";
}

/// A file of a Debian package that need not be there.
#define REQUIRE_FILE_OF(package, file) \
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: package " package " is not installed"

}  // namespace regather::imports
