#include "spatial/walk.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>

namespace regather::spatial {
namespace {

constexpr std::size_t padding = 16;    // bytes that may be read past a walk
constexpr std::size_t margin = 40;     // nodes that one descent may write

constexpr int whole_bits = 57;         // that bits_at() gives at least

/// The bits from `position` on, at the top of the word.
std::uint64_t bits_at(const std::uint8_t* bytes, std::uint64_t position) {
    std::uint64_t word;
    std::memcpy(&word, bytes + position / 8, 8);
    return __builtin_bswap64(word) << (position % 8);
}

/// to[i] = path >> (steps - i) for i = 0 .. steps; writes a multiple of 8 entries.
void write_prefixes(std::uint32_t path, int steps, std::uint32_t* to) {
    const __m256i all = _mm256_set1_epi32(static_cast<int>(path));
    __m256i shift = _mm256_sub_epi32(_mm256_set1_epi32(steps), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    for (int i = 0; i <= steps; i += 8) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + i), _mm256_srlv_epi32(all, shift));
        shift = _mm256_sub_epi32(shift, _mm256_set1_epi32(8));
    }
}

}  // namespace

WalkDecoder::WalkDecoder(std::uint32_t photons)
    : photons_(photons), deepest_(photons == 0 ? 0 : static_cast<int>(std::bit_width(photons)) - 1), visited_(4096) {}

WalkDecoder::Visits WalkDecoder::decode(std::span<const std::uint8_t> walk) {
    if (walk.empty()) return {WalkFault::none, {}};
    if (photons_ == 0) return {WalkFault::bytes_left_over, {}};
    if (padded_.size() < walk.size() + padding) padded_.resize(2 * (walk.size() + padding));
    std::memcpy(padded_.data(), walk.data(), walk.size());
    std::memset(padded_.data() + walk.size(), 0, padding);

    const std::uint8_t* const bytes = padded_.data();
    const std::uint64_t photons = photons_, total = 8 * walk.size();
    // One round takes at most a near bit and a far bit for each level: then a word is fetched for several rounds.
    const int most_bits = 2 * deepest_ + 2;
    const bool refetch = most_bits > whole_bits;
    std::uint64_t position = 0, pending = 0;  // pending bit l: the far child of the path's node on level l is undecided
    std::uint64_t bits = 0;                   // from `position`
    int held = 0;
    std::uint64_t slot = 1;
    std::size_t count = 0;
    int level = 0;
    for (;;) {
        if (count + margin > visited_.size()) visited_.resize(2 * visited_.size());
        std::uint32_t* const to = visited_.data() + count;

        // Near bits down to the level above the deepest, then one more where there is a child.
        const int steps = std::max(0, deepest_ - 1 - level);
        if (held < most_bits) {
            bits = bits_at(bytes, position);
            held = whole_bits;
        }
        slot = slot << steps | (bits >> 1 >> (63 - steps));
        write_prefixes(static_cast<std::uint32_t>(slot), steps, to);
        pending |= ((std::uint64_t{1} << steps) - 1) << level;
        level += steps;
        count += static_cast<std::size_t>(steps) + 1;
        const std::uint64_t has_child = 2 * slot <= photons;
        const std::uint64_t upper = bits << steps >> 63;
        const std::uint64_t child = 2 * slot + upper;
        to[steps + 1] = static_cast<std::uint32_t>(child);
        count += static_cast<std::size_t>(has_child & static_cast<std::uint64_t>(child <= photons));
        pending |= has_child << level;
        slot = has_child ? child : slot;
        level += static_cast<int>(has_child);
        const int near_bits = steps + static_cast<int>(has_child);
        bits <<= near_bits;
        position += static_cast<std::uint64_t>(near_bits);
        if (refetch) bits = bits_at(bytes, position);

        // Far bits: zeros up to the first one drop that many undecided levels, deepest first.
        const int undecided = std::popcount(pending);
        const int zeros = std::countl_zero(bits);
        if (zeros >= undecided) {
            position += static_cast<std::uint64_t>(undecided);
            break;
        }
        position += static_cast<std::uint64_t>(zeros) + 1;
        bits = bits << zeros << 1;
        held -= near_bits + zeros + 1;
        const std::uint64_t parent_bit = _pdep_u64(std::uint64_t{1} << (undecided - 1 - zeros), pending);
        const int parent = std::countr_zero(parent_bit);
        pending &= parent_bit - 1;
        slot = slot >> (level - parent - 1) ^ 1u;
        level = parent + 1;
        if (position > total) break;
        if (slot > photons) return {WalkFault::enters_missing_child, {visited_.data(), count}};
    }
    WalkFault fault = WalkFault::none;
    if (position > total) fault = WalkFault::ends_early;
    if (std::max<std::uint64_t>(1, (position + 7) / 8) < walk.size()) fault = WalkFault::bytes_left_over;
    return {fault, {visited_.data(), count}};
}

}  // namespace regather::spatial
