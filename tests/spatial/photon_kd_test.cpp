#include "spatial/photons/photon_kd.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include <cstring>
#include <limits>

#include "tests/spatial/photons.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

TEST(PhotonKd, SevenPhotonsOnALineFormTheTreeDrawnByHand) {
    //            3            heap order: root 3, then 1 and 5, then 0 2 4 6
    //        1       5
    //      0   2   4   6
    const std::vector<Photon> heap = left_balanced(photons_on_a_line({6, 2, 4, 0, 5, 1, 3}));
    std::vector<float> x;
    for (const Photon& photon : heap) x.push_back(photon.position.x);
    EXPECT_EQ(x, (std::vector<float>{3, 1, 5, 0, 2, 4, 6}));
}

TEST(PhotonKd, TheLastLevelIsFilledFromTheLeft) {
    // Six photons: the root's left subtree has three, its right one two (a node with a left child alone).
    const std::vector<Photon> heap = left_balanced(photons_on_a_line({0, 1, 2, 3, 4, 5}));
    std::vector<float> x;
    for (const Photon& photon : heap) x.push_back(photon.position.x);
    EXPECT_EQ(x, (std::vector<float>{3, 1, 5, 0, 2, 4}));
}

TEST(PhotonKd, TheSplitAxisIsTheLongestSide) {
    std::vector<Photon> photons(3);
    photons[0].position = {0, 0, 0};
    photons[1].position = {1, 5, 2};
    photons[2].position = {1, 9, 2};
    EXPECT_EQ(PhotonKd::axis(left_balanced(photons)[0]), 1);
}

TEST(PhotonKd, EveryPhotonIsKeptAndOnItsSideOfEverySplit) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> photons = *any_photons(300);
        const std::vector<Photon> heap = left_balanced(photons);
        RC_ASSERT(sorted_positions(heap) == sorted_positions(photons));
        RC_ASSERT(first_disorder(PhotonKd(heap)) == heap.size());
    }));
}

TEST(PhotonKd, AMisplacedPhotonIsFound) {
    std::vector<Photon> heap = left_balanced(photons_on_a_line({0, 1, 2, 3, 4, 5, 6}));
    std::swap(heap[3], heap[6]);
    EXPECT_EQ(first_disorder(PhotonKd(heap)), 3u);
}

TEST(PhotonKd, TheTreeIsTheSameOnAnyNumberOfThreads) {
    const std::vector<Photon> photons = clustered_photons(50000);
    std::vector<Photon> one, two;
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        one = left_balanced(photons);
    }
    two = left_balanced(photons);
    EXPECT_EQ(0, std::memcmp(one.data(), two.data(), one.size() * sizeof(Photon)));
}

TEST(PhotonKd, PhotonsThatAreNotFiniteAreRefusedByNumber) {
    std::vector<Photon> photons(3);
    photons[1].position.y = std::numeric_limits<float>::quiet_NaN();
    try {
        left_balanced(photons);
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_NE(std::string(error.what()).find("photon 1"), std::string::npos);
    }
}

TEST(PhotonKd, NoPhotonsMakeAnEmptyTree) {
    EXPECT_TRUE(left_balanced({}).empty());
}

}  // namespace
}  // namespace regather::spatial
