#include "spatial/photons/photon_buckets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "spatial/photons/bucket_kd.h"
#include "tests/spatial/brute_force.h"
#include "tests/spatial/photons.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

std::vector<Neighbor> nearest_first(const Candidates& found) {
    std::vector<Neighbor> list;
    for (std::size_t i = 0; i < found.size(); ++i) list.push_back(found[i]);
    std::sort(list.begin(), list.end(), is_nearer);
    return list;
}

std::vector<Neighbor> search(const PhotonBuckets& tree, Vec3 point, std::uint32_t k,
                             float radius = infinity) {
    Candidates found(k, radius);
    nearest(tree, point, found);
    return nearest_first(found);
}

TEST(PhotonBuckets, FindWhatBruteForceFindsNodeForNode) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> photons = *any_photons(400);
        const int k = *rc::gen::inRange(0, 40);
        const float radius = *rc::gen::element(0.0f, 1.0f, 3.5f, 50.0f, infinity);
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-4, 12)) * 0.5f; };
        const Vec3 point{coordinate(), coordinate(), coordinate()};
        RC_ASSERT(same(search(PhotonBuckets(photons), point, static_cast<std::uint32_t>(k), radius),
                       brute_force(photons, point, static_cast<std::size_t>(k), radius)));
    }));
}

class BucketsOfCloud : public testing::TestWithParam<std::vector<trace::Photon> (*)(std::size_t)> {};

TEST_P(BucketsOfCloud, FindWhatTheLeftBalancedTreeFindsNodeForNode) {
    const std::vector<Photon> heap = left_balanced(GetParam()(20000));
    const PhotonBuckets tree(heap);
    Numbers numbers(99);
    for (const std::uint32_t k : {1u, 2u, 100u, 1000u}) {
        Candidates found(k);
        NearestSet expected(k);
        for (int q = 0; q < 300; ++q) {
            Vec3 point{2 * numbers.uniform() - 0.5f, numbers.uniform(), numbers.uniform()};
            if (q % 2 == 0) point = heap[static_cast<std::size_t>(q) * 50].position;  // on a photon
            nearest(tree, point, found);
            nearest(PhotonKd(heap), point, expected);
            ASSERT_TRUE(same(nearest_first(found), expected.nearest_first())) << "k " << k << ", query " << q;
        }
    }
}
std::vector<trace::Photon> all_in_one_place(std::size_t count) {
    return std::vector<trace::Photon>(count, trace::Photon{.position = {0.5f, 0.25f, 0.125f}});
}
/// Most photons share their distance to a point on the grid with others.
std::vector<trace::Photon> grid(std::size_t count) {
    std::vector<trace::Photon> photons(count);
    for (std::size_t i = 0; i < count; ++i)
        photons[i].position = {static_cast<float>(i % 27) * 0.125f, static_cast<float>(i / 27 % 27) * 0.125f,
                               static_cast<float>(i / 729) * 0.125f};
    return photons;
}
INSTANTIATE_TEST_SUITE_P(Clouds, BucketsOfCloud,
                         testing::Values(uniform_cloud, clustered_photons, coplanar_photons,
                                         duplicate_photons, all_in_one_place, grid));

TEST(PhotonBuckets, OfEqualDistancesTheSmallestNodesAreKept) {
    const PhotonBuckets tree(all_in_one_place(1000));
    const std::vector<Neighbor> found = search(tree, {0, 0, 0}, 150);
    ASSERT_EQ(found.size(), 150u);
    for (std::uint32_t i = 0; i < 150; ++i) EXPECT_EQ(found[i].node, i);
}

// The shapes of the tree change at 16 photons (a bucket), 128 (a node of buckets) and 1024; past each the
// last child of a level is alone.
TEST(PhotonBuckets, EverySizeAroundTheShapesOfTheTreeFindsAllItsPhotons) {
    for (const std::size_t shape : {16u, 32u, 128u, 256u, 1024u, 2048u, 8192u}) {
        for (const std::size_t count : {shape - 1, shape, shape + 1, shape + 17}) {
            const std::vector<Photon> photons = uniform_photons(count);
            const PhotonBuckets tree(photons);
            EXPECT_EQ(tree.size(), count);
            EXPECT_EQ(tree.buckets(), (count + 15) / 16);
            for (const std::size_t k : {std::size_t{1}, count - 1, count, count + 1}) {
                const auto found = search(tree, {0.1f, 0.9f, 0.4f}, static_cast<std::uint32_t>(k));
                ASSERT_TRUE(same(found, brute_force(photons, {0.1f, 0.9f, 0.4f}, k, infinity)))
                    << count << " photons, k " << k;
            }
        }
    }
}

