// tests/reorder/workload.h -- queries that own their columns, and random ones.
#pragma once
#include <rapidcheck.h>

#include <limits>
#include <vector>

#include "reorder/ordering.h"

namespace regather::reorder {

struct Queries {
    std::vector<Vec3> position, direction, end, guess;
    std::vector<std::uint32_t> pixel, leaf_kd, leaf_bvh;
    std::uint32_t width = 1, height = 1;

    Workload workload() const {
        return {.position = position,
                .direction = direction,
                .pixel = pixel,
                .leaf_kd = leaf_kd,
                .leaf_bvh = leaf_bvh,
                .end = end,
                .guess = guess,
                .bounds = trace::bounds_of(position),
                .image_width = width,
                .image_height = height};
    }
};

/// One query a pixel of a width x height image, all at the origin.
inline Queries one_per_pixel(std::uint32_t width, std::uint32_t height) {
    Queries queries;
    queries.width = width;
    queries.height = height;
    for (std::uint32_t pixel = 0; pixel < width * height; ++pixel) queries.pixel.push_back(pixel);
    queries.position.resize(queries.pixel.size());
    return queries;
}

/// The bits of splitmix64 (Steele, Lea, Flood 2014), for workloads too large for RapidCheck.
inline std::uint64_t scrambled(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
    x = (x ^ x >> 27) * 0x94d049bb133111eb;
    return x ^ x >> 31;
}

inline float scrambled_unit(std::uint64_t x) {
    return static_cast<float>(scrambled(x) >> 40) * 0x1p-24f;
}

/// In boxes of any proportions, on points that repeat, with NaN and infinities among them, pixels in any
/// order.
inline Queries any_queries() {
    using rc::gen::arbitrary, rc::gen::inRange;
    Queries queries;
    queries.width = *inRange<std::uint32_t>(1, 40);
    queries.height = *inRange<std::uint32_t>(1, 40);
    const auto count = *inRange<std::size_t>(0, 300);
    const auto seed = *arbitrary<std::uint64_t>();
    const Vec3 extent{*rc::gen::element(0.0f, 1e-6f, 1.0f, 3e38f), *rc::gen::element(0.0f, 1.0f, 1e12f),
                      *rc::gen::element(0.0f, 1e-40f, 1e6f)};
    const auto distinct = *rc::gen::element<std::uint64_t>(1, 5, 1000);
    constexpr float odd[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                             -std::numeric_limits<float>::infinity()};
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t point = scrambled(seed + i) % distinct;
        Vec3 position{extent.x * (scrambled_unit(point * 3) - 0.5f), extent.y * scrambled_unit(point * 3 + 1),
                      extent.z * scrambled_unit(point * 3 + 2)};
        const std::uint64_t dice = scrambled(seed ^ i) % 40;
        if (dice < 3) position[static_cast<int>(i % 3)] = odd[dice];
        queries.position.push_back(position);
        Vec3 direction{scrambled_unit(seed + 5 * i) - 0.5f, scrambled_unit(seed + 5 * i + 1) - 0.5f,
                       scrambled_unit(seed + 5 * i + 2) - 0.5f};
        if (dice == 4) direction = {odd[i % 3], 0, 0};
        queries.direction.push_back(dice == 5 ? Vec3{} : normalize(direction));
        queries.pixel.push_back(static_cast<std::uint32_t>(scrambled(seed + 7 * i) %
                                                           (std::uint64_t{queries.width} * queries.height)));
        queries.leaf_kd.push_back(static_cast<std::uint32_t>(scrambled(point)));
        queries.leaf_bvh.push_back(static_cast<std::uint32_t>(scrambled(point) % 7));
        queries.end.push_back(dice == 6 ? Vec3{odd[i % 3], 0, 0} : position * scrambled_unit(seed + 11 * i));
        queries.guess.push_back(queries.end.back() * 2);
    }
    return queries;
}

}  // namespace regather::reorder
