// First touches that are held are those of WalkLines, and a replay that reads them counts what one that
// decodes every walk does.
#include "replay/first_touches.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/replay/traced.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

constexpr std::uint64_t everything = std::uint64_t{1} << 30, one_chunk = std::uint64_t{34} << 20;

struct First {
    std::vector<cachesim::Line> lines;
    std::vector<std::uint32_t> last_rank;
    explicit First(const WalkLines::First& of)
        : lines(of.lines.begin(), of.lines.end()), last_rank(of.last_rank.begin(), of.last_rank.end()) {}
    friend bool operator==(const First&, const First&) = default;
};

std::vector<std::uint32_t> slots_of(const Searched& traced, std::uint32_t query) {
    std::vector<std::uint32_t> slots = traced.nodes_of(query);
    for (std::uint32_t& slot : slots) ++slot;
    return slots;
}

TEST(FirstTouches, AreThoseOfWalkLinesInAnyLayoutAndSizeOfLine) {
    const Searched traced(2000, 25, 15), alone(1, 4, 3), none(0, 3, 2);  // the last: walks without a visit
    ASSERT_TRUE(rc::check("read in any order, again and again", [&] {
        const Searched& searched = **rc::gen::element(&traced, &traced, &traced, &alone, &none);
        Placed placed;
        placed.scattered = *rc::gen::arbitrary<bool>();
        placed.used_bytes = *rc::gen::inRange<std::uint32_t>(1, 70);
        placed.stride_bytes = placed.used_bytes + *rc::gen::element(0u, 1u, 12u, 100u);
        placed.base = *rc::gen::element<std::uint64_t>(0, 1, 4095, std::uint64_t{1} << 40);
        const Layout layout = searched.layout(placed);
        std::vector<std::uint32_t> line_sizes;
        for (std::uint32_t bytes = 1; bytes <= 256; bytes *= 2)
            if (*rc::gen::inRange(0, 3) == 0) line_sizes.push_back(bytes);
        const FirstTouches held(searched.walks(), layout, line_sizes, everything);
        const auto queries = static_cast<std::uint32_t>(searched.points.size());
        RC_ASSERT(held.held_queries() == (line_sizes.empty() ? 0 : queries));

        FirstTouches::Totals expected;
        expected.accesses.resize(line_sizes.size());
        FirstTouches::Reader reader(held);
        for (int reads = 0; reads < 2; ++reads)
            for (const std::uint32_t query : shuffled_queries(queries, 5)) {
                const std::vector<std::uint32_t> slots = slots_of(searched, query);
                if (reads == 0) expected.visited_nodes += slots.size();
                if (reads == 0) expected.raw_bytes += layout.bytes(slots);
                std::vector<First> found;
                if (held.holds(query))
                    reader.read(query, [&](std::size_t s, const WalkLines::First& first) {
                        RC_ASSERT(s == found.size());
                        found.emplace_back(first);
                    });
                RC_ASSERT(found.size() == line_sizes.size());
                for (std::size_t s = 0; s < line_sizes.size(); ++s) {
                    WalkLines lines(layout, line_sizes[s]);
                    const std::span<const cachesim::Line> touches = lines.touches(slots);
                    if (reads == 0) expected.accesses[s] += touches.size();
                    RC_ASSERT(found[s] == First(lines.first(touches)));
                }
            }
        RC_ASSERT(held.totals().visited_nodes == expected.visited_nodes);
        RC_ASSERT(held.totals().raw_bytes == expected.raw_bytes);
        RC_ASSERT(held.totals().accesses == expected.accesses);
    }));
}

void expect_same(const Replayed& a, const Replayed& b) {
    EXPECT_EQ(a.visited_nodes, b.visited_nodes);
    EXPECT_EQ(a.raw_bytes, b.raw_bytes);
    ASSERT_EQ(a.caches.size(), b.caches.size());
    for (std::size_t c = 0; c < a.caches.size(); ++c) {
        EXPECT_EQ(a.caches[c].accesses, b.caches[c].accesses) << c;
        EXPECT_EQ(a.caches[c].misses, b.caches[c].misses) << c;
        EXPECT_EQ(a.caches[c].traffic_bytes, b.caches[c].traffic_bytes) << c;
        EXPECT_EQ(a.caches[c].classes, b.caches[c].classes) << c;
    }
}

