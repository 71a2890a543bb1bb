// spatial/walk.h -- the walk of a kNN search as bits (spatial/heap_walk.h: and back). A search of the
// left-balanced tree makes two decisions at each visited node that has a child: which child first, and later
// whether the other one is entered. These bits, in the order of the decisions, give the visited nodes back
// without searching: 2 bits a visited inner node, none for a leaf.
//
// Grammar (bits from the most significant of each byte, as numpy.unpackbits reads them; a walk starts on a
// byte and is padded with zeros). A search that visits nothing has a walk of no bytes; any other walk has at
// least one byte.
//   walk(node): the node is visited; then, if it has a child:
//   near bit: 1 = the upper child (2i+1, counted from 1) comes first; then the walk of that child, if it
//   exists; far bit:  1 = the other child exists and is entered; then its walk.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace regather::spatial {

/// Listens to nearest() and appends walks to one byte buffer.
class WalkRecorder {
public:
    void visit(std::uint32_t) {
        ++visited_;
        began_ = true;
    }
    void near(bool upper) { push(upper); }
    void far(bool entered) { push(entered); }
    /// Any bit.
    void push(bool bit) {
        word_ = word_ << 1 | static_cast<std::uint64_t>(bit);
        if (++used_ == 64) {
            append(word_, 8);
            word_ = 0;
            used_ = 0;
        }
    }

    /// The lower `count` bits, 0 to 64, the uppermost first; those above are 0.
    void push(std::uint64_t bits, unsigned count) {
        const unsigned room = 64 - used_;
        if (count < room) {
            word_ = word_ << count | bits;
            used_ += count;
            return;
        }
        used_ = count - room;
        append((room < 64 ? word_ << room : 0) | bits >> used_, 8);
        word_ = bits;  // what has gone already leaves at the top
    }

    /// Ends a walk; returns its bytes.
    std::uint32_t finish() {
        const std::size_t rest = began_ && bytes_.size() == start_ && used_ == 0 ? 1 : (used_ + 7) / 8;
        append(used_ == 0 ? 0 : word_ << (64 - used_), rest);
        const auto walk_bytes = static_cast<std::uint32_t>(bytes_.size() - start_);
        start_ = bytes_.size();
        word_ = 0;
        used_ = 0;
        began_ = false;
        return walk_bytes;
    }
    std::span<const std::uint8_t> bytes() const { return bytes_; }
    std::uint64_t visited_nodes() const { return visited_; }
    void clear() {
        bytes_.clear();
        start_ = 0;
        visited_ = 0;
    }

private:
    /// The upper bytes of a word.
    void append(std::uint64_t word, std::size_t count) {
        if (count == 0) return;
        const std::uint64_t swapped = __builtin_bswap64(word);
        const std::size_t at = bytes_.size();
        bytes_.resize(at + count);
        std::memcpy(bytes_.data() + at, &swapped, count);
    }

    std::vector<std::uint8_t> bytes_;
    std::size_t start_ = 0;
    std::uint64_t word_ = 0, visited_ = 0;
    unsigned used_ = 0;
    bool began_ = false;
};

}  // namespace regather::spatial
