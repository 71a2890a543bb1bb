// cachesim/lru/stamp_bits.h -- which time stamps are some line's last one, as a bitmap that counts fast: the
// number of set bits above a stamp is the LRU stack distance of the line that bears it (Bennett & Kruskal
// 1975, with counts of three sizes in place of their tree). Memory: 1.2 bits a stamp.
#pragma once
#include <immintrin.h>

#include <bit>
#include <cstdint>
#include <vector>

namespace regather::cachesim {

class StampBits {
public:
    /// For stamps below `capacity`, rounded up to a power of two from 2^16 to 2^28.
    explicit StampBits(std::uint64_t capacity);

    std::uint64_t capacity() const { return std::uint64_t{words_.size()} * 64; }
    void set(std::uint32_t stamp) {
        words_[stamp / 64] |= std::uint64_t{1} << (stamp % 64);
        ++in_word_[stamp / 64];
        ++in_group_[stamp / group];
        ++in_block_[stamp / block];
    }
    void clear(std::uint32_t stamp) {
        words_[stamp / 64] &= ~(std::uint64_t{1} << (stamp % 64));
        --in_word_[stamp / 64];
        --in_group_[stamp / group];
        --in_block_[stamp / block];
    }
    /// Sets the `count` bits from `first` on, none of which is set.
    void set_range(std::uint32_t first, std::uint32_t count);
    /// Set bits above `stamp`, of which none lies above `newest`.
    std::uint32_t above(std::uint32_t stamp, std::uint32_t newest) const {
        const std::uint32_t word = stamp / 64, in_group = stamp / group, in_block = stamp / block;
        auto count = static_cast<std::uint32_t>(std::popcount(words_[word] >> (stamp % 64) >> 1));
        // Words of the group after this one.
        const __m256i words =
            _mm256_loadu_si256(reinterpret_cast<const __m256i*>(&in_word_[in_group * words_a_group]));
        const __m256i after_word =
            _mm256_cmpgt_epi8(byte_places(), _mm256_set1_epi8(static_cast<char>(word % words_a_group)));
        const __m256i word_sum = _mm256_sad_epu8(_mm256_and_si256(words, after_word), _mm256_setzero_si256());
        // Groups of the block after this one.
        const auto* groups = reinterpret_cast<const __m256i*>(&in_group_[in_block * groups_a_block]);
        const __m256i place = _mm256_set1_epi16(static_cast<short>(in_group % groups_a_block));
        const __m256i ones = _mm256_set1_epi16(1), sixteen = _mm256_set1_epi16(16);
        const __m256i low =
            _mm256_and_si256(_mm256_loadu_si256(groups), _mm256_cmpgt_epi16(short_places(), place));
        const __m256i high =
            _mm256_and_si256(_mm256_loadu_si256(groups + 1),
                             _mm256_cmpgt_epi16(_mm256_add_epi16(short_places(), sixteen), place));
        const __m256i sums = _mm256_add_epi32(
            word_sum, _mm256_add_epi32(_mm256_madd_epi16(low, ones), _mm256_madd_epi16(high, ones)));
        __m128i half = _mm_add_epi32(_mm256_castsi256_si128(sums), _mm256_extracti128_si256(sums, 1));
        half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0x4e));
        half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0xb1));
        count += static_cast<std::uint32_t>(_mm_cvtsi128_si32(half));
        for (std::uint32_t b = in_block + 1; b <= newest / block; ++b) count += in_block_[b];
        return count;
    }
    void prefetch(std::uint32_t stamp) const {
        __builtin_prefetch(&words_[stamp / 64]);
        __builtin_prefetch(&in_word_[stamp / 64]);
    }
    std::uint32_t count() const;
    void reset();

    /// Set bits below a stamp, for many stamps at a time when nothing changes in between.
    class Ranks {
    public:
        explicit Ranks(const StampBits& bits);
        std::uint32_t below(std::uint32_t stamp) const {
            const std::uint64_t lower = (std::uint64_t{1} << (stamp % 64)) - 1;
            return before_word_[stamp / 64] +
                   static_cast<std::uint32_t>(std::popcount(bits_.words_[stamp / 64] & lower));
        }

    private:
        const StampBits& bits_;
        std::vector<std::uint32_t> before_word_;
    };

private:
    static constexpr std::uint32_t words_a_group = 32, groups_a_block = 32;
    static constexpr std::uint32_t group = 64 * words_a_group, block = group * groups_a_block;
    static __m256i byte_places() {
        return _mm256_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21,
                                22, 23, 24, 25, 26, 27, 28, 29, 30, 31);
    }
    static __m256i short_places() {
        return _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }

    std::vector<std::uint64_t> words_;
    std::vector<std::uint8_t> in_word_;
    std::vector<std::uint16_t> in_group_;
    std::vector<std::uint32_t> in_block_;
};

}  // namespace regather::cachesim
