// cachesim/din_source.h -- Dinero's din text, line by line (address_trace.h). The file may be a pipe.
#pragma once
#include "cachesim/address_source.h"

namespace regather::cachesim {

class DinSource final : public AddressTrace::Source {
public:
    explicit DinSource(const std::filesystem::path& name);

    /// Of the file; before the first next().
    bool starts_with(std::string_view bytes) const {
        return std::string_view(buffer_.data(), end_).starts_with(bytes);
    }

    std::span<const ByteAccess> next() override;
    AddressTrace::Position position() const override;
    std::vector<std::string> notes() const override;

private:
    bool next_line(std::string_view& line);
    const char* find_end() const;
    void refill();
    void skip_comment();
    ByteAccess record(std::string_view line);
    std::uint64_t number(std::string_view line, std::size_t& at, std::string_view what) const;

    std::filesystem::path name_;
    SourceFile file_;
    std::vector<char> buffer_;
    std::size_t begin_ = 0, end_ = 0;     // of the unread bytes
    std::uint64_t read_ = 0, bytes_ = 0;  // into the buffer so far; in the file, 0 if unknown
    std::uint64_t line_ = 0, records_ = 0;
    bool after_return_ = false;  // the last line ended with CR: an LF that follows belongs to it
    std::string first_rest_;     // of the first line with something behind its address
    std::uint64_t first_rest_line_ = 0, lines_with_rest_ = 0;
    std::vector<ByteAccess> batch_;
};

}  // namespace regather::cachesim
