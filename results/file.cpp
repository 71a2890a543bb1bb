#include "results/file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "trace/error.h"

namespace regather::results {
namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

}  // namespace

std::string read_file(const std::filesystem::path& path) {
    const auto refuse = [&] {
        return trace::DataError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    };
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file) throw refuse();
    std::string bytes;
    char block[1 << 16];
    while (const std::size_t got = std::fread(block, 1, sizeof block, file.get())) bytes.append(block, got);
    if (std::ferror(file.get())) throw refuse();  // a folder opens, but does not read
    return bytes;
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    std::filesystem::path part = path;
    part += ".part";
    const auto fail = [&] {
        const int reason = errno;
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw std::runtime_error(
            fmt::format("{}: cannot be written: {}", path.string(), std::strerror(reason)));
    };
    if (std::error_code error; path.has_parent_path()) {
        std::filesystem::create_directories(path.parent_path(), error);
        if (error) {
            errno = error.value();
            fail();
        }
    }
    File file(std::fopen(part.c_str(), "wb"));
    if (!file) fail();
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) fail();
    if (std::fclose(file.release()) != 0) fail();
    if (std::rename(part.c_str(), path.c_str()) != 0) fail();
}

}  // namespace regather::results
