#include "spatial/heap_walk.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "spatial/walk_bits.h"

namespace regather::spatial {
namespace {

constexpr std::size_t margin = 64;  // nodes that one step may write
constexpr int subtree_bits = 6;     // that a subtree of seven nodes takes at most
constexpr std::size_t small_subtrees = std::size_t{1} << subtree_bits;  // where those of three nodes start

/// to[i] = path >> (steps - i) for i = 0 .. steps; writes a multiple of 8 entries.
void write_prefixes(std::uint32_t path, int steps, std::uint32_t* to) {
    const __m256i all = _mm256_set1_epi32(static_cast<int>(path));
    __m256i shift = _mm256_sub_epi32(_mm256_set1_epi32(steps), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    for (int i = 0; i <= steps; i += 8) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + i), _mm256_srlv_epi32(all, shift));
        shift = _mm256_sub_epi32(shift, _mm256_set1_epi32(8));
    }
}

/// The visits of a subtree for given bits: the i-th is (root << level[i]) + offset[i].
struct SubtreeVisits {
    alignas(32) std::array<std::int32_t, 8> level{}, offset{};
    std::int32_t count = 0, bits = 0;
};

/// Visits of a complete subtree of `height` levels below and with (level, offset), as the grammar has them.
void visit(SubtreeVisits& visits, std::uint64_t bits, int height, int level, int offset) {
    const auto at = static_cast<std::size_t>(visits.count++);
    visits.level[at] = level;
    visits.offset[at] = offset;
    if (height == 1) return;
    const auto next = [&] { return static_cast<int>(bits << visits.bits++ >> 63); };
    const int near = next();
    visit(visits, bits, height - 1, level + 1, 2 * offset + near);
    if (next() != 0) visit(visits, bits, height - 1, level + 1, 2 * offset + 1 - near);
}

/// Subtrees of seven nodes by their next six bits; then those of three by two bits.
const std::array<SubtreeVisits, small_subtrees + 4>& subtree_table() {
    static const auto table = [] {
        std::array<SubtreeVisits, small_subtrees + 4> all{};
        for (std::uint64_t b = 0; b < small_subtrees; ++b) visit(all[b], b << (64 - subtree_bits), 3, 0, 0);
        for (std::uint64_t b = 0; b < 4; ++b) visit(all[small_subtrees + b], b << 62, 2, 0, 0);
        return all;
    }();
    return table;
}

}  // namespace

/// A place in a walk, for the subtrees that are in no table.
struct HeapWalkDecoder::Cursor {
    const std::uint8_t* bytes;
    std::uint64_t position, total;  // bits
    std::size_t count;
    WalkFault fault;
    bool next() { return bits_at(bytes, std::min(position++, total)) >> 63 != 0; }
};

HeapWalkDecoder::HeapWalkDecoder(std::uint32_t nodes)
    : nodes_(nodes), cut_(static_cast<int>(std::bit_width(nodes)) - 3), visited_(4096) {}

/// The grammar, bit by bit.
void HeapWalkDecoder::subtree(Cursor& cursor, std::uint64_t slot) {
    if (cursor.fault != WalkFault::none || cursor.position > cursor.total) return;
    if (cursor.count + margin > visited_.size()) visited_.resize(2 * visited_.size());
    visited_[cursor.count++] = static_cast<std::uint32_t>(slot);
    if (2 * slot > nodes_) return;
    const std::uint64_t near = 2 * slot + (cursor.next() ? 1 : 0), far = near ^ 1;
    if (near <= nodes_) subtree(cursor, near);
    if (cursor.fault != WalkFault::none || !cursor.next()) return;
    if (far <= nodes_) {
        subtree(cursor, far);
    } else {
        cursor.fault = WalkFault::enters_missing_child;
    }
}