// What is raced and what is replayed as median-kd:leaf=16 are the same buckets.
TEST(PhotonBuckets, AreTheLeavesOfTheMedianTree) {
    const auto expect_the_same = [](const std::vector<Photon>& photons) {
        const PhotonBuckets raced(photons);
        const BucketKd replayed(photons, {.leaf_photons = PhotonBuckets::bucket_photons});
        const std::span<const std::uint32_t> begin = replayed.shape().leaf_begin();
        ASSERT_EQ(raced.buckets(), replayed.shape().leaves());
        for (std::size_t i = 0; i < raced.buckets(); ++i) {
            const std::span<const std::uint32_t> bucket = raced.bucket(i),
                                                 leaf = replayed.photon_at().subspan(begin[i],
                                                                                     begin[i + 1] - begin[i]);
            ASSERT_THAT(bucket, testing::UnorderedElementsAreArray(leaf.begin(), leaf.end()))
                << i << " of " << raced.buckets();
        }
    };
    for (const std::size_t count : {0, 1, 16, 17, 33, 129, 2049}) expect_the_same(clustered_photons(count));
    for (const auto cloud : {uniform_cloud, coplanar_photons, duplicate_photons, all_in_one_place, grid})
        expect_the_same(cloud(12345));
}

TEST(PhotonBuckets, NoPhotonsOnePhotonAndNoneAskedFor) {
    EXPECT_TRUE(search(PhotonBuckets({}), {0, 0, 0}, 5).empty());
    const PhotonBuckets one(photons_on_a_line({3}));
    ASSERT_EQ(search(one, {1, 0, 0}, 5).size(), 1u);
    EXPECT_EQ(search(one, {1, 0, 0}, 5)[0].distance2, 4.0f);
    EXPECT_TRUE(search(one, {1, 0, 0}, 0).empty());
}

TEST(PhotonBuckets, APhotonAtExactlyTheRadiusIsFound) {
    const PhotonBuckets line(photons_on_a_line({0, 1, 1, 2}));
    EXPECT_EQ(search(line, {1, 0, 0}, 9, 0).size(), 2u);
    EXPECT_EQ(search(line, {1, 0, 0}, 9, 1).size(), 4u);
    EXPECT_EQ(search(line, {1, 0, 0}, 9, std::nextafter(1.0f, 0.0f)).size(), 2u);
    EXPECT_TRUE(search(line, {1.5f, 0, 0}, 9, 0).empty());
}

TEST(PhotonBuckets, PointsThatAreNotFiniteFindNothingAndLeaveNothingBehind) {
    const PhotonBuckets tree(uniform_photons(50));
    Candidates found(10);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
        nearest(tree, {0, 0, 0}, found);
        EXPECT_EQ(found.size(), 10u);
        nearest(tree, {0, bad, 0}, found);
        EXPECT_EQ(found.size(), 0u);
    }
}

// 2e19 squared is beyond the range of float.
TEST(PhotonBuckets, DistancesThatOverflowAreTiesAtInfinity) {
    const std::vector<Photon> photons = left_balanced(photons_on_a_line(std::vector<float>(200, 2e19f)));
    const std::vector<Neighbor> found = search(PhotonBuckets(photons), {-2e19f, 0, 0}, 20);
    ASSERT_TRUE(same(found, brute_force(photons, {-2e19f, 0, 0}, 20, infinity)));
    EXPECT_EQ(found.size(), 20u);
    EXPECT_EQ(found[0].distance2, infinity);
}

TEST(PhotonBuckets, APhotonThatIsNotFiniteIsRefused) {
    std::vector<Photon> photons = uniform_photons(5);
    photons[3].position.y = infinity;
    EXPECT_THROW(PhotonBuckets{photons}, trace::DataError);
}

}  // namespace
}  // namespace regather::spatial
