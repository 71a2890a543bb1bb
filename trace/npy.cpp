#include "trace/npy.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>
#include <utility>

#include "trace/digest.h"
#include "trace/text.h"

namespace regather::trace {

static_assert(std::endian::native == std::endian::little, "columns are mapped as they are");

namespace {

constexpr std::size_t header_bytes = 256;  // of our own files; readers take any length
constexpr std::string_view magic{"\x93NUMPY\x01\x00", 8};

std::string header_text(const ColumnType& type, std::uint64_t rows) {
    const std::string shape = type.inner_shape.empty() ? fmt::format("({},)", rows)
                                                       : fmt::format("({}, {})", rows, type.inner_shape);
    return fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}", type.descr, shape);
}

std::string header_block(const ColumnType& type, std::uint64_t rows) {
    std::string block(magic);
    const std::size_t text_bytes = header_bytes - magic.size() - 2;
    block.push_back(static_cast<char>(text_bytes & 0xff));
    block.push_back(static_cast<char>(text_bytes >> 8));
    block += header_text(type, rows);
    block.resize(header_bytes - 1, ' ');
    block.push_back('\n');
    return block;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& found,
                         const std::string& expected) {
    throw DataError(
        fmt::format("{}: found {}, expected {}", shown(path.string(), most_shown_path), found, expected));
}

/// The value of a key in the header's dictionary, as text without blanks; empty when the key is missing.
std::string value_of(std::string_view header, std::string_view key) {
    const std::size_t at = header.find(fmt::format("'{}'", key));
    if (at == std::string_view::npos) return {};
    std::size_t i = header.find(':', at);
    if (i == std::string_view::npos) return {};
    std::string value;
    int depth = 0;
    for (++i; i < header.size(); ++i) {
        const char c = header[i];
        if (c == '(' || c == '[') ++depth;
        if (c == ')' || c == ']') --depth;
        if ((c == ',' && depth == 0) || (c == '}' && depth <= 0)) break;
        if (c != ' ') value.push_back(c);
    }
    return value;
}

std::string without_blanks(std::string text) {
    std::erase(text, ' ');
    return text;
}

}  // namespace

template <>
const ColumnType& column_type<std::int8_t>() {
    static const ColumnType type{"'|i1'", "", 1, "int8"};
    return type;
}
template <>
const ColumnType& column_type<std::int16_t>() {
    static const ColumnType type{"'<i2'", "", 2, "int16"};
    return type;
}
template <>
const ColumnType& column_type<std::int32_t>() {
    static const ColumnType type{"'<i4'", "", 4, "int32"};
    return type;
}
template <>
const ColumnType& column_type<std::int64_t>() {
    static const ColumnType type{"'<i8'", "", 8, "int64"};
    return type;
}
template <>
const ColumnType& column_type<std::uint16_t>() {
    static const ColumnType type{"'<u2'", "", 2, "uint16"};
    return type;
}
template <>
const ColumnType& column_type<std::uint8_t>() {
    static const ColumnType type{"'|u1'", "", 1, "uint8"};
    return type;
}
template <>
const ColumnType& column_type<std::uint32_t>() {
    static const ColumnType type{"'<u4'", "", 4, "uint32"};
    return type;
}
template <>
const ColumnType& column_type<std::uint64_t>() {
    static const ColumnType type{"'<u8'", "", 8, "uint64"};
    return type;
}
template <>
const ColumnType& column_type<float>() {
    static const ColumnType type{"'<f4'", "", 4, "float32"};
    return type;
}
template <>
const ColumnType& column_type<Vec3>() {
    static const ColumnType type{"'<f4'", "3", 12, "float32 x 3"};
    return type;
}
template <>
const ColumnType& column_type<Photon>() {
    static const ColumnType type{
        "[('position', '<f4', (3,)), ('power', '|u1', (4,)), ('theta', '|u1'), ('phi', '|u1'), ('flags', "
        "'<u2')]",
        "", 20, "20-byte photon record"};
    return type;
}

struct ColumnWriter::State {
    std::filesystem::path path;
    ColumnType type;
    std::FILE* file = nullptr;
    Digest hash;
    std::uint64_t bytes = 0;

