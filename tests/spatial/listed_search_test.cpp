// Grids, octree and bounding volume hierarchy: the photons found are those that looking at every one finds,
// their list walks decode to the visits.
#include "spatial/photons/listed_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "spatial/photons/hashed_grid.h"
#include "spatial/photons/photon_bvh.h"
#include "spatial/photons/photon_grid.h"
#include "spatial/photons/photon_octree.h"
#include "tests/spatial/brute_force.h"
#include "tests/spatial/photons.h"
#include "tests/spatial/recorded_visits.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

using testing::ElementsAre;
using trace::Region;

template <class Index>
class ListedSearchOf : public testing::Test {};
using Indices = testing::Types<PhotonGrid, HashedGrid, PhotonOctree, PhotonBvh>;
TYPED_TEST_SUITE(ListedSearchOf, Indices);

TYPED_TEST(ListedSearchOf, FindsWhatLookingAtEveryPhotonFindsAndItsWalksDecode) {
    ASSERT_TRUE(rc::check([] {
        const std::vector<Photon> photons = *any_photons(200);
        const TypeParam index(photons, *rc::gen::inRange<std::uint32_t>(1, 20));
        const auto decoder = index.share_structure()->decoder();
        const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-4, 12)) * 0.5f; };
        const auto k = *rc::gen::inRange<std::uint32_t>(0, 30);
        const float radius = *rc::gen::element(infinity, 1.0f, 0.0f);
        NearestSet found(k, radius);
        RecordedVisits search;
        const Vec3 point{coordinate(), coordinate(), coordinate()};
        nearest(index, point, found, search);
        RC_ASSERT(same(found.nearest_first(), brute_force(photons, point, k, radius)));
        search.recorder.finish();
        const auto [fault, elements] = decoder->decode(search.recorder.bytes());
        RC_ASSERT(fault == WalkFault::none);
        RC_ASSERT(std::vector<std::uint32_t>(elements.begin(), elements.end()) == search.visited);
    }));
}

TYPED_TEST(ListedSearchOf, EveryCloudIsSearchedExactly) {
    std::vector<Photon> line = uniform_photons(900);
    for (Photon& p : line) p.position = {0.5f, p.position.y, 0.5f};
    std::vector<Photon> far = uniform_photons(60);
    for (std::size_t i = 0; i < 20; ++i) far[i].position = far[i].position * 3e38f;
    const std::vector<std::vector<Photon>> clouds{uniform_photons(2000),
                                                  clustered_photons(2000),
                                                  coplanar_photons(2000),
                                                  duplicate_photons(2000),
                                                  line,
                                                  std::vector<Photon>(500),
                                                  uniform_photons(1),
                                                  {},
                                                  far};
    Numbers numbers(3);
    for (const std::vector<Photon>& photons : clouds)
        for (const std::uint32_t bucket : {1u, 8u, 64u}) {
            const TypeParam index(photons, bucket);
            for (int q = 0; q < 30; ++q) {
                Vec3 point{numbers.uniform() * 1.5f - 0.25f, numbers.uniform(), numbers.uniform()};
                if (q % 3 == 0 && !photons.empty())
                    point = photons[static_cast<std::size_t>(q) % photons.size()].position;
                if (q == 29) point = {50, -70, 2};
                const std::uint32_t k = q % 2 == 0 ? 20 : 1;
                const float radius = q % 5 == 0 ? 0.1f : infinity;
                NearestSet found(k, radius);
                nearest(index, point, found);
                ASSERT_TRUE(same(found.nearest_first(), brute_force(photons, point, k, radius)))
                    << photons.size() << ' ' << bucket << ' ' << q;
            }
        }
}

TYPED_TEST(ListedSearchOf, PartsHoldEveryPhotonOnceBelowWhatLeadsToThem) {
    for (const auto& photons : {uniform_photons(3000), clustered_photons(3000), std::vector<Photon>(700)}) {
        const TypeParam index(photons, 8);
        std::vector<std::uint32_t> at(index.parts().photon_at().begin(), index.parts().photon_at().end());
        std::sort(at.begin(), at.end());
        std::vector<std::uint32_t> each(photons.size());
        std::iota(each.begin(), each.end(), 0u);
        EXPECT_EQ(at, each);
        const Listed& structure = *index.share_structure();
        const ElementRange parts = structure.range_of(Region::photons);
        EXPECT_EQ(parts.first + parts.count, structure.end());
        std::uint64_t held = 0;
        for (std::uint32_t e = parts.first; e < structure.end(); ++e) {
            EXPECT_TRUE(structure.records(e) >= 1 && structure.records(e) <= PhotonParts::most_photons);
            held += structure.records(e);
        }
        EXPECT_EQ(held, photons.size());
        // From the roots down everything is reached once.
        std::vector<std::uint32_t> reached = structure.roots();
        for (std::size_t i = 0; i < reached.size(); ++i) structure.append_children(reached[i], reached);
        EXPECT_EQ(reached.size(), structure.end());
    }
}

TYPED_TEST(ListedSearchOf, APointOrPhotonNowhereFindsNothingOrIsRefused) {
    std::vector<Photon> photons = uniform_photons(100);
    NearestSet found(5);
    RecordedVisits search;
    nearest(TypeParam(photons, 8), {0, infinity, 0}, found, search);
    EXPECT_EQ(found.size(), 0u);
    EXPECT_TRUE(search.visited.empty());
    photons[3].position.y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(TypeParam(photons, 8), trace::DataError);
}

