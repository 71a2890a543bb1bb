#include "trace/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::trace {

FolderLock::FolderLock(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!error) folder_ = Descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (error || folder_.number() < 0)
        throw std::runtime_error(fmt::format("{}: cannot create the folder: {}",
                                             shown(folder.string(), most_shown_path),
                                             error ? error.message() : std::strerror(errno)));
    if (::flock(folder_.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        throw UsageError(
            fmt::format("{}: another process is writing into this folder; wait for it, or choose another",
                        shown(folder.string(), most_shown_path)));
}

}  // namespace regather::trace
