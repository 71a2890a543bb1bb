// trace/file.h -- whole files: read at once, written so that nobody ever sees half of one.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace regather::trace {

/// All bytes of a file. Throws DataError that names it.
std::string read_file(const std::filesystem::path& path);

/// Writes beside `path` (its name + ".partial"), to the disk, and renames: after a crash `path` is the
/// previous file or none. Creates missing parent folders. Throws std::runtime_error that names the file (disk
/// full, no permission).
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace regather::trace
