#include "cachesim/din_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::cachesim {

namespace {

constexpr std::size_t buffer_bytes = 1 << 20;

bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

/// The value of a hexadecimal digit, or 16.
unsigned digit(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? static_cast<unsigned>(lower - 'a') + 10 : 16;
}

std::string_view without_blanks(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

}  // namespace

SourceFile open_source_file(const std::filesystem::path& name) {
    const auto refuse = [&](std::string_view found) {
        throw trace::DataError(fmt::format("{}: found {}, expected a file: an address trace (.npy or din)",
                                           trace::shown(name.string(), trace::most_shown_path), found));
    };
    SourceFile file(std::fopen(name.c_str(), "rb"));
    if (!file) refuse(std::strerror(errno));
    std::error_code error;
    if (std::filesystem::is_directory(name, error)) refuse("a folder");
    return file;
}

void refuse(const std::filesystem::path& name, std::string_view unit, std::uint64_t number,
            const std::string& found, const std::string& expected) {
    throw trace::DataError(
        fmt::format("{}: {} {}: found {}, expected {}", name.string(), unit, number, found, expected));
}

DinSource::DinSource(const std::filesystem::path& name)
    : name_(name), file_(open_source_file(name)), buffer_(buffer_bytes) {
    batch_.reserve(batch_records);
    std::error_code no_file;
    if (std::filesystem::is_regular_file(name, no_file)) bytes_ = std::filesystem::file_size(name, no_file);
    refill();
}

std::span<const ByteAccess> DinSource::next() {
    batch_.clear();
    std::string_view line;
    while (batch_.size() < batch_records && next_line(line))
        if (!without_blanks(line).empty()) batch_.push_back(record(line));
    records_ += batch_.size();
    if (records_ == 0)
        refuse(name_, "line", std::max<std::uint64_t>(line_, 1), line_ == 0 ? "0 bytes" : "blank lines only",
               "a label and an address");
    return batch_;
}

AddressTrace::Position DinSource::position() const {
    return {std::min(read_ - (end_ - begin_), bytes_), bytes_, "B"};
}

std::vector<std::string> DinSource::notes() const {
    if (lines_with_rest_ == 0) return {};
    return {fmt::format("{}: line {}: {} behind the address is not read{}", name_.string(), first_rest_line_,
                        trace::in_quotes(first_rest_),
                        lines_with_rest_ == 1
                            ? std::string()
                            : fmt::format(", nor what {} other line{} there", lines_with_rest_ - 1,
                                          lines_with_rest_ == 2 ? " has" : "s have"))};
}

/// The next line without its end; false at the end of the file. Of a line longer than the buffer, whose end
/// can only be a comment, the first part.
bool DinSource::next_line(std::string_view& line) {
    if (begin_ == end_) refill();
    if (after_return_ && begin_ != end_ && buffer_[begin_] == '\n') ++begin_;
    after_return_ = false;
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
    after_return_ = end && *end == '\r';
    if (!end) skip_comment();
    return true;
}

const char* DinSource::find_end() const {
    const char* const first = buffer_.data() + begin_;
    const char* const last = buffer_.data() + end_;
    const char* const end = std::find_if(first, last, [](char c) { return c == '\n' || c == '\r'; });
    return end == last ? nullptr : end;
}

/// Moves the unread bytes to the front and reads on behind them.
void DinSource::refill() {
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
void DinSource::skip_comment() {
    int c = std::fgetc(file_.get());
    while (c != EOF && c != '\n' && c != '\r') c = std::fgetc(file_.get());
    after_return_ = c == '\r';
}

ByteAccess DinSource::record(std::string_view line) {
    std::size_t at = 0;
    const std::uint64_t label = number(line, at, "label");
    const std::uint64_t address = number(line, at, "address");
    if (label > 2)
        refuse(name_, "line", line_, fmt::format("label {:x}", label),
               "0 (read), 1 (write) or 2 (instruction)");
    if (const std::string_view rest = without_blanks(line.substr(at));
        !rest.empty() && ++lines_with_rest_ == 1) {
        first_rest_ = rest.substr(0, 200);
        first_rest_line_ = line_;
    }
    return {address & ~std::uint64_t{3}, 4, label == 1 ? Access::write : Access::read};
}

/// A hexadecimal number with or without 0x, behind blanks, up to a blank or the end of the line.
std::uint64_t DinSource::number(std::string_view line, std::size_t& at, std::string_view what) const {
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
                   : fmt::format("{} {}", what, trace::in_quotes(line.substr(first, at - first), 32)),
               "a label and a hexadecimal address of at most 64 bits");
    }
    return value;
}

}  // namespace regather::cachesim
