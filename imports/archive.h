// imports/archive.h -- zip archives (.zip, .jar, .sh3d, .sh3f, .pk3), read with libzip. Only what an entry
// really holds is kept in memory, and never more than the caller allows: an entry may declare any size.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace regather::imports {

/// More entries than this are refused, and more bytes of entries in all: an archive of a few bytes may
/// promise any number.
inline constexpr std::uint64_t most_zip_entries = 1'000'000;
inline constexpr std::uint64_t most_zip_bytes = std::uint64_t{4} << 30;

/// An open archive; not for two threads at once. Every refusal is a trace::DataError that names the archive
/// and, where there is one, the entry.
class Zip {
public:
    /// DataError when the file is missing or no zip archive.
    static Zip open(const std::filesystem::path& file);
    /// An archive in memory, e.g. an entry of another one; `name` stands for it in errors.
    static Zip from_bytes(std::vector<std::uint8_t> bytes, std::string name);

    Zip(Zip&&) noexcept;
    Zip& operator=(Zip&&) noexcept;
    ~Zip();

    const std::string& archive() const { return name_; }  ///< As it stands in errors.
    /// In the archive's order, folders (a trailing '/') included, UTF-8.
    const std::vector<std::string>& names() const { return names_; }
    bool has(std::string_view name) const;
    /// All bytes of an entry, checksum verified. DataError when it is missing, damaged, encrypted, or larger
    /// than `most_bytes`, whatever size it declares.
    std::vector<std::uint8_t> read(std::string_view name, std::uint64_t most_bytes) const;
    /// Its first `bytes` bytes, or fewer when it has no more; no checksum is verified.
    std::vector<std::uint8_t> read_start(std::string_view name, std::uint64_t bytes) const;

private:
    struct State;
    Zip(std::unique_ptr<State> state, std::string name);
    std::vector<std::uint8_t> bytes_of(std::string_view name, std::uint64_t most_bytes, bool whole) const;

    std::unique_ptr<State> state_;
    std::string name_;
    std::vector<std::string> names_;
};

}  // namespace regather::imports
