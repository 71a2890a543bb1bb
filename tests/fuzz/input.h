// tests/fuzz/input.h -- what every fuzz target does with an input: read it, or refuse it in one line.
#pragma once
#include <stdlib.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "trace/error.h"

namespace regather::fuzz {

/// Runs `read`, which may throw DataError or UsageError of one printable line. Any other exception ends the
/// program, and so is a finding.
template <class Read>
int read_or_refuse(Read&& read) {
    const auto check = [](std::string_view message) {
        if (message.empty()) std::fprintf(stderr, "refused without a word\n"), std::abort();
        for (const char letter : message)
            if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f)
                std::fprintf(stderr, "more than one printable line: %s\n", std::string(message).c_str()),
                    std::abort();
    };
    try {
        read();
    } catch (const trace::DataError& error) {
        check(error.what());
    } catch (const trace::UsageError& error) {
        check(error.what());
    }
    return 0;
}

/// For readers of files: a file with these bytes, in a folder that only this process uses; written over by
/// the next input and left behind when the process ends.
inline std::filesystem::path file_of(const std::uint8_t* data, std::size_t size, const std::string& name) {
    static const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("regather-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const std::filesystem::path path = folder / name;
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    return path;
}

}  // namespace regather::fuzz
