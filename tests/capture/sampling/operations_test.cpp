#include "capture/sampling/operations.h"

#include <gtest/gtest.h>

#include <string>

#include "capture/sampling/gather_distribution.h"
#include "capture/sampling/hemisphere_table.h"

namespace regather::capture {
namespace {

SamplingCost cost(const std::string& spec, bool glossy = false) {
    return parse_sampling(spec).cost(glossy);
}

TEST(SamplingCost, StateIsWhatIsKept) {
    EXPECT_EQ(cost("cosine").bytes, 0u);
    EXPECT_EQ(cost("incident:rows=3,columns=10").bytes, HemisphereTable(3, 10).bytes());
    EXPECT_EQ(cost("combined", true).bytes, 4u * (64 + 4));
    EXPECT_EQ(cost("lobes:lobes=7").bytes, 7u * 20 + 8) << "an axis, a concentration, a share; the floor";
    EXPECT_EQ(cost("footprints:k=100").bytes, 100u * 20 + 10 * 16 + 8);
    for (const char* const spec : {"brdf", "incident", "combined", "lobes:lobes=16", "mis", "oracle"})
        EXPECT_LE(cost(spec, true).bytes, 512u) << spec;
}

TEST(SamplingCost, WhatIsAskedIsTold) {
    for (const char* const spec : {"incident", "combined", "mis", "lobes", "footprints"}) {
        EXPECT_EQ(cost(spec).searches, 1u) << spec;
        EXPECT_EQ(cost(spec).rays, 0u) << spec;
    }
    for (const char* const spec : {"uniform", "cosine", "brdf", "oracle"}) EXPECT_EQ(cost(spec).searches, 0u);
    EXPECT_EQ(cost("oracle:rows=2,columns=6,probes=3").rays, 2u * 6 * 9);
}

// Counted by hand, line by line. A direction into the frame is 9 products and 6 sums.
TEST(SamplingCost, OperationsAreThoseOfTheCode) {
    // cosine_hemisphere(): 3 products, 1 sum, 2 roots, sine and cosine, a maximum; into the world 9 and 6;
    // pdf 3 and 2 for the cosine, times 1 / pi, a maximum.
    const Operations cosine = cost("cosine").sample;
    EXPECT_EQ(cosine.multiply, 3 + 9 + 4);
    EXPECT_EQ(cosine.add, 1 + 6 + 2);
    EXPECT_EQ(cosine.function, 4);
    EXPECT_EQ(cosine.compare, 2);
    EXPECT_EQ(cosine.random, 2);
    // A table of 4 rows and 10 columns: 2 steps among the rows and 4 among the columns; in each the place in
    // the part found is 2 differences, a quotient and 3 comparisons of 2 reads; the cell's density 2 widths
    // of 4 reads and 5 products.
    const Operations of_table = cost("incident:rows=4,columns=10").sample;
    EXPECT_EQ(of_table.read, 2 + 2 + 4 + 2 + 4);
    EXPECT_EQ(of_table.compare, 2 + 3 + 4 + 3 + 2);
    EXPECT_EQ(of_table.multiply, 3 + 5 + 9);
    EXPECT_EQ(of_table.add, 2 + 2 + 2 + 1 + 2 + 6);
    EXPECT_EQ(of_table.divide, 1 + 1 + 2);
    EXPECT_EQ(of_table.random, 2);
    // One more photon, with 3 steps among 8 edges: into the frame; sin^2, its row, 2 products and a sum an
    // edge; a square, and four sums.
    const Operations few = cost("incident:k=10").table, more = cost("incident:k=11").table;
    EXPECT_EQ(more.multiply - few.multiply, 9 + 2 + 1 + 2 * 3 + 1);
    EXPECT_EQ(more.add - few.add, 6 + 1 + 3 + 4);
    EXPECT_EQ(more.function, 0);
    // One more iteration: an exponential for each photon and lobe, and one and a root for each lobe.
    EXPECT_EQ(cost("lobes:lobes=3,k=50,iterations=5").table.function -
                  cost("lobes:lobes=3,k=50,iterations=4").table.function,
              50 * 3 + 3 * 2);
}

TEST(SamplingCost, OnlyGlossySurfacesPayForTheBrdf) {
    EXPECT_EQ(cost("combined").table.flop(), cost("incident").table.flop());
    EXPECT_GT(cost("combined", true).table.flop(), cost("incident").table.flop() + 64 * 60);
    EXPECT_EQ(cost("combined", true).sample.flop(), cost("incident").sample.flop());
    EXPECT_GT(cost("mis", true).sample.flop(), 2 * cost("combined", true).sample.flop());
    EXPECT_GT(cost("brdf", true).sample.flop(), cost("brdf").sample.flop());
}

}  // namespace
}  // namespace regather::capture
