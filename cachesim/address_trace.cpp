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

#include "cachesim/din_source.h"
#include "trace/error.h"
#include "trace/npy.h"
#include "trace/text.h"

namespace regather::cachesim {

namespace {

using std::filesystem::path;

constexpr std::string_view npy_magic = "\x93NUMPY";

std::string first_bytes(const path& name, std::size_t count) {
    const SourceFile file = open_source_file(name);
    std::string bytes(count, '\0');
    bytes.resize(std::fread(bytes.data(), 1, count, file.get()));
    if (std::ferror(file.get()))
        throw trace::DataError(fmt::format("{}: cannot read: {}", name.string(), std::strerror(errno)));
    return bytes;
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
        for (const trace::ColumnType* type : types)  // MappedColumn takes int64 for it
            if (type == &trace::column_type<std::uint64_t>() && head.find("'<i8'") != std::string::npos)
                return *type;
        if (types.size() == 1 || !head.starts_with(npy_magic)) return *types.front();
        std::string readable;
        for (const trace::ColumnType* type : types)
            readable += (readable.empty() ? "" : " or ") + type->readable;
        const std::size_t at = head.find("'descr':");
        const std::size_t from = at == std::string::npos ? head.size() : std::min(at + 9, head.size());
        throw trace::DataError(
            fmt::format("{}: found type {}, expected {}, little-endian", name.string(),
                        trace::shown(head.substr(from, head.find_first_of(",}", from) - from)), readable));
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

std::unique_ptr<AddressTrace::Source> open_source(const AddressFiles& files) {
    if (files.addresses.extension() == ".npy") return std::make_unique<ColumnSource>(files);
    auto din = std::make_unique<DinSource>(files.addresses);  // opened once: it may be a pipe
    if (din->starts_with(npy_magic)) return std::make_unique<ColumnSource>(files);
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

std::vector<std::string> AddressTrace::notes() const {
    return source_->notes();
}

}  // namespace regather::cachesim
