// What holds for every ordering of the catalogue, whatever the queries.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "reorder/catalogue.h"
#include "tests/reorder/workload.h"
#include "trace/error.h"

namespace regather::reorder {
namespace {

std::vector<std::string> every_ordering() {
    std::vector<std::string> every_ordering{"tiled:tile=3,rows=alternating",
                                            "direction-binned:tile=5,bins=3,passes=4",
                                            "hilbert:tile=4",
                                            "morton:tile=1,bits=21",
                                            "swizzle:tile=7,bits=8",
                                            "hashed:buckets=3,capacity=2,cells=2",
                                            "kd-leaf:tile=2",
                                            "direction-binned+hashed:tile=3,capacity=1",
                                            "strata:tile=5,strata=3,order=columns",
                                            "strata:tile=2,strata=5,order=morton,frame=world",
                                            "strata+hashed:tile=3,capacity=1,frame=world"};
    for (const Entry& entry : catalogue()) every_ordering.emplace_back(entry.name);
    return every_ordering;
}

class EveryOrdering : public testing::TestWithParam<std::string> {};

TEST_P(EveryOrdering, IsAPermutationWithTiesInCaptureOrder) {
    const std::unique_ptr<Ordering> ordering = make_ordering(GetParam());
    ASSERT_TRUE(rc::check([&] {
        const Queries queries = any_queries();
        const Workload work = queries.workload();
        const auto permutation = order(*ordering, work).permutation;
        std::vector<bool> seen(work.position.size());
        RC_ASSERT(permutation.size() == seen.size());
        for (const std::uint32_t query : permutation) {
            RC_ASSERT(query < seen.size() && !seen[query]);
            seen[query] = true;
        }
        std::vector<std::uint64_t> keys(seen.size());
        ordering->assign_keys(work, default_onchip_bytes, keys);
        for (std::size_t r = 1; r < permutation.size(); ++r) {
            const std::uint32_t a = permutation[r - 1], b = permutation[r];
            RC_ASSERT(keys[a] < keys[b] || (keys[a] == keys[b] && a < b));
        }
    }));
}

TEST_P(EveryOrdering, DoesNotDependOnThreads) {
    Queries queries;
    queries.width = queries.height = 100;
    constexpr std::size_t count = 150'000;
    for (std::size_t i = 0; i < count; ++i) {
        queries.pixel.push_back(static_cast<std::uint32_t>(i / 15));
        queries.position.push_back(
            {scrambled_unit(3 * i), scrambled_unit(3 * i + 1) * scrambled_unit(i), 0.5f});
        queries.direction.push_back(
            normalize(Vec3{scrambled_unit(5 * i), scrambled_unit(5 * i + 1), scrambled_unit(5 * i + 2)} * 2 +
                      Vec3{-1, -1, -1}));
        queries.leaf_kd.push_back(static_cast<std::uint32_t>(scrambled(i) % 5000));
        queries.leaf_bvh.push_back(static_cast<std::uint32_t>(scrambled(i) % 90));
        queries.stratum.push_back(static_cast<std::uint32_t>(scrambled(i)));
        queries.end.push_back({scrambled_unit(7 * i), scrambled_unit(7 * i + 1), scrambled_unit(7 * i + 2)});
        queries.guess.push_back(queries.end.back());
    }
    const std::unique_ptr<Ordering> ordering = make_ordering(GetParam());
    const auto run = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return order(*ordering, queries.workload());
    };
    const Ordered one = run(1), two = run(2);
    EXPECT_TRUE(one.permutation == two.permutation);
    EXPECT_EQ(one.cost.stalls, two.cost.stalls);
}

TEST_P(EveryOrdering, WorksOnNoneOneAndCoincidentQueries) {
    const std::unique_ptr<Ordering> ordering = make_ordering(GetParam());
    for (const std::size_t count : {0, 1, 1000}) {
        Queries queries;
        queries.pixel.resize(count);
        queries.position.assign(count, {2, 3, 4});
        queries.direction.assign(count, {0, 0, 1});
        queries.leaf_kd.assign(count, 9);
        queries.leaf_bvh.assign(count, 9);
        queries.stratum.assign(count, 9);
        queries.end.assign(count, {2, 5, 4});
        queries.guess.assign(count, {2, 6, 4});
        const auto permutation = order(*ordering, queries.workload()).permutation;
        ASSERT_EQ(permutation.size(), count);
        if (GetParam().starts_with("random")) continue;
        for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(permutation[i], i);
    }
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
    return name;
}
INSTANTIATE_TEST_SUITE_P(Catalogue, EveryOrdering, testing::ValuesIn(every_ordering()), test_name);

std::string refusal(std::string_view spec, const Queries& queries) {
    try {
        order(*make_ordering(spec), queries.workload());
    } catch (const trace::UsageError& error) {
        return std::string("usage: ") + error.what();
    } catch (const trace::DataError& error) {
        return std::string("data: ") + error.what();
    }
    return "accepted";
}

TEST(Order, NamesAMissingColumnOnlyWhenTheOrderingReadsIt) {
    const Queries bare = one_per_pixel(4, 4);
    for (const std::string_view spec : {"naive", "random", "tiled", "hilbert", "morton", "swizzle", "hashed"})
        EXPECT_EQ(refusal(spec, bare), "accepted") << spec;
    const std::string direction =
        "usage: the ordering reads column direction, which this capture does not have";
    EXPECT_EQ(refusal("direction-binned", bare), direction);
    EXPECT_EQ(refusal("direction-binned+hashed", bare), direction);
    EXPECT_EQ(refusal("strata:frame=world", bare), direction);
    EXPECT_EQ(refusal("strata", bare),
              "usage: the ordering reads column stratum, which this capture does not have");
    EXPECT_EQ(refusal("kd-leaf", bare),
              "usage: the ordering reads column leaf_kd, which this capture does not have");
    EXPECT_EQ(refusal("origin-direction", bare), direction);
    EXPECT_EQ(refusal("origin-end", bare),
              "usage: the ordering reads column end, which this capture does not have");
    EXPECT_EQ(refusal("origin-guess", bare),
              "usage: the ordering reads column guess, which this capture does not have");
    EXPECT_EQ(refusal("bvh-leaf", bare),
              "usage: the ordering reads column leaf_bvh, which this capture does not have");
}

TEST(Order, RefusesInconsistentColumns) {
    Queries queries = one_per_pixel(4, 4);
    queries.direction.resize(15);
    EXPECT_EQ(refusal("naive", queries),
              "data: query_direction.npy: found 15 rows, expected 16 as in query_position.npy");
    queries = one_per_pixel(4, 4);
    queries.stratum.resize(17);
    EXPECT_EQ(refusal("naive", queries),
              "data: query_stratum.npy: found 17 rows, expected 16 as in query_position.npy");
    queries = one_per_pixel(4, 4);
    queries.pixel[9] = 16;
    EXPECT_EQ(refusal("naive", queries),
              "data: query_pixel.npy: row 9: found 16, expected less than 16 (4 x 4 pixels)");
    queries = one_per_pixel(4, 4);
    queries.height = 0;
    EXPECT_EQ(refusal("naive", queries), "data: image of 4 x 0 pixels, expected 1 to 2^32 pixels");
}

}  // namespace
}  // namespace regather::reorder
