// Attribution of one replay: drawn by hand on four photons, and equal to the plain replays on many.
#include "replay/detail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "reorder/catalogue.h"
#include "replay/buffered.h"
#include "spatial/photons/left_balanced.h"
#include "spatial/photons/recording.h"
#include "tests/spatial/photons.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using cachesim::CacheConfig, cachesim::ClassStats;
using trace::Region;

struct Traced {
    std::vector<trace::Photon> heap;
    std::vector<trace::Vec3> points, directions;
    std::vector<std::uint32_t> pixels, leaves;
    std::uint32_t width;
    std::shared_ptr<const spatial::Structure> tree;
    spatial::Recording recording;

    Traced(std::size_t photons, std::uint32_t image_width, std::size_t queries, std::uint32_t k)
        : heap(spatial::left_balanced(spatial::uniform_photons(photons))),
          width(image_width),
          tree(std::make_shared<spatial::LeftBalanced>(static_cast<std::uint32_t>(photons))) {
        spatial::Numbers numbers(11);
        const auto coordinate = [&] { return numbers.uniform(); };
        for (std::size_t q = 0; q < queries; ++q) {
            points.push_back({coordinate(), coordinate(), coordinate()});
            directions.push_back({coordinate() - 0.5f, coordinate() - 0.5f, coordinate() - 0.5f});
            pixels.push_back(static_cast<std::uint32_t>(q * width * width / queries));
            leaves.push_back(static_cast<std::uint32_t>(q % 7));
        }
        recording = spatial::record_walks(spatial::PhotonKd(heap), points, k, 1e9f);
    }
    WalkStore walks() const { return {tree, recording.walk_bytes, recording.walks}; }
    Layout layout() const { return heap_20(*tree); }
    reorder::Workload work() const {
        return {.position = points,
                .direction = directions,
                .pixel = pixels,
                .leaf_kd = leaves,
                .leaf_bvh = leaves,
                .end = points,
                .guess = points,
                .bounds = trace::bounds_of(points),
                .image_width = width,
                .image_height = width};
    }
};

const Traced& many() {
    static const Traced traced(3000, 12, 600, 20);
    return traced;
}

