// When and where an ordering's buffers are accessed: drawn by hand, and for every ordering.
#include "replay/buffer_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "reorder/catalogue.h"
#include "tests/reorder/buffer_bytes.h"
#include "tests/reorder/workload.h"

namespace regather::cachesim {

static void PrintTo(const ByteAccess& access, std::ostream* out) {
    *out << (access.kind == Access::read ? "R" : "W") << access.address << '+' << access.bytes;
}

}  // namespace regather::cachesim

namespace regather::replay {
namespace {

using cachesim::Access, cachesim::ByteAccess;
using testing::ElementsAre;
using Accesses = std::vector<ByteAccess>;

/// Before each search, and after the last one.
std::vector<Accesses> played(const reorder::BufferUse& use, std::span<const std::uint32_t> permutation) {
    BufferStream stream(use, permutation);
    std::vector<Accesses> steps(permutation.size() + 1);
    for (std::size_t r = 0; r <= permutation.size(); ++r) {
        const auto sink = [&](std::span<const ByteAccess> more) {
            steps[r].insert(steps[r].end(), more.begin(), more.end());
        };
        r < permutation.size() ? stream.before(r, sink) : stream.finish(sink);
    }
    return steps;
}

/// Drawn as "W28 R0": accesses of `bytes` each.
Accesses drawn(std::string_view text, std::uint64_t bytes) {
    Accesses accesses;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        accesses.push_back({std::stoull(std::string(text.substr(at + 1, end - at - 1))), bytes,
                            text[at] == 'W' ? Access::write : Access::read});
        at = end + 1;
    }
    return accesses;
}

void expect_played(const reorder::BufferUse& use, std::span<const std::uint32_t> permutation,
                   std::uint64_t bytes, std::span<const std::string_view> expected) {
    const std::vector<Accesses> steps = played(use, permutation);
    ASSERT_EQ(steps.size(), expected.size());
    for (std::size_t r = 0; r < steps.size(); ++r)
        EXPECT_EQ(steps[r], drawn(expected[r], bytes)) << "search " << r;
}

reorder::BufferUse batches(std::uint32_t rounds, std::vector<std::uint64_t> ends) {
    reorder::BufferUse use;
    use.batches = reorder::SortedBatches{28, rounds, std::move(ends)};
    return use;
}

TEST(BufferStream, ABatchIsWrittenInCaptureOrderAndReadInStepAndItsMemoryIsUsedAgain) {
    // Ranks in the first batch: query 0 is second, 1 third, 2 first.
    constexpr std::uint32_t permutation[] = {2, 0, 1, 4, 3};
    constexpr std::string_view expected[] = {"W28 W56 W0 R0", "R28", "R56", "W28 W0 R0", "R28", ""};
    expect_played(batches(1, {3, 5}), permutation, 28, expected);
}

TEST(BufferStream, AFurtherRoundReadsPlaceByPlaceAndWritesASecondArray) {
    constexpr std::uint32_t permutation[] = {1, 0};
    constexpr std::string_view two[] = {"W28 W0 R0 W4096 R28 W4124 R4096", "R4124", ""};
    expect_played(batches(2, {2}), permutation, 28, two);
    constexpr std::string_view three[] = {"W28 W0 R0 W4096 R28 W4124 R4096 W0 R4124 W28 R0", "R28", ""};
    expect_played(batches(3, {2}), permutation, 28, three);
}

TEST(BufferStream, ThePartsOfADistributionKeepCaptureOrder) {
    // 512 queries run backwards: parts of two records, which arrive in the wrong order.
    std::vector<std::uint32_t> permutation(512);
    for (std::uint32_t r = 0; r < 512; ++r) permutation[r] = 511 - r;
    const Accesses one = played(batches(1, {512}), permutation)[0];
    ASSERT_EQ(one.size(), 513u);
    for (std::uint64_t q = 0; q < 512; ++q) EXPECT_EQ(one[q].address, ((511 - q) / 2 * 2 + q % 2) * 28);
    // The second round sorts within each part.
    const Accesses two = played(batches(2, {512}), permutation)[0];
    ASSERT_EQ(two.size(), 3 * 512 + 1u);
    for (std::uint64_t place = 0; place < 512; ++place) {
        EXPECT_EQ(two[512 + 2 * place].address, place * 28);
        EXPECT_EQ(two[513 + 2 * place].address, 16384 + (place ^ 1) * 28);  // 512 x 28 rounded up to 4096
    }
}

TEST(BufferStream, BucketsAreRingsWrittenUntilOneIsFull) {
    reorder::BufferUse use;
    use.buckets = reorder::BoundedBuckets{28, 2, 2, {0, 0, 0, 1}, {}};
    constexpr std::uint32_t permutation[] = {0, 1, 2, 3};
    constexpr std::string_view expected[] = {"W0 W28 R0", "W0 W56 R28", "R0", "R56", ""};
    expect_played(use, permutation, 28, expected);
    use.buckets->made = {3, 0, 1, 2};
    constexpr std::string_view made_otherwise[] = {"W56 W0 W28 R0", "W0 R28", "R0", "R56", ""};
    expect_played(use, permutation, 28, made_otherwise);
}

TEST(BufferStream, EachPassGoesOverAllPixelsOfItsTile) {
    // Image of 3 x 2 pixels, tiles of 0 1 3 4 and of 2 5, two passes. The first pass over the second tile has
    // no query.
    constexpr std::uint32_t pixel[] = {0, 1, 2, 3, 4, 5}, permutation[] = {1, 0, 3, 4, 2, 5};
    reorder::BufferUse use;
    use.state = reorder::PixelPasses{48, 3, 2, 2, 2, pixel, {{0, 1}, {1, 4}, {3, 6}}};
    constexpr std::string_view expected[] = {"W0 W48",    "W96 W144 R0", "R48 R96", "R144",
                                             "W0 W48 R0", "R48",         ""};
    expect_played(use, permutation, 48, expected);
    // No query in the last pass: its pixels are read all the same.
    use.state->runs = {{0, 1}, {1, 4}, {2, 6}};
    EXPECT_EQ(played(use, permutation)[4], drawn("W0", 48));
    EXPECT_EQ(played(use, permutation)[6], drawn("R0 R48", 48));
}

TEST(BufferStream, StateIsReadWhenAQueryIsMadeAndRecordsLieBehindIt) {
    constexpr std::uint32_t pixel[] = {0, 1}, permutation[] = {0, 1};
    reorder::BufferUse use;
    use.state = reorder::PixelPasses{48, 2, 1, 2, 2, pixel, {{0, 1}, {1, 2}}};
    use.buckets =
        reorder::BoundedBuckets{0, 1, 2, {0, 0}, {}};  // on the chip: all is made before the first search
    EXPECT_THAT(played(use, permutation), ElementsAre(drawn("W0 W48 R0 R48", 48), Accesses{}, Accesses{}));
    use.buckets->record_bytes = 28;
    Accesses expected = drawn("W0 W48 R0 R48", 48);
    expected.insert(expected.begin() + 1, {4096, 28, Access::write});
    expected.push_back({4096 + 28, 28, Access::write});
    expected.push_back({4096, 28, Access::read});
    EXPECT_EQ(played(use, permutation)[0], expected);
}

TEST(BufferStream, AUseOfAnotherPermutationIsRefused) {
    constexpr std::uint32_t permutation[] = {0, 1};
    EXPECT_THROW(BufferStream(batches(1, {3}), permutation), std::invalid_argument);
}

TEST(BufferStream, BytesAreThoseThatEveryOrderingCountsAndRecordsAreReadWhereTheyWereWritten) {
    ASSERT_TRUE(rc::check([] {
        const reorder::Queries queries = reorder::any_queries();
        const reorder::Workload work = queries.workload();
        std::vector<std::string> specs{"hilbert:tile=5",
                                       "direction-binned:tile=7,bins=3",
                                       "hashed:buckets=3,capacity=2",
                                       "direction-binned+hashed:tile=7,bins=3,buckets=3,capacity=2",
                                       "strata:tile=7,strata=3",
                                       "strata:tile=5,strata=2,frame=world"};
        for (const reorder::Entry& entry : reorder::catalogue())
            if (entry.name.find("direction") == std::string_view::npos && !entry.name.starts_with("strata"))
                specs.emplace_back(entry.name);
        for (const std::string& spec : specs) {
            const std::uint64_t onchip = *rc::gen::element(0u, 200u, 3000u);
            const auto ordering = reorder::make_ordering(spec);
            const reorder::Ordered ordered = reorder::order(*ordering, work, onchip);
            const reorder::BufferUse use = ordering->buffer_use(work, onchip, ordered.permutation);
            std::uint64_t written = 0, read = 0, made = 0;
            std::map<std::uint64_t, std::uint32_t> held;  // by address: the query whose record is there
            const std::vector<Accesses> steps = played(use, ordered.permutation);
            for (std::size_t r = 0; r < steps.size(); ++r) {
                for (const ByteAccess& access : steps[r]) {
                    (access.kind == Access::write ? written : read) += access.bytes;
                    if (!use.buckets || access.bytes != reorder::query_record_bytes) continue;
                    if (access.kind == Access::write) {
                        held[access.address] = use.buckets->made.empty() ? static_cast<std::uint32_t>(made)
                                                                         : use.buckets->made[made];
                        ++made;
                    } else {
                        RC_ASSERT(held.at(access.address) == ordered.permutation[r]);
                    }
                }
            }
            RC_ASSERT(written == written_bytes(use));
            RC_ASSERT(read == read_bytes(use));
            RC_ASSERT(written + read == ordered.cost.reorder_bytes);
        }
    }));
}

}  // namespace
}  // namespace regather::replay
