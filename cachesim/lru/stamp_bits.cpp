#include "cachesim/lru/stamp_bits.h"

#include <algorithm>
#include <numeric>

namespace regather::cachesim {

StampBits::StampBits(std::uint64_t capacity) {
    const std::uint64_t stamps =
        std::bit_ceil(std::clamp<std::uint64_t>(capacity, block, std::uint64_t{1} << 28));
    words_.resize(stamps / 64);
    in_word_.resize(stamps / 64);
    in_group_.resize(stamps / group);
    in_block_.resize(stamps / block);
}

void StampBits::set_range(std::uint32_t first, std::uint32_t count) {
    for (const std::uint32_t end = first + count; first < end;) {
        const std::uint32_t bits = std::min(64 - first % 64, end - first);
        words_[first / 64] |= (bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1)
                              << (first % 64);
        in_word_[first / 64] = static_cast<std::uint8_t>(in_word_[first / 64] + bits);
        in_group_[first / group] = static_cast<std::uint16_t>(in_group_[first / group] + bits);
        in_block_[first / block] += bits;
        first += bits;
    }
}

std::uint32_t StampBits::count() const {
    return std::accumulate(in_block_.begin(), in_block_.end(), std::uint32_t{0});
}

void StampBits::reset() {
    std::fill(words_.begin(), words_.end(), 0);
    std::fill(in_word_.begin(), in_word_.end(), std::uint8_t{0});
    std::fill(in_group_.begin(), in_group_.end(), std::uint16_t{0});
    std::fill(in_block_.begin(), in_block_.end(), 0);
}

StampBits::Ranks::Ranks(const StampBits& bits) : bits_(bits), before_word_(bits.words_.size()) {
    std::uint32_t sum = 0;
    for (std::size_t w = 0; w < before_word_.size(); ++w) {
        before_word_[w] = sum;
        sum += static_cast<std::uint32_t>(std::popcount(bits.words_[w]));
    }
}

}  // namespace regather::cachesim
