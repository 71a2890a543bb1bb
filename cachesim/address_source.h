// cachesim/address_source.h -- one format of address traces, as AddressTrace reads it; how its files are
// opened and its records refused.
#pragma once
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/address_trace.h"

namespace regather::cachesim {

class AddressTrace::Source {
public:
    virtual ~Source() = default;
    virtual std::span<const ByteAccess> next() = 0;
    virtual Position position() const = 0;
    virtual std::vector<std::string> notes() const { return {}; }
};

inline constexpr std::size_t batch_records = 1 << 14;

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using SourceFile = std::unique_ptr<std::FILE, FileCloser>;

/// Throws trace::DataError.
SourceFile open_source_file(const std::filesystem::path& name);

/// Throws trace::DataError: "FILE: UNIT NUMBER: found X, expected Y".
[[noreturn]] void refuse(const std::filesystem::path& name, std::string_view unit, std::uint64_t number,
                         const std::string& found, const std::string& expected);

}  // namespace regather::cachesim
