// The layouts by name: each a bijection without overlaps, the orders as drawn by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "replay/layouts/catalogue.h"
#include "replay/layouts/placement.h"
#include "spatial/photons/bucket_kd.h"
#include "spatial/photons/found_walk.h"
#include "spatial/photons/left_balanced.h"
#include "spatial/rays/ray_tree.h"
#include "tests/spatial/photons.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using spatial::LeftBalanced;
using testing::ElementsAre, testing::HasSubstr;

std::vector<std::string> all_specs() {
    std::vector<std::string> specs;
    for (const LayoutOrder& order : layout_orders())
        for (const PhotonRecord& record : photon_records())
            specs.push_back(std::string(order.name) + "-" + std::string(record.name));
    return specs;
}

TEST(Layouts, EachIsABijectionWithoutOverlaps) {
    const std::vector<std::string> specs = all_specs();
    ASSERT_TRUE(rc::check([&] {
        const auto photons = *rc::gen::inRange<std::uint32_t>(0, 300);
        const std::string spec = *rc::gen::elementOf(specs);
        std::shared_ptr<const spatial::Structure> tree = std::make_shared<LeftBalanced>(photons);
        if (spec.ends_with("-12+6") || *rc::gen::arbitrary<bool>())
            tree = spatial::BucketKd(spatial::uniform_photons(photons),
                                     {.leaf_photons = *rc::gen::inRange<std::uint32_t>(1, 9)})
                       .share_shape();
        const bool apart = spec.find('+') != spec.npos;
        if (apart) tree = std::make_shared<spatial::WithFound>(tree, "with");
        const std::vector<trace::Photon> cloud = spatial::uniform_photons(photons, 3);
        std::vector<trace::Vec3> positions;
        for (const trace::Photon& photon : cloud) positions.push_back(photon.position);
        const Layout layout = make_layout(spec, *tree, positions);
        std::vector<Extent> extents;
        for (const spatial::ElementRange& range : tree->ranges())
            for (std::uint32_t e = range.first; e < range.first + range.count; ++e)
                extents.push_back(layout.extent(e));
        std::sort(extents.begin(), extents.end(),
                  [](const Extent& a, const Extent& b) { return a.address < b.address; });
        for (std::size_t i = 0; i < extents.size(); ++i) {
            RC_ASSERT(extents[i].bytes > 0u);
            if (i > 0) RC_ASSERT(extents[i - 1].address + extents[i - 1].bytes <= extents[i].address);
        }
        if (extents.empty()) return;
        RC_ASSERT(layout.first_byte() == extents.front().address);
        RC_ASSERT(layout.end_byte() == extents.back().address + extents.back().bytes);
    }));
}

