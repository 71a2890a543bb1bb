#include "spatial/list_walk.h"

#include <immintrin.h>

#include <array>

namespace regather::spatial {
namespace {

constexpr std::array<std::uint32_t, 4> code_bytes{0, 1, 2, 4};
constexpr std::size_t most_group_bytes = 1 + 16;

/// What a byte of four codes says.
struct Group {
    alignas(16) std::array<std::uint8_t, 16> shuffle{};  // 0x80: a zero
};
struct Groups {
    std::array<Group, 256> by_codes{};
    std::array<std::uint8_t, 256> bytes{};  // of the four values
};

constexpr Groups all_groups() {
    Groups groups;
    for (std::uint32_t codes = 0; codes < 256; ++codes) {
        std::uint32_t from = 0;
        for (std::uint32_t visit = 0; visit < 4; ++visit) {
            const std::uint32_t bytes = code_bytes[codes >> 2 * visit & 3];
            for (std::uint32_t b = 0; b < 4; ++b)
                groups.by_codes[codes].shuffle[4 * visit + b] =
                    static_cast<std::uint8_t>(b < bytes ? from + b : 0x80);
            from += bytes;
        }
        groups.bytes[codes] = static_cast<std::uint8_t>(from);
    }
    return groups;
}
constexpr Groups groups = all_groups();

std::uint32_t step_of(std::uint32_t value) {
    return value >> 1 ^ (0 - (value & 1));
}

}  // namespace

/// Up to the first visit of an element that there is not.
WalkDecoder::Visits ListWalkDecoder::ended(WalkFault fault, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i)
        if (visited_[i] >= elements_) return {WalkFault::enters_missing_child, {visited_.data(), i}};
    return {fault, {visited_.data(), count}};
}

WalkDecoder::Visits ListWalkDecoder::decode(std::span<const std::uint8_t> walk) {
    walk_bytes_ = 0;
    if (walk.empty()) return {WalkFault::none, {}};
    const std::uint8_t *in = walk.data(), *const end = in + walk.size();
    std::uint64_t count = 0;
    for (int shift = 0;; shift += 7) {
        if (in == end || shift > 28) return {WalkFault::ends_early, {}};
        count |= static_cast<std::uint64_t>(*in & 127) << shift;
        if (*in++ < 128) break;
    }
    if (in[-1] == 0) return {WalkFault::bytes_left_over, {}};  // no visits, or a zero that says nothing
    const std::uint64_t most = std::min<std::uint64_t>(count, 4 * static_cast<std::uint64_t>(end - in));
    if (visited_.size() < most + 4) visited_.resize(2 * (most + 4));

    std::uint32_t* const visited = visited_.data();
    std::size_t done = 0;
    __m128i previous = _mm_set1_epi32(-1), greatest = _mm_setzero_si128();
    const __m128i one = _mm_set1_epi32(1);
    while (count - done >= 4 && static_cast<std::size_t>(end - in) >= most_group_bytes) {
        const std::uint8_t codes = *in;
        const __m128i bytes = _mm_loadu_si128(reinterpret_cast<const __m128i*>(in + 1));
        const __m128i value = _mm_shuffle_epi8(
            bytes, _mm_load_si128(reinterpret_cast<const __m128i*>(groups.by_codes[codes].shuffle.data())));
        const __m128i sign = _mm_sub_epi32(_mm_setzero_si128(), _mm_and_si128(value, one));
        __m128i sum = _mm_add_epi32(_mm_xor_si128(_mm_srli_epi32(value, 1), sign), one);
        sum = _mm_add_epi32(sum, _mm_slli_si128(sum, 4));
        sum = _mm_add_epi32(sum, _mm_slli_si128(sum, 8));
        sum = _mm_add_epi32(sum, previous);
        _mm_storeu_si128(reinterpret_cast<__m128i*>(visited + done), sum);
        greatest = _mm_max_epu32(greatest, sum);
        previous = _mm_shuffle_epi32(sum, 0xff);
        in += 1 + groups.bytes[codes];
        done += 4;
    }
    // What is left is short, or damaged.
    auto last = static_cast<std::uint32_t>(_mm_cvtsi128_si32(previous));
    bool beyond = false;
    while (done < count) {
        if (in == end) return ended(WalkFault::ends_early, done);
        const std::uint8_t codes = *in++;
        const auto here = static_cast<std::uint32_t>(std::min<std::uint64_t>(4, count - done));
        for (std::uint32_t visit = 0; visit < here; ++visit) {
            const std::uint32_t bytes = code_bytes[codes >> 2 * visit & 3];
            if (static_cast<std::size_t>(end - in) < bytes) return ended(WalkFault::ends_early, done);
            std::uint32_t value = 0;
            std::memcpy(&value, in, bytes);
            in += bytes;
            last += step_of(value) + 1;
            visited[done++] = last;
            beyond |= last >= elements_;
        }
        if (here < 4 && codes >> 2 * here != 0) return ended(WalkFault::ends_early, done);
    }
    alignas(16) std::array<std::uint32_t, 4> lanes{};
    _mm_store_si128(reinterpret_cast<__m128i*>(lanes.data()), greatest);
    for (const std::uint32_t lane : lanes) beyond |= done >= 4 && lane >= elements_;
    walk_bytes_ = static_cast<std::size_t>(in - walk.data());
    const WalkFault fault = in == end ? WalkFault::none : WalkFault::bytes_left_over;
    if (beyond) return ended(fault, done);
    return {fault, {visited, done}};
}

}  // namespace regather::spatial
