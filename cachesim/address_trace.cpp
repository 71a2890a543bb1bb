#include "cachesim/address_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trace/error.h"
#include "trace/npy.h"

namespace regather::cachesim {

class AddressTrace::Source {
public:
    virtual ~Source() = default;
    virtual std::span<const ByteAccess> next() = 0;
    virtual Position position() const = 0;
};

namespace {

using std::filesystem::path;

constexpr std::size_t batch_records = 1 << 14;
constexpr std::size_t buffer_bytes = 1 << 20;
constexpr std::string_view npy_magic = "\x93NUMPY";

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

File open(const path& name, std::string_view expected) {
    File file(std::fopen(name.c_str(), "rb"));
    if (!file)
        throw trace::DataError(
            fmt::format("{}: found {}, expected {}", name.string(), std::strerror(errno), expected));
    return file;
}

std::string first_bytes(const path& name, std::size_t count) {
    const File file = open(name, "an address trace (.npy or din)");
    std::string bytes(count, '\0');
    bytes.resize(std::fread(bytes.data(), 1, count, file.get()));
    if (std::ferror(file.get()))
        throw trace::DataError(fmt::format("{}: cannot read: {}", name.string(), std::strerror(errno)));
    return bytes;
}

[[noreturn]] void refuse(const path& name, std::string_view unit, std::uint64_t number,
                         const std::string& found, const std::string& expected) {
    throw trace::DataError(
        fmt::format("{}: {} {}: found {}, expected {}", name.string(), unit, number, found, expected));
}

// ---- .npy
// ----------------------------------------------------------------------------------------------------------

const trace::ColumnType& bool_column() {
    static const trace::ColumnType type{"'|b1'", "", 1, "bool"};
    return type;
}

/// A column of integers of one of several types, read as 64-bit values whatever the alignment of the file.
class IntegerColumn {
public:
    IntegerColumn(const path& name, std::span<const trace::ColumnType* const> types)
        : name_(name), width_(type_of(name, types).row_bytes), column_(name, type_of(name, types)) {}

    const path& name() const { return name_; }
    std::uint64_t size() const { return column_.size(); }
    std::uint64_t operator[](std::uint64_t row) const {
        std::uint64_t value = 0;
        std::memcpy(&value, column_.rows<std::byte>().data() + row * width_, width_);
        return value;
    }

private:
    /// The type that the header states, if it is among `types`; else MappedColumn is to refuse the file.
    static const trace::ColumnType& type_of(const path& name,
                                            std::span<const trace::ColumnType* const> types) {
        const std::string head = first_bytes(name, 4096);
        for (const trace::ColumnType* type : types)
            if (head.find(type->descr) != std::string::npos) return *type;
        if (types.size() == 1 || !head.starts_with(npy_magic)) return *types.front();
        std::string readable;
        for (const trace::ColumnType* type : types)
            readable += (readable.empty() ? "" : " or ") + type->readable;
        const std::size_t at = head.find("'descr':");
        const std::size_t from = at == std::string::npos ? head.size() : std::min(at + 9, head.size());
        throw trace::DataError(fmt::format("{}: found type {}, expected {}, little-endian", name.string(),
                                           head.substr(from, head.find_first_of(",}", from) - from),
                                           readable));
    }

    path name_;
    std::size_t width_;
    trace::MappedColumn column_;
};

class ColumnSource final : public AddressTrace::Source {
public:
    explicit ColumnSource(const AddressFiles& files)
        : addresses_(files.addresses, std::array{&trace::column_type<std::uint64_t>()}) {
        if (addresses_.size() == 0)
            throw trace::DataError(
                fmt::format("{}: found 0 records, expected at least 1", files.addresses.string()));
        if (!files.sizes.empty()) {
            sizes_.emplace(files.sizes, std::array{&trace::column_type<std::uint8_t>(),
                                                   &trace::column_type<std::uint32_t>(),
                                                   &trace::column_type<std::uint64_t>()});
            expect_same_rows(*sizes_);
        }
        if (!files.writes.empty()) {
            writes_.emplace(files.writes, std::array{&trace::column_type<std::uint8_t>(), &bool_column()});
            expect_same_rows(*writes_);
        }
        batch_.resize(batch_records);
    }

