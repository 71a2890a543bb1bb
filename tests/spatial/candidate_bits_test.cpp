// Bits that tell which photons entered a search's list: those of a list kept by its definition over the
// decoded visits.
#include "spatial/photons/candidate_bits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <limits>

#include "spatial/photons/left_balanced.h"
#include "spatial/photons/structures.h"
#include "tests/spatial/brute_force.h"
#include "tests/spatial/photons.h"

namespace regather::spatial {
namespace {

using testing::ElementsAre;
using trace::Region;

/// The k nearest of the photons offered so far, in order.
class SlowList {
public:
    SlowList(std::uint32_t k, float radius) : k_(k), radius_(radius) {}
    bool offer(const Neighbor& photon) {
        if (!(photon.distance2 <= radius_ * radius_)) return false;
        list_.push_back(photon);
        std::sort(list_.begin(), list_.end(), is_nearer);
        if (list_.size() <= k_) return true;
        const bool entered = list_.back().node != photon.node;
        list_.pop_back();
        return entered;
    }
    std::vector<std::uint32_t> photons() const {
        std::vector<std::uint32_t> numbers;
        for (const Neighbor& n : list_) numbers.push_back(n.node);
        std::sort(numbers.begin(), numbers.end());
        return numbers;
    }

private:
    std::uint32_t k_;
    float radius_;
    std::vector<Neighbor> list_;
};

/// Each structure whose walks are recorded, and those that can tell what was found telling it.
std::vector<std::string> specs() {
    std::vector<std::string> all;
    for (const StructureEntry& entry : structures()) {
        if (!entry.build) continue;
        all.emplace_back(entry.name);
        for (const trace::Parameter& parameter : entry.parameters)
            if (parameter.name == "found") all.push_back(std::string(entry.name) + ":found=1");
    }
    return all;
}

TEST(CandidateBits, AreThoseOfAListKeptOverTheDecodedVisits) {
    const std::vector<std::string> all = specs();
    ASSERT_GE(all.size(), 17u);
    ASSERT_TRUE(rc::check([&] {
        const std::vector<Photon> heap = left_balanced(*any_photons(150));
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-4, 12)) * 0.5f; };
        std::vector<Vec3> points;
        for (int i = 0; i < 3; ++i) points.push_back({coordinate(), coordinate(), coordinate()});
        points.push_back({0, infinity, 0});
        const auto k = *rc::gen::inRange<std::uint32_t>(0, 20);
        const float radius = *rc::gen::element(infinity, 1.0f, 2.5f, 0.0f);
        const std::string spec = *rc::gen::elementOf(all);
        const bool tells_found = spec.ends_with("found=1");

        const auto search = build(parse_structure(spec), heap, k, radius);
        const Structure& structure = *search->structure();
        const auto decoder = structure.decoder();
        const Recording recording = search->record(points, k, radius, true);
        const std::uint32_t first_power = structure.range_of(Region::photon_power).first;
        const auto photon_of = [&](std::uint32_t record) {
            return search->photon_at().empty() ? record : search->photon_at()[record];
        };
        std::span<const std::uint8_t> walks = recording.walks, bits = recording.candidates;
        RC_ASSERT(recording.candidate_bytes.size() == points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto visits = decoder->decode(walks.first(recording.walk_bytes[i])).elements;
            SlowList list(k, radius);
            std::uint64_t looks = 0;
            std::vector<std::uint32_t> looked;
            for_each_look(structure, visits, [&](std::uint32_t record) {
                const std::uint32_t photon = photon_of(record);
                const Vec3 d = points[i] - heap[photon].position;
                RC_ASSERT(looks < 8 * bits.size());
                RC_ASSERT(candidate_bit(bits, looks++) == list.offer({trace::dot(d, d), photon}));
                looked.push_back(photon);
            });
            RC_ASSERT(recording.candidate_bytes[i] == (looks + 7) / 8);
            for (; looks % 8 != 0; ++looks) RC_ASSERT(!candidate_bit(bits, looks));
            // Each is looked at once; what is left in the list is what the search finds.
            std::sort(looked.begin(), looked.end());
            RC_ASSERT(std::adjacent_find(looked.begin(), looked.end()) == looked.end());
            if (tells_found) {
                std::vector<std::uint32_t> found;
                for (const std::uint32_t e : visits)
                    if (e >= first_power && !heap.empty()) found.push_back(photon_of(e - first_power));
                std::sort(found.begin(), found.end());
                RC_ASSERT(found == list.photons());
            }
            walks = walks.subspan(recording.walk_bytes[i]);
            bits = bits.subspan(recording.candidate_bytes[i]);
        }
        RC_ASSERT(bits.empty());
        // The walks are those of a recording that tells nothing besides.
        const Recording plain = search->record(points, k, radius, false);
        RC_ASSERT(plain.walks == recording.walks);
        RC_ASSERT(plain.candidates.empty());
    }));
}

TEST(CandidateBits, OfFiveOnALineAreThoseDrawnByHand) {
    // The heap of 0 .. 4 is 3 1 4 0 2. Of 0.9 the two nearest are looked for: 3 and 1 fill the list, 0 pushes
    // 3 out, 2 is farther than both.
    const std::vector<Photon> heap = left_balanced(photons_on_a_line({0, 1, 2, 3, 4}));
    const std::vector<Vec3> point{{0.9f, 0, 0}};
    const Recording walk = record_walks(PhotonKd(heap), point, 2, 10, {.candidates = true});
    EXPECT_THAT(walk.candidates, ElementsAre(0b1110'0000));
    // Within 1: 3 is too far away.
    EXPECT_THAT(record_walks(PhotonKd(heap), point, 2, 1, {.candidates = true}).candidates,
                ElementsAre(0b0110'0000));
    // Without a stack nodes 1 and 2 are read again on the way back, their photons are not looked at again.
    const StackFree shape(5);
    const auto decoder = shape.decoder();
    const auto visits = decoder->decode(walk.walks).elements;
    EXPECT_THAT(visits, ElementsAre(1, 2, 4, 2, 5, 2, 1));
    std::vector<std::uint32_t> looked;
    for_each_look(shape, visits, [&](std::uint32_t record) { looked.push_back(record); });
    EXPECT_THAT(looked, ElementsAre(0, 1, 3, 4));
}

}  // namespace
}  // namespace regather::spatial
