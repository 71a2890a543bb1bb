// trace/file.h -- whole files: read at once, up to a limit, and written so that nobody ever sees half of one.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace regather::trace {

inline constexpr std::uint64_t most_file_bytes = std::uint64_t{1} << 30;

/// All bytes of a regular file. Throws DataError "FILE: found X, expected a file" for one that is missing, a
/// folder, a device or a pipe, or cannot be read, "... expected a file of at most N bytes" for one that is
/// larger.
std::string read_file(const std::filesystem::path& path, std::uint64_t most_bytes = most_file_bytes);

/// Afterwards the file has these bytes; after a crash or a full disk it is as it was, or absent. Written
/// beside `path` (its name + ".partial"), brought to the disk, renamed, and the folder brought to the disk.
/// Creates missing parent folders. Throws std::runtime_error that names the file (disk full, no permission, a
/// folder of this name, another process that is writing it) and leaves nothing of its own behind.
void write_whole(const std::filesystem::path& path, std::string_view bytes);

/// Throws UsageError "FILE: exists; --force overwrites it" for the first of `files` that is there, unless
/// `force`: to be called before the work whose result they are to hold.
void refuse_to_overwrite(std::span<const std::filesystem::path> files, bool force);

/// Brings a folder's list of names to the disk: after a rename in it. Folders that cannot be are passed over.
void sync_folder(const std::filesystem::path& folder);

}  // namespace regather::trace