    std::span<const ByteAccess> next() override {
        const std::size_t count = std::min<std::uint64_t>(batch_.size(), addresses_.size() - row_);
        for (std::size_t i = 0; i < count; ++i) batch_[i] = record(row_ + i);
        row_ += count;
        return {batch_.data(), count};
    }
    AddressTrace::Position position() const override { return {row_, addresses_.size(), "records"}; }

private:
    void expect_same_rows(const IntegerColumn& column) const {
        if (column.size() != addresses_.size())
            throw trace::DataError(fmt::format("{}: found {} records, expected {} as in {}",
                                               column.name().string(), column.size(), addresses_.size(),
                                               addresses_.name().string()));
    }

    ByteAccess record(std::uint64_t row) const {
        ByteAccess access{addresses_[row], 1, Access::read};
        if (sizes_) {
            access.bytes = (*sizes_)[row];
            if (access.bytes == 0 || access.bytes > max_access_bytes)
                refuse(sizes_->name(), "record", row, fmt::format("a size of {} bytes", access.bytes),
                       fmt::format("1 to {}", max_access_bytes));
            if (access.address > std::numeric_limits<std::uint64_t>::max() - (access.bytes - 1))
                refuse(sizes_->name(), "record", row,
                       fmt::format("{} bytes from address {:#x} on", access.bytes, access.address),
                       "a last byte below 2^64");
        }
        if (writes_) {
            const std::uint64_t write = (*writes_)[row];
            if (write > 1)
                refuse(writes_->name(), "record", row, fmt::format("{}", write), "0 (read) or 1 (write)");
            if (write == 1) access.kind = Access::write;
        }
        return access;
    }

    IntegerColumn addresses_;
    std::optional<IntegerColumn> sizes_, writes_;
    std::uint64_t row_ = 0;
    std::vector<ByteAccess> batch_;
};

// ---- din
// -----------------------------------------------------------------------------------------------------------

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// The value of a hexadecimal digit, or 16.
unsigned digit(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? static_cast<unsigned>(lower - 'a') + 10 : 16;
}

class DinSource final : public AddressTrace::Source {
public:
    explicit DinSource(const path& name)
        : name_(name), file_(open(name, "an address trace (.npy or din)")), buffer_(buffer_bytes) {
        batch_.reserve(batch_records);
        std::error_code no_file;
        if (std::filesystem::is_regular_file(name, no_file))
            bytes_ = std::filesystem::file_size(name, no_file);
        refill();
    }

    bool is_npy() const { return std::string_view(buffer_.data(), end_).starts_with(npy_magic); }

    std::span<const ByteAccess> next() override {
        batch_.clear();
        std::string_view line;
        while (batch_.size() < batch_records && next_line(line)) batch_.push_back(record(line));
        if (line_ == 0)
            throw trace::DataError(
                fmt::format("{}: line 1: found 0 bytes, expected a label and an address", name_.string()));
        return batch_;
    }
    AddressTrace::Position position() const override {
        return {std::min(read_ - (end_ - begin_), bytes_), bytes_, "B"};
    }

private:
    /// The next line without its end; false at the end of the file. Of a line longer than the buffer, whose
    /// end can only be a comment, the first part.
    bool next_line(std::string_view& line) {
        const char* end = find_end();
        if (!end) {
            refill();
            end = find_end();
        }
        if (!end && begin_ == end_) return false;
        ++line_;
        const char* first = buffer_.data() + begin_;
        line = {first, end ? static_cast<std::size_t>(end - first) : end_ - begin_};
        begin_ = end ? begin_ + line.size() + 1 : end_;
        if (!end) skip_comment();
        return true;
    }