    State(std::filesystem::path p, const ColumnType& t) : path(std::move(p)), type(t) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (file) std::fclose(file);
    }
    void write(const void* data, std::size_t size) {
        if (std::fwrite(data, 1, size, file) != size)
            throw std::runtime_error(
                fmt::format("{}: cannot write: {}", path.string(), std::strerror(errno)));
    }
};

ColumnWriter::ColumnWriter(std::filesystem::path path, const ColumnType& type)
    : state_(std::make_unique<State>(std::move(path), type)) {
    state_->file = std::fopen(state_->path.c_str(), "wb");
    if (!state_->file)
        throw std::runtime_error(
            fmt::format("{}: cannot create: {}", state_->path.string(), std::strerror(errno)));
    std::setvbuf(state_->file, nullptr, _IOFBF, 1 << 20);
    const std::string block = header_block(type, 0);
    state_->write(block.data(), block.size());
}
ColumnWriter::~ColumnWriter() = default;
ColumnWriter::ColumnWriter(ColumnWriter&&) noexcept = default;

void ColumnWriter::append_bytes(std::span<const std::byte> bytes) {
    state_->write(bytes.data(), bytes.size());
    state_->hash.add_bytes(bytes);
    state_->bytes += bytes.size();
}

ColumnDigest ColumnWriter::finish(OnDisk on_disk) {
    State& s = *state_;
    const ColumnDigest digest{s.bytes / s.type.row_bytes, s.hash.value()};
    const std::string block = header_block(s.type, digest.rows);
    if (std::fseek(s.file, 0, SEEK_SET) != 0)
        throw std::runtime_error(fmt::format("{}: cannot write: {}", s.path.string(), std::strerror(errno)));
    s.write(block.data(), block.size());
    if (on_disk == OnDisk::before_return && (std::fflush(s.file) != 0 || ::fsync(::fileno(s.file)) != 0))
        throw std::runtime_error(fmt::format("{}: cannot write: {}", s.path.string(), std::strerror(errno)));
    std::FILE* file = std::exchange(s.file, nullptr);
    if (std::fclose(file) != 0)
        throw std::runtime_error(fmt::format("{}: cannot write: {}", s.path.string(), std::strerror(errno)));
    return digest;
}

MappedColumn::MappedColumn(const std::filesystem::path& path, const ColumnType& one,
                           const ColumnType& other) {
    const ColumnType* const both[] = {&one, &other};
    const bool same = one.descr == other.descr;
    const std::string readable = same ? one.readable : fmt::format("{} or {}", one.readable, other.readable);
    std::size_t first = 0;
    *this = MappedColumn(path, std::span(both).first(same ? 1 : 2), readable,
                         same ? fmt::format("{} ({}, little-endian)", one.descr, readable)
                              : fmt::format("{} or {} ({}, little-endian)", one.descr, other.descr, readable),
                         first);
}

