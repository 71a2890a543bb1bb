#include "spatial/photons/nearest.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/spatial/brute_force.h"
#include "tests/spatial/flann_search.h"
#include "tests/spatial/photons.h"

namespace regather::spatial {
namespace {

std::vector<Neighbor> search(std::span<const Photon> heap, Vec3 point, std::uint32_t k,
                             float radius = infinity) {
    NearestSet found(k, radius);
    nearest(PhotonKd(heap), point, found);
    return found.nearest_first();
}

TEST(Nearest, EqualsBruteForceNodeForNode) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> heap = left_balanced(*any_photons(200));
        const int k = *rc::gen::inRange(0, 40);
        const float radius = *rc::gen::element(0.0f, 1.0f, 3.5f, 50.0f, infinity);
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-4, 12)) * 0.5f; };
        const Vec3 point{coordinate(), coordinate(), coordinate()};
        RC_ASSERT(same(search(heap, point, static_cast<std::uint32_t>(k), radius),
                       brute_force(heap, point, static_cast<std::size_t>(k), radius)));
    }));
}

class NearestInCloud : public testing::TestWithParam<std::vector<trace::Photon> (*)(std::size_t)> {};

TEST_P(NearestInCloud, EqualsFlannsExactSearchAndBruteForce) {
    constexpr std::uint32_t k = 100;
    const std::vector<Photon> heap = left_balanced(GetParam()(20000));
    const FlannSearch flann(heap);
    Numbers numbers(99);
    for (int q = 0; q < 200; ++q) {
        Vec3 point{numbers.uniform(), numbers.uniform(), numbers.uniform()};
        if (q % 2 == 0) point = heap[static_cast<std::size_t>(q) * 50].position;  // on a photon
        const std::vector<Neighbor> ours = search(heap, point, k);
        ASSERT_TRUE(same(ours, brute_force(heap, point, k, infinity)));
        const std::vector<float> distances2 = flann.nearest_distances2(point, k);
        ASSERT_EQ(distances2.size(), ours.size());
        // Of photons at equal distance FLANN may name another; the distances agree to rounding.
        for (std::size_t i = 0; i < k; ++i)
            ASSERT_NEAR(distances2[i], ours[i].distance2, 1e-6f * ours[i].distance2 + 1e-12f);
    }
}
INSTANTIATE_TEST_SUITE_P(Clouds, NearestInCloud,
                         testing::Values(uniform_cloud, clustered_photons, coplanar_photons,
                                         duplicate_photons));

TEST(Nearest, KAboveThePhotonCountFindsAll) {
    const std::vector<Photon> heap = left_balanced(uniform_photons(7));
    EXPECT_EQ(search(heap, {0, 0, 0}, 100).size(), 7u);
}

TEST(Nearest, NoPhotonsAndOnePhoton) {
    EXPECT_TRUE(search({}, {0, 0, 0}, 5).empty());
    const std::vector<Photon> one = left_balanced(photons_on_a_line({3}));
    ASSERT_EQ(search(one, {1, 0, 0}, 5).size(), 1u);
    EXPECT_EQ(search(one, {1, 0, 0}, 5)[0].distance2, 4.0f);
    EXPECT_TRUE(search(one, {1, 0, 0}, 5, 1.5f).empty());
}

TEST(Nearest, PointsThatAreNotFiniteFindNothingAndVisitNothing) {
    const std::vector<Photon> heap = left_balanced(uniform_photons(50));
    struct Count {
        int visits = 0;
        void visit(std::uint32_t) { ++visits; }
        void near(bool) {}
        void far(bool) {}
    } count;
    NearestSet found(10);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
        nearest(PhotonKd(heap), {0, bad, 0}, found, count);
        EXPECT_EQ(found.size(), 0u);
    }
    EXPECT_EQ(count.visits, 0);
}

TEST(Nearest, RadiusZeroFindsOnlyWhatIsThere) {
    const std::vector<Photon> heap = left_balanced(photons_on_a_line({0, 1, 1, 2}));
    EXPECT_EQ(search(heap, {1, 0, 0}, 9, 0).size(), 2u);
    EXPECT_EQ(search(heap, {1.5f, 0, 0}, 9, 0).size(), 0u);
}

TEST(Nearest, TheDiscIsTheFarthestPhotonsWhenFullElseTheSearchRadius) {
    const std::vector<Photon> heap = left_balanced(photons_on_a_line({0, 1, 2, 3}));
    NearestSet full(2), open(9, 5), endless(9);
    nearest(PhotonKd(heap), {0, 0, 0}, full);
    nearest(PhotonKd(heap), {0, 0, 0}, open);
    nearest(PhotonKd(heap), {0, 0, 0}, endless);
    EXPECT_EQ(full.disc_radius2(), 1.0f);
    EXPECT_EQ(open.disc_radius2(), 25.0f);
    EXPECT_EQ(endless.disc_radius2(), 9.0f);
}

TEST(Nearest, ItVisitsOnlyABranchWhenOneIsEnough) {
    // 3 | 1 5 | 0 2 4 6 on a line; the nearest one of 0: 3, 1, 0 on the way down; then 1's far child 2 is 1
    // away from the plane at 1 > 0, and the root's at 3: nothing else is entered.
    const std::vector<Photon> heap = left_balanced(photons_on_a_line({0, 1, 2, 3, 4, 5, 6}));
    struct Visits {
        std::vector<std::uint32_t> nodes;
        void visit(std::uint32_t node) { nodes.push_back(node); }
        void near(bool) {}
        void far(bool) {}
    } visits;
    NearestSet found(1);
    nearest(PhotonKd(heap), {0, 0, 0}, found, visits);
    EXPECT_EQ(visits.nodes, (std::vector<std::uint32_t>{0, 1, 3}));
}

}  // namespace
}  // namespace regather::spatial