std::vector<std::uint32_t> in_capture_order(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

TEST(Detail, FourPhotonsOn64ByteLinesAreThoseDrawnByHand) {
    // Nodes at bytes 0, 20, 40 and 60: the fourth, at depth 2, straddles lines 0 and 1.
    const Traced traced(4, 1, 1, 4);
    const Detail detail = replay_in_detail(traced.walks(), traced.layout(), in_capture_order(1), {},
                                           {.cache = {1024, 64, 2}, .slices = 1});
    ASSERT_EQ(detail.parts.size(), 4u);
    for (std::uint32_t depth = 0; depth < 3; ++depth) EXPECT_EQ(detail.parts[depth].depth, depth);
    EXPECT_EQ(detail.parts[0].stats,
              (ClassStats{{1, 0, 0}, 1, 1, 0, 64}));  // line 0: three nodes and four bytes
    EXPECT_EQ(detail.parts[0].traffic_bytes, 64u);
    EXPECT_EQ(detail.parts[1].stats, (ClassStats{{0, 0, 0}, 2, 0, 0, 0}));
    EXPECT_EQ(detail.parts[2].stats, (ClassStats{{1, 0, 0}, 2, 1, 0, 16}));
    EXPECT_EQ(detail.parts[2].traffic_bytes, 64u);
    EXPECT_EQ(detail.parts[3].region, Region::reorder_buffer);
    EXPECT_EQ(detail.parts[3].stats, ClassStats{});
    ASSERT_EQ(detail.slices.size(), 1u);
    EXPECT_EQ(detail.slices[0].accesses, 5u);
    EXPECT_EQ(detail.slices[0].misses, 2u);
}

TEST(Detail, WithoutBuffersTotalsAreThoseOfThePlainReplay) {
    const auto order = reorder::order(*reorder::make_ordering("random"), many().work()).permutation;
    const ReplayConfig config{
        {{4096, 128, 8}, {2048, 64, 1}, {1024, 16, 4}, {8192, 128, 0}, {1 << 20, 256, 2}}, true};
    const Revisits revisits = count_revisits(many().walks(), many().layout(), config);
    for (const CacheTraffic& plain :
         replay(many().walks(), many().layout(), order, config, revisits).caches) {
        const CacheConfig& cache = plain.config;
        const Detail detail = replay_in_detail(many().walks(), many().layout(), order, {}, {.cache = cache});
        const ClassStats sum = detail.sum();
        EXPECT_EQ(sum.accesses, plain.accesses);
        EXPECT_EQ(sum.misses, plain.misses);
        EXPECT_EQ(detail.traffic_bytes(), plain.traffic_bytes);
        EXPECT_EQ(sum.compulsory + sum.capacity + sum.conflict, sum.misses);
        ASSERT_TRUE(plain.classes);
        EXPECT_EQ(*plain.classes, (MissClasses{sum.compulsory, sum.capacity, sum.conflict}));
        EXPECT_LE(sum.used_bytes, detail.traffic_bytes());
        EXPECT_EQ(sum.compulsory * cache.line_bytes,
                  compulsory_bytes(touched_elements(many().walks()), many().layout(), cache.line_bytes));
        const auto buffered =
            replay_with_buffers(many().walks(), many().layout(), order, {}, std::span(&cache, 1));
        EXPECT_EQ(buffered[0].photon_bytes, plain.traffic_bytes);
        EXPECT_EQ(buffered[0].buffer_bytes, 0u);
    }
}

TEST(Detail, BuffersMissAsInTheFastCachesForEveryOrdering) {
    const std::vector<CacheConfig> caches{
        {4096, 128, 8}, {2048, 64, 1}, {16384, 128, 4}, {8192, 256, 0}, {1 << 20, 64, 16}};
    std::vector<std::string> specs{"hilbert:tile=4", "hashed:buckets=16,capacity=4",
                                   "direction-binned:tile=6,bins=3", "direction-binned+hashed:tile=6,bins=3"};
    for (const reorder::Entry& entry : reorder::catalogue()) specs.emplace_back(entry.name);
    for (const std::string& spec : specs) {
        const auto ordering = reorder::make_ordering(spec);
        constexpr std::uint64_t onchip = 60;
        const reorder::Ordered ordered = reorder::order(*ordering, many().work(), onchip);
        const reorder::BufferUse use = ordering->buffer_use(many().work(), onchip, ordered.permutation);
        const auto fast =
            replay_with_buffers(many().walks(), many().layout(), ordered.permutation, use, caches);
        ASSERT_EQ(fast.size(), caches.size());
        for (std::size_t c = 0; c < caches.size(); ++c) {
            const Detail detail = replay_in_detail(many().walks(), many().layout(), ordered.permutation, use,
                                                   {.cache = caches[c]});
            const ClassStats photons = detail.sum(Region::photons),
                             buffers = detail.sum(Region::reorder_buffer);
            EXPECT_EQ(fast[c].config.size_bytes, caches[c].size_bytes);
            EXPECT_EQ(fast[c].photons, (cachesim::CacheStats{photons.accesses, photons.misses, 0})) << spec;
            EXPECT_EQ(fast[c].buffers,
                      (cachesim::CacheStats{buffers.accesses, buffers.misses, buffers.writebacks}))
                << spec;
            EXPECT_EQ(fast[c].photon_bytes, detail.traffic_bytes(Region::photons));
            EXPECT_EQ(fast[c].buffer_bytes, detail.traffic_bytes(Region::reorder_buffer));
            EXPECT_EQ(detail.traffic_bytes(), fast[c].photon_bytes + fast[c].buffer_bytes);
            EXPECT_EQ(buffers.accesses > 0, ordered.cost.reorder_bytes > 0) << spec;
            EXPECT_LE(detail.sum().used_bytes, detail.traffic_bytes());
        }
    }
}

TEST(Detail, InACacheThatHoldsAllBuffersShareNoLineWithPhotons) {
    // 600 records of 28 bytes are 131.25 lines of 128; each is fetched once and written back once.
    const auto hilbert = reorder::make_ordering("hilbert");
    const reorder::Ordered ordered = reorder::order(*hilbert, many().work(), 1000);
    const reorder::BufferUse use = hilbert->buffer_use(many().work(), 1000, ordered.permutation);
    const CacheConfig cache{1 << 20, 128, 0};
    const Detail detail =
        replay_in_detail(many().walks(), many().layout(), ordered.permutation, use, {.cache = cache});
    EXPECT_EQ(detail.traffic_bytes(Region::reorder_buffer), 2 * 132 * 128u);
    EXPECT_EQ(detail.sum(Region::reorder_buffer).used_bytes, 600 * 28u);
    EXPECT_EQ(detail.traffic_bytes(Region::photons),
              compulsory_bytes(touched_elements(many().walks()), many().layout(), 128));
}

TEST(Detail, SlicesAreEqualPartsOfTheRunAndSumToTheTotals) {
    const auto order = in_capture_order(600);
    for (const std::uint64_t wanted : {1u, 7u, 600u, 5000u}) {
        const Detail detail = replay_in_detail(many().walks(), many().layout(), order, {},
                                               {.cache = {4096, 128, 8}, .slices = wanted});
        const std::uint64_t slices = std::min<std::uint64_t>(wanted, 600);
        ASSERT_EQ(detail.slices.size(), slices);
        std::uint64_t queries = 0, accesses = 0, misses = 0;
        for (const DetailSlice& slice : detail.slices) {
            EXPECT_EQ(slice.first_query, queries);
            EXPECT_GE(slice.queries, 600 / slices);
            EXPECT_LE(slice.queries, (600 + slices - 1) / slices);
            queries += slice.queries;
            accesses += slice.accesses;
            misses += slice.misses;
        }
        EXPECT_EQ(queries, 600u);
        EXPECT_EQ(accesses, detail.sum().accesses);
        EXPECT_EQ(misses, detail.sum().misses);
    }
    // The first query finds the cache empty, so it misses what it would miss alone.
    const Detail each = replay_in_detail(many().walks(), many().layout(), order, {},
                                         {.cache = {4096, 128, 8}, .slices = 600});
    const Detail alone =
        replay_in_detail(many().walks(), many().layout(), in_capture_order(1), {}, {.cache = {4096, 128, 8}});
    EXPECT_EQ(each.slices[0].misses, alone.sum().misses);
}

TEST(Detail, NoQueriesNoSlicesAndNoSlicesAreRefused) {
    const Traced none(10, 1, 0, 3);
    const Detail detail = replay_in_detail(none.walks(), none.layout(), {}, {}, {.cache = {1024, 64, 2}});
    EXPECT_TRUE(detail.slices.empty());
    EXPECT_EQ(detail.sum(), ClassStats{});
    EXPECT_THROW(replay_in_detail(none.walks(), none.layout(), {}, {}, {.cache = {1024, 64, 2}, .slices = 0}),
                 trace::UsageError);
}

}  // namespace
}  // namespace regather::replay