WalkDecoder::Visits HeapWalkDecoder::decode(std::span<const std::uint8_t> walk) {
    walk_bytes_ = 0;
    if (walk.empty()) return {WalkFault::none, {}};
    if (nodes_ == 0) return {WalkFault::bytes_left_over, {}};
    if (padded_.size() < walk.size() + walk_padding) padded_.resize(2 * (walk.size() + walk_padding));
    std::memcpy(padded_.data(), walk.data(), walk.size());
    std::memset(padded_.data() + walk.size(), 0, walk_padding);
    Cursor end{padded_.data(), 0, 8 * walk.size(), 0, WalkFault::none};

    if (cut_ < 0) {
        subtree(end, 1);
    } else {
        const SubtreeVisits* const table = subtree_table().data();
        const std::uint8_t* const bytes = padded_.data();
        const std::uint64_t nodes = nodes_, total = end.total;
        // One step takes at most a near and a far bit for each level above the cut, and a subtree's bits.
        const int most_bits = 2 * cut_ + subtree_bits + 1;
        const bool refetch = most_bits > whole_bits;
        std::uint64_t position = 0, bits = 0;  // bits from `position` on, `held` of them
        std::uint64_t pending = 0;  // bit l: the far child of the path's node on level l is undecided
        std::uint64_t slot = 1;
        std::size_t count = 0;
        int held = 0, level = 0;
        for (;;) {
            if (count + margin > visited_.size()) visited_.resize(2 * visited_.size());
            std::uint32_t* to = visited_.data() + count;
            if (held < most_bits) {
                bits = bits_at(bytes, position);
                held = whole_bits;
            }
            // Near bits down to the cut.
            const int steps = cut_ - level;
            slot = slot << steps | (bits >> 1 >> (63 - steps));
            write_prefixes(static_cast<std::uint32_t>(slot), steps, to);
            to += steps;
            pending |= ((std::uint64_t{1} << steps) - 1) << level;
            bits <<= steps;

            // The subtree.
            int taken = steps;
            const bool seven = 4 * slot + 3 <= nodes, three = 4 * slot > nodes && 2 * slot + 1 <= nodes;
            if (seven || three) {
                const SubtreeVisits& visits =
                    table[seven ? bits >> (64 - subtree_bits) : small_subtrees + (bits >> 62)];
                const __m256i root = _mm256_set1_epi32(static_cast<int>(slot));
                const __m256i levels =
                    _mm256_load_si256(reinterpret_cast<const __m256i*>(visits.level.data()));
                const __m256i offsets =
                    _mm256_load_si256(reinterpret_cast<const __m256i*>(visits.offset.data()));
                _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                                    _mm256_add_epi32(_mm256_sllv_epi32(root, levels), offsets));
                count += static_cast<std::size_t>(steps + visits.count);
                taken += visits.bits;
                bits <<= visits.bits;
                position += static_cast<std::uint64_t>(taken);
            } else {  // the one that the last node lies in
                end.position = position + static_cast<std::uint64_t>(steps);
                end.count = count + static_cast<std::size_t>(steps);
                subtree(end, slot);
                if (end.fault != WalkFault::none) return {end.fault, {visited_.data(), end.count}};
                taken += static_cast<int>(end.position - position) - steps;
                position = end.position;
                count = end.count;
                bits = bits_at(bytes, std::min(position, total));
            }
            if (refetch) bits = bits_at(bytes, std::min(position, total));

            // Far bits: zeros up to the first one drop that many undecided levels, deepest first.
            const int undecided = std::popcount(pending), zeros = std::countl_zero(bits);
            if (zeros >= undecided) {
                position += static_cast<std::uint64_t>(undecided);
                break;
            }
            position += static_cast<std::uint64_t>(zeros) + 1;
            if (position > total) break;
            bits = bits << zeros << 1;
            held -= taken + zeros + 1;
            const std::uint64_t parent_bit = _pdep_u64(std::uint64_t{1} << (undecided - 1 - zeros), pending);
            const int parent = std::countr_zero(parent_bit);
            pending &= parent_bit - 1;
            slot = slot >> (cut_ - parent - 1) ^ 1u;
            level = parent + 1;
        }
        end.position = position;
        end.count = count;
    }
    WalkFault fault = end.fault;
    if (fault == WalkFault::none && end.position > end.total) fault = WalkFault::ends_early;
    walk_bytes_ = std::max<std::uint64_t>(1, (end.position + 7) / 8);
    if (fault == WalkFault::none && walk_bytes_ < walk.size()) fault = WalkFault::bytes_left_over;
    return {fault, {visited_.data(), end.count}};
}

}  // namespace regather::spatial
