// Rays in the order of their keys, drawn by hand.
#include "reorder/ray_sorted.h"

#include <gtest/gtest.h>

#include <limits>

#include "reorder/catalogue.h"
#include "tests/reorder/workload.h"

namespace regather::reorder {
namespace {

using Order = std::vector<std::uint32_t>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Order order_by(std::string_view spec, const Queries& rays) {
    return order(*make_ordering(spec), rays.workload()).permutation;
}

TEST(RaySorted, TheFirstBitsAreThoseOfTheOriginThenOfTheEnd) {
    // One bit a coordinate; the grid is [0, 8] along each axis, halves below and from 4 on.
    // Keys x y z, x y z: 0: 100 001; 1: 000 111; 2: 100 000; 3: 000 000; 4: 011 100.
    Queries rays = one_per_pixel(5, 1);
    rays.position = {{8, 0, 0}, {1, 1, 1}, {5, 1, 1}, {0, 0, 0}, {1, 6, 7}};
    rays.end = {{0, 0, 8}, {7, 5, 6}, {1, 2, 3}, {3, 3, 3}, {6, 1, 1}};
    EXPECT_EQ(order_by("origin-end:bits=1", rays), (Order{3, 1, 4, 2, 0}));
    // Two bits: the second ones come behind all first ones. Cells of 2: 2: (2 0 0, 0 1 1), first bits
    // 100 000; 0: (3 0 0, 0 0 3), first bits 100 001. So 2 stays before 0 though 0's other bits are fewer.
    EXPECT_EQ(order_by("origin-end:bits=2", rays), (Order{3, 1, 4, 2, 0}));
    // Of two in the same half the nearer quarter is first, whatever the capture's order.
    rays.position[0] = rays.position[4];
    rays.end[0] = {5, 1, 1};
    rays.end[4] = {7, 1, 1};
    EXPECT_EQ(order_by("origin-end:bits=1", rays), (Order{3, 1, 0, 4, 2}));
    rays.end[0] = {7, 1, 1};
    rays.end[4] = {5, 1, 1};
    EXPECT_EQ(order_by("origin-end:bits=1", rays), (Order{3, 1, 0, 4, 2}));  // a tie
    EXPECT_EQ(order_by("origin-end:bits=2", rays), (Order{3, 1, 4, 0, 2}));
}

TEST(RaySorted, DirectionsLieOnAnOctahedron) {
    // All from one place: u v of the direction decide, one bit each: (-, -), (-, +), (+, -), (+, +).
    Queries rays = one_per_pixel(4, 1);
    rays.position.assign(4, {1, 2, 3});
    rays.direction = {{0.5f, 0.5f, 0.7f}, {-0.5f, 0.5f, 0.7f}, {0.5f, -0.5f, 0.7f}, {-0.5f, -0.5f, 0.7f}};
    EXPECT_EQ(order_by("origin-direction:bits=1", rays), (Order{3, 1, 2, 0}));
    // Downwards the octants are folded outwards: the nearly vertical one lies in a corner, the nearly level
    // one by the diagonal. In two bits (u, v): down and (+, +): 0.9 of both: 11 11; level: 0.75 or so: 11 11,
    // three bits tell them apart: 111 111 and 110 110.
    rays = one_per_pixel(2, 1);
    rays.position.assign(2, {1, 2, 3});
    rays.direction = {{0.1f, 0.1f, -0.99f}, {0.69f, 0.69f, -0.2f}};
    EXPECT_EQ(order_by("origin-direction:bits=2", rays), (Order{0, 1}));
    EXPECT_EQ(order_by("origin-direction:bits=3", rays), (Order{1, 0}));
}

TEST(RaySorted, AGuessStandsForTheEnd) {
    Queries rays = one_per_pixel(3, 1);
    rays.position.assign(3, {0, 0, 0});
    rays.end = {{1, 0, 0}, {5, 0, 0}, {9, 0, 0}};
    rays.guess = {{8, 0, 0}, {9, 0, 0}, {2, 0, 0}};
    EXPECT_EQ(order_by("origin-end", rays), (Order{0, 1, 2}));
    EXPECT_EQ(order_by("origin-guess", rays), (Order{2, 0, 1}));
}

TEST(RaySorted, TilesAreDoneOneByOne) {
    Queries rays = one_per_pixel(4, 1);  // tiles of two pixels
    rays.position.assign(4, {0, 0, 0});
    rays.end = {{9, 0, 0}, {5, 0, 0}, {7, 0, 0}, {1, 0, 0}};
    rays.end[0].y = nan;
    EXPECT_EQ(order_by("origin-end:tile=2", rays), (Order{1, 0, 3, 2}));
    EXPECT_EQ(order_by("origin-end", rays), (Order{3, 1, 2, 0}));
    // 2^32 tiles leave 31 bits: five of each of six coordinates. The cell that is one wide at 10 bits is 32.
    rays = one_per_pixel(2, 1);
    rays.width = rays.height = 1 << 16;
    rays.pixel = {0, 0};
    rays.position = {{0, 0, 0}, {1024, 0, 0}};
    rays.end = {{33, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(order_by("origin-end:tile=1,bits=10", rays), (Order{0, 1}));
    rays.position = {{0, 0, 0}, {0, 0, 0}};
    rays.end = {{1024, 0, 0}, {992, 0, 0}};
    EXPECT_EQ(order_by("origin-end:tile=1,bits=10", rays), (Order{0, 1}));  // both in the last cell
    EXPECT_EQ(order_by("origin-end:bits=10", rays), (Order{1, 0}));
}

TEST(RaySorted, RaysThatGoNowhereComeLast) {
    Queries rays = one_per_pixel(4, 1);
    rays.position = {{nan, 0, 0}, {9, 9, 9}, {8, 9, 9}, {1, 1, 1}};
    rays.direction = {{0, 0, 1}, {0, 0, 0}, {0, nan, 1}, {0, 0, 1}};
    rays.end = {{1, 1, 1}, {nan, 0, 0}, {9, 9, 9}, {2, 2, 2}};
    EXPECT_EQ(order_by("origin-direction", rays), (Order{3, 0, 1, 2}));
    EXPECT_EQ(order_by("origin-end", rays), (Order{3, 2, 0, 1}));
}

}  // namespace
}  // namespace regather::reorder
