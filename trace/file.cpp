#include "trace/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "trace/error.h"

namespace regather::trace {

std::string read_file(const std::filesystem::path& path) {
    const auto refuse = [&] {
        return DataError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    };
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) throw refuse();
    std::string bytes;
    char block[1 << 16];
    while (const std::size_t got = std::fread(block, 1, sizeof block, file.get())) bytes.append(block, got);
    if (std::ferror(file.get())) throw refuse();  // a folder opens, but does not read
    return bytes;
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    std::filesystem::path partial = path;
    partial += ".partial";
    int file = -1;
    const auto fail = [&] {
        const int reason = errno;
        if (file >= 0) ::close(file);
        ::unlink(partial.c_str());
        throw std::runtime_error(
            fmt::format("{}: cannot be written: {}", path.string(), std::strerror(reason)));
    };
    if (path.has_parent_path()) {
        std::error_code error;
        std::filesystem::create_directories(path.parent_path(), error);
        if (error) {
            errno = error.value();
            fail();
        }
    }
    file = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) fail();
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail();
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (::fsync(file) != 0) fail();
    const int closed = ::close(file);
    file = -1;
    if (closed != 0 || ::rename(partial.c_str(), path.c_str()) != 0) fail();
}

}  // namespace regather::trace