TEST(ListedSearch, AGridsShellsAreThoseDrawnByHand) {
    // Five cells of 1 along x over photons at 0, 0.5, 1.5, 3.2 and 5: the cells hold two, one, none, one,
    // one.
    const PhotonGrid grid(photons_on_a_line({0, 0.5f, 1.5f, 3.2f, 5}), 1);
    ASSERT_EQ(grid.planes().cells(), 5u);
    const Listed& structure = *grid.share_structure();
    EXPECT_THAT(structure.ranges(),
                ElementsAre(ElementRange{Region::directory, 0, 5}, ElementRange{Region::photons, 5, 4}));
    EXPECT_THAT(structure.elements().parent, ElementsAre(0, 1, 2, 3, 4, 0, 1, 3, 4));
    EXPECT_EQ(structure.records(5), 2u);
    // From 2.6 the nearest photon is at 3.2. Its own cell, 2, is empty; then 1, whose photon is 1.1 away,
    // and 3. Shell 2 begins at 1 and 4, both farther than 0.6.
    NearestSet found(1);
    RecordedVisits search;
    nearest(grid, {2.6f, 0, 0}, found, search);
    EXPECT_THAT(search.visited, ElementsAre(2, 1, 6, 3, 7));
    EXPECT_EQ(found[0].node, 3u);
}

TEST(ListedSearch, AHashedGridReadsEntriesUpToTheCellOrAnEmptyOne) {
    const std::vector<Photon> photons = clustered_photons(3000);
    const HashedGrid grid(photons, 8);
    const auto entries = static_cast<std::uint32_t>(grid.entries().size());
    std::uint32_t used = 0;
    for (std::uint32_t at = 0; at < entries; ++at) {
        const HashedGrid::Entry& entry = grid.entries()[at];
        if (entry.cell == HashedGrid::no_cell) continue;
        ++used;
        // No entry between its home and it is empty.
        for (std::uint32_t step = grid.home(entry.cell); step != at; step = (step + 1) % entries)
            EXPECT_NE(grid.entries()[step].cell, HashedGrid::no_cell);
        for (std::uint32_t part = entry.first_part; part < entry.end_part; ++part)
            EXPECT_EQ(grid.share_structure()->elements().parent[entries + part], at);
    }
    EXPECT_GE(used, 3000u / 8);
    EXPECT_TRUE(2 * used <= entries && entries < 4 * used);
    // Far from all clusters shells soon have more cells than the table: it is read from end to end, once.
    NearestSet found(3000);
    RecordedVisits search;
    nearest(grid, {0.5f, 0.5f, 0.5f}, found, search);
    EXPECT_EQ(found.size(), 3000u);
    EXPECT_LT(search.visited.size(), 10 * std::size_t{entries});
}

TEST(ListedSearch, OctantsAreThoseDrawnByHand) {
    // Cube 0 .. 8; two photons share the octant below the middle, one lies in each of two others.
    std::vector<Photon> photons(4);
    photons[0].position = {8, 8, 8};
    photons[1].position = {0, 0, 0};
    photons[2].position = {1, 3, 5};
    photons[3].position = {3, 3, 3};
    const PhotonOctree tree(photons, 1);
    // Root: octants 0 (an inner node with 1 and 3), 1 (photon 2: only z is above 4), 7 (photon 0).
    EXPECT_EQ(tree.inner_nodes(), 2u);
    EXPECT_THAT(tree.parts().photon_at(), ElementsAre(1, 3, 2, 0));
    EXPECT_THAT(tree.share_structure()->elements().parent, ElementsAre(0, 0, 1, 1, 0, 0));
    EXPECT_EQ(tree.children(0)[0].octant, 0u);
    EXPECT_EQ(tree.children(0)[1].octant, 1u);
    EXPECT_EQ(tree.children(0)[2].octant, 7u);
    // (1, 3, 4.5) lies in octant 1, whose photon is 0.5 away. So is octant 0: it is entered; of its own
    // octants the one up to 2 is 1 away along y, the one from 2 on along x. Octant 7 is 3 away.
    NearestSet found(1);
    RecordedVisits search;
    nearest(tree, {1, 3, 4.5f}, found, search);
    EXPECT_EQ(found[0].node, 2u);
    EXPECT_THAT(search.visited, ElementsAre(0, 4, 1));
}

TEST(ListedSearch, ABvhsNodesHoldTheTightBoxesOfTheirChildren) {
    const PhotonBvh tree(photons_on_a_line({6, 0, 5, 1, 4, 2, 3}), 2);
    // Leaves of 0 1 | 2 3 | 4 5 | 6 below nodes 0, 1, 2; leaves are elements 3 to 6.
    EXPECT_EQ(tree.inner_nodes(), 3u);
    EXPECT_EQ(tree.node(0).box[0].max.x, 3);
    EXPECT_EQ(tree.node(0).box[1].min.x, 4);
    EXPECT_EQ(tree.node(2).box[1].min.x, 6);
    EXPECT_THAT(tree.share_structure()->elements().parent, ElementsAre(0, 0, 0, 1, 1, 2, 2));
    // From 3.4 node 1's box is 0.4 away: leaf 4 has photon 6 at 3. All else is farther than that.
    NearestSet found(1);
    RecordedVisits search;
    nearest(tree, {3.4f, 0, 0}, found, search);
    EXPECT_THAT(search.visited, ElementsAre(0, 1, 4));
    EXPECT_EQ(found[0].node, 6u);
}

}  // namespace
}  // namespace regather::spatial
