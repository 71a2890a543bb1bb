// meshes/text_lines.h -- the lines of OBJ and MTL files (Wavefront, "Object Files (.obj)", appendices B1 and
// B2): a keyword and what follows. Lines end with LF, CR LF or CR; one that ends with a backslash goes on in
// the next; '#' opens a comment.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace regather::meshes {

class TextLines {
public:
    /// A byte order mark of UTF-8 is passed over. `file` is for messages. Throws trace::DataError for a NUL
    /// character.
    TextLines(std::string_view bytes, std::string_view file);

    /// Moves on to the next line that has a keyword; false at the end.
    bool next();

    std::string_view keyword() const { return keyword_; }  ///< In lower case, at most 32 bytes.
    /// What follows the keyword and is not yet read, without blanks around it. In lines that end with a name
    /// (usemtl, newmtl, mtllib, g, o, and the maps of a library), '#' belongs to it.
    std::string_view rest() const;
    std::string_view word();  ///< The next of its words; "" at its end.
    std::uint64_t number() const {
        return number_;
    }  ///< Of the line, from 1; of several joined ones the first's.

    /// Throws trace::DataError "FILE: line N: found X, expected Y".
    [[noreturn]] void fail(std::string_view found, std::string_view expected) const;

private:
    std::string_view physical_line();

    std::string_view left_, file_;
    std::string_view line_;
    std::string joined_, keyword_;
    std::uint64_t number_ = 0, lines_ = 0;
};

}  // namespace regather::meshes
