#include "imports/archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <utility>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {

using trace::DataError;

namespace {

// What is wrong, by libzip's codes.
std::string_view damage_of(int code) {
    switch (code) {
        case ZIP_ER_MULTIDISK:
            return "one part of an archive of several";
        case ZIP_ER_SEEK:
        case ZIP_ER_READ:
            return "bytes that cannot be read";
        case ZIP_ER_CRC:
            return "bytes whose checksum is another one";
        case ZIP_ER_OPEN:
            return "a file that cannot be opened";
        case ZIP_ER_ZLIB:
        case ZIP_ER_COMPRESSED_DATA:
            return "compressed bytes that are damaged";
        case ZIP_ER_MEMORY:
            return "more than fits into memory";
        case ZIP_ER_COMPNOTSUPP:
            return "a way of compression that is not known";
        case ZIP_ER_EOF:
            return "the end too early";
        case ZIP_ER_NOZIP:
            return "no directory of entries";
        case ZIP_ER_INCONS:
            return "a directory that contradicts itself";
        case ZIP_ER_ENCRNOTSUPP:
        case ZIP_ER_NOPASSWD:
        case ZIP_ER_WRONGPASSWD:
            return "an encrypted entry";
        default:
            return "damage";
    }
}

[[noreturn]] void refuse_archive(const std::string& name, int code) {
    throw DataError(fmt::format("{}: found no sound zip archive ({}), expected one", name, damage_of(code)));
}

struct CloseFile {
    void operator()(zip_file_t* file) const { ::zip_fclose(file); }
};

}  // namespace

struct Zip::State {
    std::vector<std::uint8_t> bytes;  // of an archive in memory: libzip reads them in place
    zip_t* archive = nullptr;
    std::uint64_t read = 0;  // bytes of entries, all together

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (archive) ::zip_discard(archive);
    }
};

Zip::Zip(std::unique_ptr<State> state, std::string name) : state_(std::move(state)), name_(std::move(name)) {
    const auto count = static_cast<std::uint64_t>(::zip_get_num_entries(state_->archive, 0));
    if (count > most_zip_entries)
        throw DataError(
            fmt::format("{}: found {} entries, expected at most {}", name_, count, most_zip_entries));
    names_.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        const char* entry = ::zip_get_name(state_->archive, i, 0);
        names_.emplace_back(entry ? entry : "");
    }
}

Zip::Zip(Zip&&) noexcept = default;
Zip& Zip::operator=(Zip&&) noexcept = default;
Zip::~Zip() = default;

Zip Zip::open(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw DataError(fmt::format("{}: found no file, expected a zip archive", name));
    auto state = std::make_unique<State>();
    int code = 0;
    state->archive = ::zip_open(name.c_str(), ZIP_RDONLY, &code);
    if (!state->archive) refuse_archive(name, code);
    return Zip(std::move(state), name);
}

Zip Zip::from_bytes(std::vector<std::uint8_t> bytes, std::string name) {
    auto state = std::make_unique<State>();
    state->bytes = std::move(bytes);
    zip_error_t reason;
    ::zip_error_init(&reason);
    zip_source_t* source = ::zip_source_buffer_create(state->bytes.data(), state->bytes.size(), 0, &reason);
    if (source) state->archive = ::zip_open_from_source(source, ZIP_RDONLY, &reason);
    if (!state->archive) {
        const int code = ::zip_error_code_zip(&reason);
        if (source) ::zip_source_free(source);
        ::zip_error_fini(&reason);
        refuse_archive(name, code);
    }
    ::zip_error_fini(&reason);
    return Zip(std::move(state), std::move(name));
}

bool Zip::has(std::string_view name) const {
    return ::zip_name_locate(state_->archive, std::string(name).c_str(), 0) >= 0;
}

std::vector<std::uint8_t> Zip::read(std::string_view name, std::uint64_t most_bytes) const {
    return bytes_of(name, most_bytes, true);
}

std::vector<std::uint8_t> Zip::read_start(std::string_view name, std::uint64_t bytes) const {
    return bytes_of(name, bytes, false);
}

std::vector<std::uint8_t> Zip::bytes_of(std::string_view name, std::uint64_t most_bytes, bool whole) const {
    const std::string entry(name);
    const auto fail = [&](std::string_view found, std::string_view expected) {
        throw DataError(
            fmt::format("{}: {}: found {}, expected {}", name_, trace::shown(name, 200), found, expected));
    };
    const std::int64_t index = ::zip_name_locate(state_->archive, entry.c_str(), 0);
    if (index < 0) fail("no such entry", "one of that name in the archive");
    zip_stat_t stat;
    ::zip_stat_init(&stat);
    if (::zip_stat_index(state_->archive, static_cast<zip_uint64_t>(index), 0, &stat) != 0 ||
        !(stat.valid & ZIP_STAT_SIZE))
        fail("a damaged entry", "a whole one");
    const auto too_large = [&](std::string_view bytes) {
        fail(fmt::format("{} bytes", bytes), fmt::format("at most {}", most_bytes));
    };
    if (whole && stat.size > most_bytes) too_large(fmt::format("{}", stat.size));

    const std::unique_ptr<zip_file_t, CloseFile> file(
        ::zip_fopen_index(state_->archive, static_cast<zip_uint64_t>(index), 0));
    if (!file)
        fail(fmt::format("an unreadable entry ({})",
                         damage_of(::zip_error_code_zip(::zip_get_error(state_->archive)))),
             "a sound one");
    // The declared size is only believed as the bytes arrive.
    constexpr std::uint64_t step = 1 << 20;
    const std::uint64_t most_read = whole ? most_bytes + 1 : most_bytes;
    std::vector<std::uint8_t> bytes;
    while (bytes.size() < most_read) {
        const std::size_t before = bytes.size();
        bytes.resize(before + std::min(step, most_read - before));
        const std::int64_t got = ::zip_fread(file.get(), bytes.data() + before, bytes.size() - before);
        if (got < 0)
            fail(fmt::format("damaged data ({})",
                             damage_of(::zip_error_code_zip(::zip_file_get_error(file.get())))),
                 "a sound entry");
        bytes.resize(before + static_cast<std::size_t>(got));
        state_->read += static_cast<std::uint64_t>(got);
        if (state_->read > most_zip_bytes)
            fail(fmt::format("{} bytes with the entries before", state_->read),
                 fmt::format("at most {}", most_zip_bytes));
        if (got == 0) break;
    }
    if (whole && bytes.size() > most_bytes) too_large(fmt::format("more than {}", most_bytes));
    if (whole && bytes.size() != stat.size)
        fail(fmt::format("{} bytes", bytes.size()), fmt::format("the {} it declares", stat.size));
    return bytes;
}

}  // namespace regather::imports
