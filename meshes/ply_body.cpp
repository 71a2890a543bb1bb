#include "meshes/ply_body.h"

#include <fmt/format.h>

#include <bit>

#include "meshes/number.h"
#include "trace/text.h"

namespace regather::meshes {

namespace {

bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace

PlyBody::PlyBody(std::string_view bytes, const PlyHeader& header)
    : bytes_(bytes),
      form_(header.form),
      at_(header.body),
      last_at_(header.body),
      body_line_(header.body_line),
      body_(header.body) {}

std::string_view PlyBody::word() {
    while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
    last_at_ = at_;
    while (at_ < bytes_.size() && !is_space(bytes_[at_])) ++at_;
    return last_ = bytes_.substr(last_at_, at_ - last_at_);
}

std::optional<double> PlyBody::next(const PlyType& type) {
    if (form_ == PlyForm::ascii) return real_number(word());
    last_at_ = at_;
    last_ = bytes_.substr(at_, type.bytes);
    if (last_.size() < type.bytes) {
        last_ = {};
        return std::nullopt;
    }
    at_ += type.bytes;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.bytes; ++i) {
        const std::size_t shift = form_ == PlyForm::big_endian ? type.bytes - 1 - i : i;
        bits |= std::uint64_t{static_cast<unsigned char>(last_[i])} << (8 * shift);
    }
    if (type.kind == PlyType::real)
        return type.bytes == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                               : std::bit_cast<double>(bits);
    const std::uint64_t sign = std::uint64_t{1} << (8 * type.bytes - 1);
    const auto value = static_cast<double>(bits);
    return type.kind == PlyType::whole_signed && (bits & sign) != 0 ? value - 2 * static_cast<double>(sign)
                                                                    : value;
}

bool PlyBody::skip(const PlyType& type) {
    if (form_ == PlyForm::ascii) return !word().empty();
    last_at_ = at_;
    last_ = {};
    if (bytes_.size() - at_ < type.bytes) return false;
    at_ += type.bytes;
    return true;
}

// In ASCII a value is a character at least, and a blank parts it from the next.
bool PlyBody::may_hold(std::uint64_t values, const PlyType& type) const {
    const std::uint64_t bytes = bytes_.size() - at_;
    return values <= (form_ == PlyForm::ascii ? (bytes + 1) / 2 : bytes / type.bytes);
}

std::string PlyBody::place() const {
    if (form_ != PlyForm::ascii) return fmt::format("byte {}", last_at_ + 1);
    std::uint64_t line = body_line_;
    for (std::size_t i = body_; i < last_at_; ++i)
        line += bytes_[i] == '\n' || (bytes_[i] == '\r' && bytes_.substr(i, 2) != "\r\n");
    return fmt::format("line {}", line);
}

std::string PlyBody::found() const {
    if (last_.empty()) return "the end of the file";
    return form_ == PlyForm::ascii ? trace::in_quotes(last_) : "a value";
}

}  // namespace regather::meshes