MappedColumn::MappedColumn(const std::filesystem::path& path, std::span<const ColumnType* const> types,
                           std::string_view readable, std::string_view expected, std::size_t& which) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe must not hold us up
    if (fd < 0) refuse(path, std::strerror(errno), fmt::format("a .npy column of {}", readable));
    struct stat info {};
    if (::fstat(fd, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size < 10) {
        ::close(fd);
        refuse(path, fmt::format("{} bytes", info.st_size), "a .npy file");
    }
    map_bytes_ = static_cast<std::size_t>(info.st_size);
    map_ = ::mmap(nullptr, map_bytes_, PROT_READ, MAP_SHARED, fd, 0);
    ::close(fd);
    if (map_ == MAP_FAILED) {
        map_ = nullptr;
        refuse(path, fmt::format("a file that cannot be mapped ({})", std::strerror(errno)), "a .npy file");
    }
    const char* bytes = static_cast<const char*>(map_);
    try {
        if (std::string_view(bytes, 6) != magic.substr(0, 6)) refuse(path, "no NumPy magic", "a .npy file");
        const int major = static_cast<unsigned char>(bytes[6]);
        if (major < 1 || major > 3) refuse(path, fmt::format(".npy version {}", major), "version 1 to 3");
        const std::size_t prefix = major == 1 ? 10 : 12;
        std::size_t text_bytes = 0;
        for (std::size_t i = prefix; i-- > 8;)
            text_bytes = text_bytes << 8 | static_cast<unsigned char>(bytes[i]);
        if (prefix + text_bytes > map_bytes_) refuse(path, "a header that ends early", "a whole .npy header");
        const std::string_view header(bytes + prefix, text_bytes);

        const std::string descr = value_of(header, "descr");
        const auto place_of = [&](const std::string& found) {
            std::size_t place = 0;
            while (place < types.size() && without_blanks(types[place]->descr) != found) ++place;
            return place;
        };
        which = place_of(descr);
        const bool signed_64 = which == types.size() && descr == column_type<std::int64_t>().descr;
        if (signed_64) which = place_of(column_type<std::uint64_t>().descr);
        if (which == types.size()) {
            std::string turned = descr;
            for (char& c : turned)
                if (c == '>') c = '<';
            const bool foreign = turned != descr && place_of(turned) != types.size();
            refuse(path, fmt::format("{}type {}", foreign ? "big-endian " : "", shown(descr)),
                   std::string(expected));
        }
        const ColumnType& type = *types[which];
        row_bytes_ = type.row_bytes;
        if (value_of(header, "fortran_order") != "False") refuse(path, "Fortran order", "C order");
        const std::string shape = value_of(header, "shape");
        const char* first = shape.data() + 1;
        const char* last = shape.data() + shape.size();
        const auto [end, error] = shape.empty() ? std::from_chars_result{nullptr, std::errc::invalid_argument}
                                                : std::from_chars(first, last, rows_);
        const std::string tail = error == std::errc{} ? std::string(end, last) : "";
        const std::string expected_tail =
            type.inner_shape.empty() ? ",)" : fmt::format(",{})", type.inner_shape);
        if (error != std::errc{} || tail != expected_tail)
            refuse(path, fmt::format("shape {}", shown(shape)),
                   type.inner_shape.empty() ? "shape (rows,)"
                                            : fmt::format("shape (rows, {})", type.inner_shape));
        const std::size_t body = map_bytes_ - prefix - text_bytes;
        if (rows_ > body / type.row_bytes || rows_ * type.row_bytes != body)
            refuse(path, fmt::format("{} bytes of rows", body),
                   fmt::format("{} rows x {} bytes", rows_, type.row_bytes));
        data_ = reinterpret_cast<const std::byte*>(bytes) + prefix + text_bytes;
        if ((prefix + text_bytes) % alignof(std::uint64_t) != 0) {
            copy_.resize((body + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t));
            std::memcpy(copy_.data(), data_, body);
            data_ = reinterpret_cast<const std::byte*>(copy_.data());
        }
        if (signed_64)
            for (std::uint64_t row = 0; row < rows_; ++row)
                if (const auto value = rows<std::int64_t>()[row]; value < 0)
                    refuse(path, fmt::format("{} in row {}", value, row), "no negative value");
    } catch (...) {
        ::munmap(map_, map_bytes_);
        throw;
    }
}

MappedColumn::~MappedColumn() {
    if (map_) ::munmap(map_, map_bytes_);
}
MappedColumn::MappedColumn(MappedColumn&& other) noexcept {
    *this = std::move(other);
}
MappedColumn& MappedColumn::operator=(MappedColumn&& other) noexcept {
    std::swap(map_, other.map_);
    std::swap(map_bytes_, other.map_bytes_);
    std::swap(copy_, other.copy_);
    std::swap(data_, other.data_);
    std::swap(rows_, other.rows_);
    std::swap(row_bytes_, other.row_bytes_);
    return *this;
}

std::uint64_t MappedColumn::checksum() const {
    Digest digest;
    digest.add_bytes({static_cast<const std::byte*>(data_), rows_ * row_bytes_});
    return digest.value();
}

IntegerColumn::IntegerColumn(const std::filesystem::path& path)
    : column_([&] {
          const ColumnType* const types[] = {&column_type<std::int8_t>(),   &column_type<std::int16_t>(),
                                             &column_type<std::int32_t>(),  &column_type<std::int64_t>(),
                                             &column_type<std::uint8_t>(),  &column_type<std::uint16_t>(),
                                             &column_type<std::uint32_t>(), &column_type<std::uint64_t>()};
          return MappedColumn(path, types, "whole numbers",
                              "whole numbers (int8 to int64 or uint8 to uint64, little-endian)", type_);
      }()) {}

void MappedColumn::expect_random_access() const {
    ::madvise(map_, map_bytes_, MADV_RANDOM);
}

}  // namespace regather::trace
