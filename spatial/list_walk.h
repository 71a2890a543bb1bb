// spatial/list_walk.h -- walks as lists of elements, for structures whose visits no tree's decisions give
// back. Four visits at a time: a byte with four lengths, then what each visit's element differs by from the
// one before (Dean, "Challenges in Building Large-Scale Information Retrieval Systems", 2009: group varint;
// lengths and shuffles after Lemire, Kurz & Rupp, "Stream VByte", 2018).
//
// Grammar. A search that visits nothing has a walk of no bytes. Any other walk:
//   the number of visits: seven bits a byte, the lowest first; the top bit of all bytes but the last is set;
//   for each four visits a byte of four codes, the first visit's in its lowest two bits; then the values of
//   the four, in 0, 1, 2 or 4 bytes (codes 0 to 3), the lowest byte first. Visits that the last four lack
//   have code 0 and no bytes.
// A value is s = element - (the element before) - 1, modulo 2^32 and signed, as 2 s or, below 0, -2 s - 1.
// The element before the first is 2^32 - 1. So a visit of the element behind the last one takes no byte.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "spatial/structure.h"

namespace regather::spatial {

/// Listens to a search and appends list walks to one byte buffer.
class ListWalkRecorder {
public:
    void visit(std::uint32_t element) {
        const std::uint32_t step = element - previous_ - 1, value = step << 1 ^ (0 - (step >> 31));
        previous_ = element;
        const std::uint32_t place = static_cast<std::uint32_t>(visits_ % 4);
        if (place == 0) {
            if (groups_.size() < used_ + 1 + 16) groups_.resize(2 * (used_ + 1 + 16));
            codes_ = used_;
            groups_[used_++] = 0;
        }
        const std::uint32_t code =
            (value > 0 ? 1u : 0u) + (value > 0xff ? 1u : 0u) + (value > 0xffff ? 1u : 0u);
        groups_[codes_] = static_cast<std::uint8_t>(groups_[codes_] | code << 2 * place);
        std::memcpy(groups_.data() + used_, &value, 4);
        used_ += code + (code == 3 ? 1 : 0);
        ++visits_;
    }
    /// Any bit, behind the list that the last finish() ended; a list of something.
    void push(bool bit) {
        byte_ = static_cast<std::uint8_t>(byte_ << 1 | static_cast<int>(bit));
        if (++bits_ == 8) {
            bytes_.push_back(byte_);
            bits_ = 0;
        }
    }

    /// Ends a list, or the bits pushed since the last one; returns its bytes.
    std::uint32_t finish() {
        if (visits_ > 0) {
            std::uint64_t count = visits_;
            for (; count >= 128; count >>= 7) bytes_.push_back(static_cast<std::uint8_t>(count | 128));
            bytes_.push_back(static_cast<std::uint8_t>(count));
            bytes_.insert(bytes_.end(), groups_.begin(),
                          groups_.begin() + static_cast<std::ptrdiff_t>(used_));
        }
        if (bits_ > 0) bytes_.push_back(static_cast<std::uint8_t>(byte_ << (8 - bits_)));
        const auto walk_bytes = static_cast<std::uint32_t>(bytes_.size() - start_);
        start_ = bytes_.size();
        visited_ += visits_;
        visits_ = 0;
        used_ = 0;
        bits_ = 0;
        previous_ = ~0u;
        return walk_bytes;
    }
    std::span<const std::uint8_t> bytes() const { return bytes_; }
    /// Of all finished lists.
    std::uint64_t visited_nodes() const { return visited_; }
    void clear() {
        bytes_.clear();
        start_ = 0;
        visited_ = 0;
    }

private:
    std::vector<std::uint8_t> bytes_, groups_ = std::vector<std::uint8_t>(4096);
    std::size_t start_ = 0, used_ = 0, codes_ = 0;  // of bytes_; of groups_, and where its last codes stand
    std::uint64_t visits_ = 0, visited_ = 0;
    std::uint32_t previous_ = ~0u;
    unsigned bits_ = 0;
    std::uint8_t byte_ = 0;
};

/// Gives list walks back. One thread at a time.
class ListWalkDecoder final : public WalkDecoder {
public:
    /// For a structure whose elements are 0 .. `elements` - 1.
    explicit ListWalkDecoder(std::uint32_t elements) : elements_(elements), visited_(4096) {}

    /// The fault enters_missing_child stands for an element that the structure does not have.
    Visits decode(std::span<const std::uint8_t> walk) override;

private:
    Visits ended(WalkFault fault, std::size_t count) const;

    std::uint32_t elements_;
    std::vector<std::uint32_t> visited_;
};

}  // namespace regather::spatial
