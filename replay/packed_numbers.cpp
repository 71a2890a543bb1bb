#include "replay/packed_numbers.h"

#include <immintrin.h>

#include <array>
#include <cstring>

namespace regather::replay {
namespace {

/// A number of so many bits, wherever it starts within a byte, lies within four.
constexpr unsigned widest_in_four = 25;

/// How eight numbers of one width are brought into place: each half of a register gets 16 bytes.
struct Places {
    alignas(32) std::array<std::uint8_t, 32> bytes{};
    alignas(32) std::array<std::uint32_t, 8> shift{};
    unsigned upper = 0;  ///< Where the bytes of the upper half start.
};

constexpr std::array<Places, widest_in_four + 1> places = [] {
    std::array<Places, widest_in_four + 1> all{};
    for (unsigned width = 0; width <= widest_in_four; ++width) {
        Places& of = all[width];
        of.upper = 4 * width / 8;
        for (unsigned n = 0; n < 8; ++n) {
            const unsigned bit = n * width, first = bit / 8 - (n < 4 ? 0 : of.upper);
            for (unsigned b = 0; b < 4; ++b) of.bytes[4 * n + b] = static_cast<std::uint8_t>(first + b);
            of.shift[n] = bit % 8;
        }
    }
    return all;
}();

__m128i sixteen(const std::uint8_t* bytes) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes));
}

}  // namespace

void pack(std::span<const std::uint32_t> numbers, unsigned width, std::vector<std::uint8_t>& to) {
    const std::size_t start = to.size(), bytes = packed_bytes(numbers.size(), width);
    to.resize(start + bytes + 8);
    std::uint8_t* at = to.data() + start;
    std::uint64_t word = 0;
    unsigned held = 0;  // bits of `word`
    for (const std::uint32_t number : numbers) {
        word |= std::uint64_t{number} << held;
        held += width;
        if (held < 32) continue;
        std::memcpy(at, &word, 4);
        at += 4;
        word >>= 32;
        held -= 32;
    }
    std::memcpy(at, &word, 8);
    to.resize(start + bytes);
}

void unpack(const std::uint8_t* from, unsigned width, std::size_t count, std::uint32_t* to) {
    if (width > widest_in_four) {
        const std::uint64_t mask = (std::uint64_t{1} << width) - 1;
        for (std::size_t n = 0; n < count; ++n) {
            std::uint64_t word;
            std::memcpy(&word, from + n * width / 8, 8);
            to[n] = static_cast<std::uint32_t>(word >> (n * width % 8) & mask);
        }
        return;
    }
    const Places& of = places[width];
    const __m256i bytes = _mm256_load_si256(reinterpret_cast<const __m256i*>(of.bytes.data()));
    const __m256i shift = _mm256_load_si256(reinterpret_cast<const __m256i*>(of.shift.data()));
    const __m256i mask = _mm256_set1_epi32((1 << width) - 1);
    for (std::size_t n = 0; n < count; n += 8, from += width) {
        const __m256i both =
            _mm256_inserti128_si256(_mm256_castsi128_si256(sixteen(from)), sixteen(from + of.upper), 1);
        const __m256i numbers =
            _mm256_and_si256(_mm256_srlv_epi32(_mm256_shuffle_epi8(both, bytes), shift), mask);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + n), numbers);
    }
}

}  // namespace regather::replay
