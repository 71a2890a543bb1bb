// meshes/ply_body.h -- the values of a PLY file's body, one after the other.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "meshes/ply_header.h"

namespace regather::meshes {

class PlyBody {
public:
    /// `bytes`: the whole file.
    PlyBody(std::string_view bytes, const PlyHeader& header);

    /// The next value; none when it is cut, or no number.
    std::optional<double> next(const PlyType& type);
    /// Passes over the next value, which need not be a number in ASCII; false at the end.
    bool skip(const PlyType& type);

    /// Whether so many values of the type may still be there, by the bytes that are left.
    bool may_hold(std::uint64_t values, const PlyType& type) const;
    std::string_view left() const { return bytes_.substr(at_); }

    std::string place() const;  ///< Of the last value: "line 12" or "byte 345", from 1.
    std::string found() const;  ///< The last value's word in quotes, or "the end of the file".

private:
    std::string_view word();

    std::string_view bytes_, last_;
    PlyForm form_;
    std::size_t at_, last_at_;
    std::uint64_t body_line_;
    std::size_t body_;
};

}  // namespace regather::meshes
