// Times of repeated runs, and races on photons and queries that are made by hand.
#include "experiment/race.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "spatial/photons/photon_kd.h"

namespace regather::experiment {
namespace {

using testing::HasSubstr;

TEST(Timing, MedianSpreadAndDeviationAsDrawnByHand) {
    // sorted 1 2 4 7 16; from the median 4: 3 2 0 3 12, whose median is 3
    const Timing odd = timing_of({7, 1, 16, 2, 4});
    EXPECT_EQ(odd.median, 4);
    EXPECT_EQ(odd.min, 1);
    EXPECT_EQ(odd.max, 16);
    EXPECT_EQ(odd.mad, 3);
    // sorted 1 2 4 9: the middle two give 3; from it 2 1 1 6, whose middle two give 1.5
    const Timing even = timing_of({9, 1, 4, 2});
    EXPECT_EQ(even.median, 3);
    EXPECT_EQ(even.mad, 1.5);
    EXPECT_EQ(timing_of({5}).median, 5);
    EXPECT_EQ(timing_of({5}).mad, 0);
}

struct Line {
    std::vector<trace::Photon> heap;
    std::vector<trace::Vec3> position;
    std::vector<std::uint32_t> pixel;
    reorder::Workload work;
    std::vector<reorder::ParsedOrdering> orderings;

    Line() {
        std::vector<trace::Photon> photons(200);
        for (std::size_t i = 0; i < photons.size(); ++i) photons[i].position.x = static_cast<float>(i);
        heap = spatial::left_balanced(photons);
        for (std::uint32_t i = 0; i < 3000; ++i) {
            position.push_back({static_cast<float>(i % 200), 0, 0});
            pixel.push_back(i);
        }
        work.position = position;
        work.pixel = pixel;
        work.bounds = trace::bounds_of(position);
        work.image_width = 3000;
        for (const char* spec : {"random", "naive", "hilbert"})
            orderings.push_back(reorder::parse_ordering(spec));
    }
};

constexpr auto silent = [](std::uint64_t, std::uint64_t) {};

TEST(RaceOfSearches, CountsThePhotonsFoundAndReportsEveryQueryOnce) {
    Line line;
    // Of 200 photons on a line those within 1: three, but two at either end. 3000 queries are 15 on each
    // photon.
    RaceConfig config{
        .k = 10, .radius = 1, .repeats = 3, .threads = 2, .structures = {structures[0], structures[1]}};
    std::uint64_t last = 0, all = 0;
    const Race held =
        race(line.heap, line.work, line.orderings, 1, config, [&](std::uint64_t done, std::uint64_t total) {
            last = done;
            all = total;
        });
    EXPECT_EQ(held.found_photons, 15u * (198 * 3 + 2 * 2));
    EXPECT_EQ(held.standings.size(), 6u);
    EXPECT_EQ(last, all);
    EXPECT_EQ(all, 3000u * 3 * 2 * 3);
}

TEST(RaceOfSearches, SearchesThatDisagreeAreAFailedRun) {
    Line line;
    // Two photons swapped: the left-balanced search prunes by planes that are wrong now, the buckets are
    // built anew.
    std::swap(line.heap[1], line.heap[2]);
    const RaceConfig config{.k = 3, .repeats = 1, .structures = {structures[0], structures[1]}};
    try {
        race(line.heap, line.work, line.orderings, 1, config, silent);
        FAIL() << "expected an error";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("query"), HasSubstr("bucketed"),
                                                 HasSubstr("left-balanced"), HasSubstr("random")));
    }
}

}  // namespace
}  // namespace regather::experiment
