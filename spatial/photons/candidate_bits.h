// spatial/photons/candidate_bits.h -- which of the photons that a search looked at entered its list of the k
// nearest so far: nearer than the k-th of the list (of equal distances the smaller number) or met before
// there were k, and within the radius. A machine that searches writes its list for each of them, and for no
// other. Beside each walk, a bit for each photon that the search looked at, in that order, 1 = entered, from
// the most significant of each byte; padded with zeros to a byte.
#pragma once
#include <cstdint>
#include <span>

#include "spatial/structure.h"
#include "spatial/walk.h"

namespace regather::spatial {

/// Listens to nearest() as Walk does, and keeps these bits.
template <class Walk>
class CandidateRecorder : public Walk {
public:
    using Walk::Walk;

    void look(std::uint32_t photon, bool entered) {
        bits_.push(entered);
        if constexpr (requires(Walk walk) { walk.look(photon, entered); }) Walk::look(photon, entered);
    }
    /// Ends the bits of a search; returns their bytes.
    std::uint32_t finish_candidates() { return bits_.finish(); }
    /// Of all finished searches.
    std::span<const std::uint8_t> candidates() const { return bits_.bytes(); }

private:
    WalkRecorder bits_;
};

/// Calls look(record) for each photon, by record of the structure, that a search with these visits looked at,
/// in that order: the r-th call's bit is candidate_bit(bits, r).
template <class Look>
void for_each_look(const Structure& structure, std::span<const std::uint32_t> visits, Look&& look) {
    const ElementRange photons = structure.range_of(trace::Region::photons);
    const bool comes_back = structure.comes_back();
    std::uint32_t before = 0;
    for (const std::uint32_t element : visits) {
        const bool again = comes_back && element < before;
        before = element;
        if (again || element - photons.first >= photons.count) continue;
        const std::uint32_t first = structure.first_record(element), records = structure.records(element);
        for (std::uint32_t r = 0; r < records; ++r) look(first + r);
    }
}

inline bool candidate_bit(std::span<const std::uint8_t> bits, std::uint64_t look) {
    return (bits[look / 8] >> (7 - look % 8) & 1) != 0;
}

}  // namespace regather::spatial