TEST(FirstTouches, AReplayThatReadsThemCountsTheSame) {
    const Searched traced(3000, 300, 20);
    const WalkStore walks = traced.walks();
    const Layout layout = traced.layout();
    const std::vector<std::uint32_t> order = shuffled_queries(300, 3), lines{128, 16, 64, 32};
    const FirstTouches held(walks, layout, lines, everything),
        other(walks, layout, std::span(lines).first(2), everything);
    EXPECT_GT(held.bytes(), 0u);
    const std::vector<cachesim::CacheConfig> served{{4096, 128, 8}, {2048, 64, 2}, {16384, 128, 0},
                                                    {1024, 16, 32}, {512, 128, 1}, {3072, 64, 3}};
    std::vector<cachesim::CacheConfig> one{{4096, 128, 8}}, wide = served;
    wide.push_back({4 * 40 * 128, 128, 40});  // no family serves it: it wants every touch
    for (const auto& caches : {served, one, wide})
        for (const bool classes : {false, true})
            for (const bool together : {false, true}) {
                const ReplayConfig config{caches, classes, together}, plain{caches, classes};
                const Revisits revisits = count_revisits(walks, layout, config);
                const Replayed expected =
                    replay(walks, layout, order, plain, count_revisits(walks, layout, plain));
                expect_same(replay(walks, layout, order, config, revisits, held), expected);
                expect_same(replay(walks, layout, order, config, revisits, other), expected);
                expect_same(replay(walks, layout, order, config, revisits), expected);
            }
}

TEST(FirstTouches, WalksThatDoNotFitAreDecoded) {
    const Searched traced(3000, 9000, 200);
    const WalkStore walks = traced.walks();
    const Layout layout = traced.layout();
    const std::vector<std::uint32_t> lines{8}, order = shuffled_queries(9000, 7);
    const ReplayConfig config{{{4096, 8, 4}, {65536, 8, 0}}, true};
    const Revisits revisits = count_revisits(walks, layout, config);
    const Replayed expected = replay(walks, layout, order, config, revisits);
    const FirstTouches all(walks, layout, lines, everything), some(walks, layout, lines, one_chunk),
        none(walks, layout, lines, 9000), nothing(walks, layout, lines, 0);
    EXPECT_EQ(all.held_queries(), 9000u);
    ASSERT_GT(all.bytes(), one_chunk);
    EXPECT_GT(some.held_queries(), 0u);
    EXPECT_LT(some.held_queries(), 9000u);
    EXPECT_LE(some.bytes(), one_chunk);
    EXPECT_EQ(none.held_queries(), 0u);
    EXPECT_EQ(nothing.held_queries(), 0u);
    EXPECT_EQ(nothing.bytes(), 0u);
    for (const FirstTouches* held : {&some, &none, &nothing}) {
        std::uint64_t holds = 0;
        for (std::uint64_t query = 0; query < 9100; ++query) holds += held->holds(query);
        EXPECT_EQ(holds, held->held_queries());
        expect_same(replay(walks, layout, order, config, revisits, *held), expected);
    }
}

TEST(FirstTouches, ADamagedWalkIsRefused) {
    Searched traced(1000, 50, 10);
    std::uint64_t start = 0;
    for (std::size_t q = 0; q < 30; ++q) start += traced.recording.walk_bytes[q];
    for (std::uint32_t b = 0; b < traced.recording.walk_bytes[30]; ++b) traced.recording.walks[start + b] = 0;
    const std::vector<std::uint32_t> lines{128};
    EXPECT_THROW(FirstTouches(traced.walks(), traced.layout(), lines, everything), trace::DataError);
}

}  // namespace
}  // namespace regather::replay
