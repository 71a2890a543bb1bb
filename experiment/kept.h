// experiment/kept.h -- what a run keeps for the next one: a file that says what it was made for and whether
// it is whole.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace regather::experiment {

/// The bytes kept for this key; nothing when the file is missing, of another key, or damaged. Then it is to
/// be made (again). A key is one line.
std::optional<std::string> read_kept(const std::filesystem::path& path, std::string_view key);

/// Whole or not at all. Throws as trace::write_whole().
void write_kept(const std::filesystem::path& path, std::string_view key, std::string_view bytes);

}  // namespace regather::experiment