TEST(Layouts, OrdersAreThoseDrawnByHand) {
    // Ten nodes in four levels: 1 | 2 3 | 4 5 6 7 | 8 9 10.
    const LeftBalanced tree(10);
    EXPECT_THAT(heap_order(tree).elements, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
    EXPECT_THAT(breadth_first_order(tree).elements, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
    EXPECT_THAT(depth_first_order(tree).elements, ElementsAre(1, 2, 4, 8, 9, 5, 10, 3, 6, 7));
    // Two upper levels, then the subtrees of two levels below 4, 5, 6 and 7.
    EXPECT_THAT(van_emde_boas_order(tree).elements, ElementsAre(1, 2, 3, 4, 8, 9, 5, 10, 6, 7));
    // Five levels are two and three: the lower three are one and two.
    EXPECT_THAT(van_emde_boas_order(LeftBalanced(17)).elements,
                ElementsAre(1, 2, 3, 4, 8, 16, 17, 9, 5, 10, 11, 6, 12, 13, 7, 14, 15));
}

TEST(Layouts, AlongACurveElementsLieAsTheirPhotonsDo) {
    // The eight corners of a cube, z fastest: the heap's elements 1 to 8.
    std::vector<trace::Vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(
            {static_cast<float>(i / 4), static_cast<float>(i / 2 % 2), static_cast<float>(i % 2)});
    std::swap(corners[1], corners[6]);
    const LeftBalanced tree(8);
    EXPECT_THAT(curve_order(tree, corners, SpaceCurve::morton).elements, ElementsAre(1, 7, 3, 4, 5, 6, 2, 8));
    const std::vector<std::uint32_t> hilbert = curve_order(tree, corners, SpaceCurve::hilbert).elements;
    for (std::size_t i = 1; i < hilbert.size(); ++i) {
        const trace::Vec3 step = corners[hilbert[i] - 1] - corners[hilbert[i - 1] - 1];
        EXPECT_EQ(trace::dot(step, step), 1) << "from corner to corner along an edge";
    }
    // Leaves by the middle of their photons: 0 1 at 9.5, 2 3 at 3, and node 0 before them.
    const spatial::BucketKd buckets(spatial::photons_on_a_line({0, 1, 2, 3}), {.leaf_photons = 2});
    const std::vector<trace::Vec3> moved{{9, 0, 0}, {10, 0, 0}, {1, 0, 0}, {5, 0, 0}};
    EXPECT_THAT(curve_order(buckets.shape(), moved, SpaceCurve::morton).elements, ElementsAre(0, 2, 1));
}

TEST(Layouts, ClustersFillALine) {
    // Three photons of 20 bytes on a line of 64: 1 2 3, and then 4 with 8 and 9, 5 with 10; 6 and 7 alone.
    const LeftBalanced tree(10);
    const auto twenty = [](std::uint32_t) { return 20u; };
    const Placement placement = clustered_order(tree, 64, twenty);
    EXPECT_THAT(placement.elements, ElementsAre(1, 2, 3, 4, 8, 9, 5, 10, 6, 7));
    EXPECT_THAT(placement.group_begins, ElementsAre(0, 3, 6, 8, 9));
    // 5 and 10 begin the third line, 6 stands behind them on it, 7 would lie on two.
    const Layout layout = make_layout("clusters-20:line=64", tree);
    std::vector<std::uint64_t> addresses;
    for (const std::uint32_t e : placement.elements) addresses.push_back(layout.extent(e).address);
    EXPECT_THAT(addresses, ElementsAre(0, 20, 40, 64, 84, 104, 128, 148, 168, 192));
    EXPECT_EQ(layout.name(), "clusters-20:line=64");
}

TEST(Layouts, NoGroupThatFitsLiesOnTwoLines) {
    for (const std::uint32_t line : {32u, 64u, 128u, 256u})
        for (const std::uint32_t photons : {1u, 6u, 100u, 1023u, 1500u}) {
            const LeftBalanced tree(photons);
            const Placement placement = clustered_order(tree, line, [](std::uint32_t) { return 20u; });
            const Layout layout = make_layout("clusters-20:line=" + std::to_string(line), tree);
            for (std::size_t g = 0; g < placement.group_begins.size(); ++g) {
                const std::size_t end = g + 1 < placement.group_begins.size() ? placement.group_begins[g + 1]
                                                                              : placement.elements.size();
                const Extent first = layout.extent(placement.elements[placement.group_begins[g]]),
                             last = layout.extent(placement.elements[end - 1]);
                EXPECT_EQ(first.address / line, (last.address + last.bytes - 1) / line)
                    << line << ' ' << photons;
            }
        }
}

TEST(Layouts, RecordsAreAsFarApartAsTheySay) {
    const LeftBalanced tree(3);
    EXPECT_EQ(make_layout("heap-20", tree).extent(3), (Extent{40, 20}));
    EXPECT_EQ(make_layout("heap-32", tree).extent(3), (Extent{64, 20}));
    EXPECT_EQ(make_layout("heap-16", tree).extent(3), (Extent{32, 16}));
    EXPECT_EQ(make_layout("depth-first-32", tree).extent(2), (Extent{32, 20}));
}

TEST(Layouts, WhatIsApartFollowsItsPhotons) {
    // Leaves of 0 1 | 2 3 | 4 5 | 6 below nodes 0, 1, 2; leaves are elements 3 to 6, power 7 to 13.
    const spatial::BucketKd buckets(spatial::photons_on_a_line({0, 1, 2, 3, 4, 5, 6}), {.leaf_photons = 2});
    const spatial::WithFound tree(buckets.share_shape(), "with");
    const Layout layout = make_layout("depth-first-12+6:node=6", tree);
    EXPECT_EQ(layout.name(), "depth-first-12+6:node=6");
    EXPECT_EQ(layout.extent(2), (Extent{12, 6}));
    EXPECT_EQ(layout.extent(4), (Extent{4096 + 24, 24}));
    EXPECT_EQ(layout.extent(6), (Extent{4096 + 72, 12}));
    EXPECT_EQ(layout.extent(7), (Extent{8192, 6}));
    EXPECT_EQ(layout.extent(13), (Extent{8192 + 36, 6}));
    EXPECT_EQ(layout.region(13), trace::Region::photon_power);
    EXPECT_EQ(make_layout("depth-first-20", tree).extent(13).bytes, 0u) << "read with the photon";
    EXPECT_EQ(make_layout("depth-first-12+6:top=3", tree).bytes(std::vector<std::uint32_t>{0, 3, 7}), 6u);
    // In the heap of five, 2 and its power stand before 3 in depth-first order behind 4 and 5.
    const spatial::WithFound heap(std::make_shared<LeftBalanced>(5), "with");
    EXPECT_EQ(make_layout("depth-first-14+6", heap).extent(6 + 2 - 1), (Extent{4096 + 6, 6}));
    EXPECT_EQ(make_layout("depth-first-14+6", heap).extent(6 + 3 - 1), (Extent{4096 + 24, 6}));
}

// Nodes 0 {1, 2}, 1 {3, 4}, 2 {5, 6}; leaves 3 to 6 with 2, 1, 1 and 3 triangles; one place of the stack.
spatial::RayTree seven_for_rays(bool quantised = false) {
    return {
        "seven",
        {.width = 2, .children = {1, 2, 3, 4, 5, 6}, .leaf_begin = {0, 2, 3, 4, 7}, .quantised = quantised},
        {.on_chip = 1, .any_hit = false}};
}

TEST(Layouts, RaysReadNodesTrianglesAndTheStack) {
    const spatial::RayTree tree = seven_for_rays();
    const Layout usual = usual_layout(tree);
    EXPECT_EQ(usual.name(), "depth-first-48:node=64");
    EXPECT_EQ(usual_layout(LeftBalanced(3)).name(), "heap-20");
    EXPECT_EQ(usual.extent(2), (Extent{128, 64}));
    EXPECT_EQ(usual.extent(3), (Extent{4096, 96}));
    EXPECT_EQ(usual.extent(6), (Extent{4096 + 4 * 48, 144}));
    EXPECT_EQ(usual.extent(7), (Extent{8192, 8}));
    EXPECT_EQ(usual.region(3), trace::Region::triangles);
    EXPECT_EQ(usual.region(7), trace::Region::stack);
    EXPECT_EQ(make_layout("heap-36:node=128", tree).extent(4), (Extent{4096 + 72, 36}));
    EXPECT_EQ(make_layout("heap-36", seven_for_rays(true)).extent(2), (Extent{64, 32}));
    // Nodes and leaves of the upper levels are on chip, the stack is not.
    const Layout top = make_layout("depth-first-48:top=2", tree);
    EXPECT_EQ(top.bytes(std::vector<std::uint32_t>{0, 1, 2, 3, 7}), 96u + 8u);
    for (const LayoutOrder& order : layout_orders()) {
        if (order.name == "hilbert" || order.name == "morton") continue;  // of photons
        const Layout layout = make_layout(std::string(order.name) + "-36", tree);
        std::vector<Extent> extents;
        for (std::uint32_t e = 0; e < tree.end(); ++e) extents.push_back(layout.extent(e));
        std::sort(extents.begin(), extents.end(),
                  [](const Extent& a, const Extent& b) { return a.address < b.address; });
        for (std::size_t i = 1; i < extents.size(); ++i)
            EXPECT_LE(extents[i - 1].address + extents[i - 1].bytes, extents[i].address) << order.name;
    }
    for (const auto& [spec, part] : {std::pair("heap-20", "unknown record of a triangle \"20\""),
                                     std::pair("heap-48:node=60", "node is 60, expected 64 to 1024")})
        try {
            make_layout(spec, tree);
            ADD_FAILURE() << spec << " was taken";
        } catch (const trace::UsageError& error) {
            EXPECT_THAT(error.what(), HasSubstr(part));
        }
}

TEST(Layouts, TheTopLevelsReadNothing) {
    const LeftBalanced tree(10);
    for (const char* order : {"heap", "depth-first", "clusters"}) {
        const Layout layout = make_layout(std::string(order) + "-20:top=2", tree);
        for (std::uint32_t e = 1; e <= 10; ++e)
            EXPECT_EQ(layout.extent(e).bytes, e <= 3 ? 0u : 20u) << order << e;
        const std::vector<std::uint32_t> walk{1, 3, 6, 2, 4, 9};
        EXPECT_EQ(layout.bytes(walk), 60u);
        std::vector<std::uint32_t> read;
        layout.for_each(walk, [&](std::uint32_t e, std::uint64_t, std::uint32_t) { read.push_back(e); });
        EXPECT_THAT(read, ElementsAre(6, 4, 9));
    }
    EXPECT_EQ(make_layout("clusters-20:top=3", tree).name(), "clusters-20:line=128,top=3");
}

TEST(Layouts, WhatIsNotInTheTablesIsRefused) {
    const LeftBalanced tree(3);
    const auto refused = [&](const char* spec, const char* part) {
        try {
            make_layout(spec, tree);
            ADD_FAILURE() << spec << " was taken";
        } catch (const trace::UsageError& error) {
            EXPECT_THAT(error.what(), HasSubstr(part)) << spec;
        }
    };
    refused("heap", "ORDER-RECORD");
    refused("heaps-20", "nearest: heap");
    refused("heap-24", "unknown record \"24\"");
    refused("heap-20:lines=3", "nearest: line");
    refused("clusters-20:line=96", "power of two");
    refused("clusters-20:line=8", "line");
    refused("heap-20:top=41", "top");
    refused("heap-14+6", "expected found=1");
    refused("hilbert-20", "without positions");
    try {
        make_layout("heap-12+6", spatial::WithFound(std::make_shared<LeftBalanced>(3), "heap"));
        ADD_FAILURE() << "taken";
    } catch (const trace::UsageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("whose photons are inner nodes"));
    }
}

}  // namespace
}  // namespace regather::replay
