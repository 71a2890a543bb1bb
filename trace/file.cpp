#include "trace/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "trace/descriptor.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::trace {

namespace {

/// The file of this name, created if needed, which no other process is writing.
template <class Fail>
Descriptor locked(const std::filesystem::path& path, const Fail& fail) {
    while (true) {
        Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
        if (file.number() < 0) fail(std::strerror(errno));
        // A file system without locks has none that could be held.
        if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            fail("another process is writing it");
        // Its writer may have renamed it between the two calls: then the name is another file's, or nobody's.
        struct stat opened {
        }, named{};
        if (::fstat(file.number(), &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
            opened.st_ino == named.st_ino && opened.st_dev == named.st_dev)
            return file;
    }
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::uint64_t most_bytes) {
    const auto refuse = [&](const std::string& found, const std::string& expected = "a file") {
        return DataError(
            fmt::format("{}: found {}, expected {}", shown(path.string(), most_shown_path), found, expected));
    };
    const auto too_large = [&](const std::string& found) {
        return refuse(found, fmt::format("a file of at most {} bytes", most_bytes));
    };
    const auto reason = [] { return fmt::format("what cannot be read ({})", std::strerror(errno)); };
    // Without O_NONBLOCK a pipe would wait for its writer.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) throw refuse(errno == ENOENT ? "no such file" : reason());
    struct stat info {};
    if (::fstat(file.number(), &info) != 0) throw refuse(reason());
    if (S_ISDIR(info.st_mode)) throw refuse("a folder");
    if (!S_ISREG(info.st_mode)) throw refuse("a device or a pipe");
    const auto size = static_cast<std::uint64_t>(info.st_size);
    if (size > most_bytes) throw too_large(fmt::format("{} bytes", size));
    // Files that grow are read to their end, and some file systems (/proc) say 0: one byte more tells.
    std::string bytes(size + 1, '\0');
    std::size_t filled = 0;
    while (true) {
        const ssize_t got = ::read(file.number(), bytes.data() + filled, bytes.size() - filled);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw refuse(reason());
        if (got == 0) break;
        filled += static_cast<std::size_t>(got);
        if (filled > most_bytes) throw too_large(fmt::format("more than {} bytes", most_bytes));
        if (filled == bytes.size()) bytes.resize(2 * bytes.size());
    }
    bytes.resize(filled);
    return bytes;
}

void write_whole(const std::filesystem::path& path, std::string_view bytes) {
    std::filesystem::path partial = path;
    partial += ".partial";
    bool ours = false;
    const auto fail = [&](const char* reason) {
        if (ours) ::unlink(partial.c_str());
        throw std::runtime_error(
            fmt::format("{}: cannot be written: {}", shown(path.string(), most_shown_path), reason));
    };
    if (path.has_parent_path()) {
        std::error_code error;
        std::filesystem::create_directories(path.parent_path(), error);
        if (error) fail(std::strerror(error.value()));
    }
    Descriptor file = locked(partial, fail);
    ours = true;
    if (::ftruncate(file.number(), 0) != 0) fail(std::strerror(errno));
    while (!bytes.empty()) {
        const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(std::strerror(errno));
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (::fsync(file.number()) != 0 || ::rename(partial.c_str(), path.c_str()) != 0)
        fail(std::strerror(errno));
    sync_folder(path.parent_path());
}

void refuse_to_overwrite(std::span<const std::filesystem::path> files, bool force) {
    if (force) return;
    for (const std::filesystem::path& file : files) {
        std::error_code error;
        if (std::filesystem::exists(std::filesystem::symlink_status(file, error)))
            throw UsageError(
                fmt::format("{}: exists; --force overwrites it", shown(file.string(), most_shown_path)));
    }
}

void sync_folder(const std::filesystem::path& folder) {
    const Descriptor opened(
        ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.number() >= 0) ::fsync(opened.number());
}

}  // namespace regather::trace