    const char* find_end() const {
        return begin_ == end_
                   ? nullptr
                   : static_cast<const char*>(std::memchr(buffer_.data() + begin_, '\n', end_ - begin_));
    }

    /// Moves the unread bytes to the front and reads on behind them.
    void refill() {
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        end_ -= begin_;
        begin_ = 0;
        const std::size_t got = std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
        end_ += got;
        read_ += got;
        if (std::ferror(file_.get()))
            throw trace::DataError(fmt::format("{}: cannot read: {}", name_.string(), std::strerror(errno)));
    }

    /// Reads over the rest of a line that filled the buffer, which keeps the part that `line` views.
    void skip_comment() {
        for (int c = std::fgetc(file_.get()); c != EOF && c != '\n';) c = std::fgetc(file_.get());
    }

    ByteAccess record(std::string_view line) const {
        std::size_t at = 0;
        const std::uint64_t label = number(line, at, "label");
        const std::uint64_t address = number(line, at, "address");
        if (label > 2)
            refuse(name_, "line", line_, fmt::format("label {:x}", label),
                   "0 (read), 1 (write) or 2 (instruction)");
        return {address & ~std::uint64_t{3}, 4, label == 1 ? Access::write : Access::read};
    }

    /// A hexadecimal number with or without 0x, behind blanks, up to a blank or the end of the line.
    std::uint64_t number(std::string_view line, std::size_t& at, std::string_view what) const {
        while (at < line.size() && is_blank(line[at])) ++at;
        const std::size_t first = at;
        if (line.substr(at).starts_with("0x") || line.substr(at).starts_with("0X")) at += 2;
        const std::size_t digits = at;
        std::uint64_t value = 0;
        bool fits = true;
        for (; at < line.size() && digit(line[at]) < 16; ++at) {
            fits = fits && value >> 60 == 0;
            value = value << 4 | digit(line[at]);
        }
        const bool ends = at == line.size() || is_blank(line[at]);
        if (at == digits || !ends || !fits) {
            while (at < line.size() && !is_blank(line[at])) ++at;
            refuse(name_, "line", line_,
                   first == line.size()
                       ? fmt::format("no {}", what)
                       : fmt::format("{} '{}'", what, printable(line.substr(first, at - first))),
                   "a label and a hexadecimal address of at most 64 bits");
        }
        return value;
    }

    static std::string printable(std::string_view text) {
        std::string shown;
        for (const char c : text.substr(0, 32)) shown += c >= ' ' && c <= '~' ? c : '.';
        return text.size() > 32 ? shown + "..." : shown;
    }

    path name_;
    File file_;
    std::vector<char> buffer_;
    std::size_t begin_ = 0, end_ = 0;     // of the unread bytes
    std::uint64_t read_ = 0, bytes_ = 0;  // into the buffer so far; in the file, 0 if unknown
    std::uint64_t line_ = 0;
    std::vector<ByteAccess> batch_;
};

std::unique_ptr<AddressTrace::Source> open_source(const AddressFiles& files) {
    if (files.addresses.extension() == ".npy") return std::make_unique<ColumnSource>(files);
    auto din = std::make_unique<DinSource>(files.addresses);  // opened once: it may be a pipe
    if (din->is_npy()) return std::make_unique<ColumnSource>(files);
    for (const path& column : {files.sizes, files.writes})
        if (!column.empty())
            throw trace::UsageError(
                fmt::format("{}: found beside {}, which is din text, expected a .npy of addresses",
                            column.string(), files.addresses.string()));
    return din;
}

}  // namespace

AddressTrace::AddressTrace(const AddressFiles& files) : source_(open_source(files)) {}
AddressTrace::~AddressTrace() = default;
AddressTrace::AddressTrace(AddressTrace&&) noexcept = default;
AddressTrace& AddressTrace::operator=(AddressTrace&&) noexcept = default;

std::span<const ByteAccess> AddressTrace::next() {
    return source_->next();
}

AddressTrace::Position AddressTrace::position() const {
    return source_->position();
}

}  // namespace regather::cachesim
