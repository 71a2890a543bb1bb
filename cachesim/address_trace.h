// cachesim/address_trace.h -- the address trace that a user brings, read as a stream of batches: memory does
// not grow with the number of records. Two formats, told apart by the first bytes of the file:
//   .npy: a column of uint64 (or int64, none negative) byte addresses; beside it, if given, a column of sizes
//   [bytes] (uint8, uint32 or uint64) and
//         one of writes (uint8 or bool; 0 read, 1 write). Without them every record reads 1 byte.
//   din:  the traditional format of Dinero III and IV (Edler, Hill), as text: a label and a hexadecimal
//   address a line. As
//         in Dinero IV a record is the aligned 4-byte word that holds the address, and the rest of a line is
//         passed over (notes() says so). Lines end with LF, CR LF or CR; blank ones are passed over, too.
// docs/cachesim.md has both with examples.
#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/lines.h"

namespace regather::cachesim {

struct AddressFiles {
    std::filesystem::path addresses{};
    std::filesystem::path sizes{}, writes{};  ///< Empty: none. Only beside a .npy.
};

inline constexpr std::uint64_t max_access_bytes = std::uint64_t{1} << 30;  ///< Of one record.

/// The constructor and next() throw trace::DataError with the file, what was found and what was expected,
/// and, for a bad record, its number: the line (from 1) of a din file, the row (from 0, as NumPy counts) of a
/// column. No records at all are bad data, too. trace::UsageError: columns beside a din file.
class AddressTrace {
public:
    explicit AddressTrace(const AddressFiles& files);
    ~AddressTrace();
    AddressTrace(AddressTrace&&) noexcept;
    AddressTrace& operator=(AddressTrace&&) noexcept;

    /// The next records, valid until the next call; empty at the end.
    std::span<const ByteAccess> next();
    struct Position {
        std::uint64_t done = 0, total = 0;  ///< total 0: unknown (a pipe).
        std::string_view unit;              ///< What they count: records of columns, bytes of din text.
    };
    Position position() const;
    /// What next() has passed over so far, for the user to know: one line each, none if all was read.
    std::vector<std::string> notes() const;

    class Source;  ///< One for each format.
private:
    std::unique_ptr<Source> source_;
};

}  // namespace regather::cachesim
