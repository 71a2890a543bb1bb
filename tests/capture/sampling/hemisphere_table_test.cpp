#include "capture/sampling/hemisphere_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/light/bsdf.h"
#include "capture/sampler.h"
#include "study/chi_squared.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

Vec3 direction_at(double sine2, double turn) {
    const double phi = 2 * std::numbers::pi * turn;
    return {static_cast<float>(std::sqrt(sine2) * std::cos(phi)),
            static_cast<float>(std::sqrt(sine2) * std::sin(phi)), static_cast<float>(std::sqrt(1 - sine2))};
}

/// Shares as photons leave them: most cells have none, a few nearly all.
std::vector<float> lumpy_shares(std::uint32_t cells, std::uint64_t seed) {
    Sampler sampler(seed, Stream::gather, 1);
    std::vector<float> shares(cells);
    for (float& share : shares) share = sampler.below(3) == 0 ? std::pow(sampler.uniform(), 8.0f) : 0;
    return shares;
}

TEST(HemisphereTable, CellsAreNumberedBySineSquaredAndThenByTurn) {
    const HemisphereTable table(2, 6);
    EXPECT_EQ(table.cell_of(direction_at(0.49, 0.01)), 0u);
    EXPECT_EQ(table.cell_of(direction_at(0.51, 0.01)), 6u);
    EXPECT_EQ(table.cell_of(direction_at(0.2, 0.17)), 1u);  // beyond a sixth
    EXPECT_EQ(table.cell_of(direction_at(0.2, 0.16)), 0u);
    EXPECT_EQ(table.cell_of(direction_at(0.2, 0.49)), 2u);
    EXPECT_EQ(table.cell_of(direction_at(0.2, 0.51)), 3u);
    EXPECT_EQ(table.cell_of(direction_at(0.2, 0.84)), 5u);
    EXPECT_LT(table.cell_of({0, 0, 1}), 6u);           // any column of the first row
    EXPECT_EQ(table.cell_of({0, -0.6f, -0.8f}), 10u);  // below the horizon: the last row, three quarters
    for (std::uint32_t cell = 0; cell < 12; ++cell) EXPECT_EQ(table.cell_of(table.middle_of(cell)), cell);
}

TEST(HemisphereTable, WithoutSharesItIsTheCosine) {
    HemisphereTable table(4, 16);
    table.set(std::vector<float>(64), 0.25);
    for (const auto& [u, v] : {std::pair{0.1f, 0.2f}, {0.63f, 0.9f}, {0.99f, 0.51f}}) {
        const Vec3 found = table.sample(u, v).direction, cosine = cosine_hemisphere(u, v);
        EXPECT_NEAR(dot(found, cosine), 1, 1e-5) << u;
        EXPECT_NEAR(table.pdf(found), found.z / std::numbers::pi, 1e-6) << u;
    }
    EXPECT_EQ(table.pdf({0.6f, 0, -0.8f}), 0);
    EXPECT_EQ(table.pdf({1, 0, 0}), 0);
}

// One cell of eight has everything; a floor of 0.2 leaves it 0.8 and an eighth of 0.2.
TEST(HemisphereTable, ACellsShareIsItsDensityOverTheCosine) {
    HemisphereTable table(2, 4);
    std::vector<float> shares(8);
    shares[6] = 3;
    table.set(shares, 0.2);
    const Vec3 in = table.middle_of(6), out = table.middle_of(1);
    EXPECT_NEAR(table.pdf(in), 8 * 0.825 * in.z / std::numbers::pi, 1e-5);
    EXPECT_NEAR(table.pdf(out), 8 * 0.025 * out.z / std::numbers::pi, 1e-6);
    table.set(shares, 0);
    EXPECT_EQ(table.pdf(out), 0);
    for (const float u : {0.0f, 0.5f, 0x1.fffffep-1f})
        for (const float v : {0.0f, 0.5f, 0x1.fffffep-1f}) {
            const auto [direction, density] = table.sample(u, v);
            EXPECT_NEAR(direction.x * direction.x + direction.y * direction.y, 0.5 + u / 2, 1e-6);
            EXPECT_LE(std::max(direction.x, direction.y), 1e-6f) << "the third quarter";
            EXPECT_NEAR(density, 8 * direction.z / std::numbers::pi, 1e-6) << u << ", " << v;
        }
    EXPECT_EQ(table.bytes(), 40u);
}

TEST(HemisphereTable, TheDensityIntegratesToOne) {
    ASSERT_TRUE(rc::check([] {
        HemisphereTable table(*rc::gen::inRange<std::uint32_t>(1, 17),
                              2 * *rc::gen::inRange<std::uint32_t>(1, 17));
        table.set(lumpy_shares(table.rows() * table.columns(), *rc::gen::arbitrary<std::uint64_t>()),
                  *rc::gen::element(0.0, 0.1, 1.0));
        // Over a cell the density is a multiple of the cosine, so that of its middle tells its share.
        double sum = 0;
        for (std::uint32_t cell = 0; cell < table.rows() * table.columns(); ++cell) {
            const Vec3 middle = table.middle_of(cell);
            sum += table.pdf(middle) * std::numbers::pi / static_cast<double>(middle.z);
        }
        RC_ASSERT(std::abs(sum / (table.rows() * table.columns()) - 1) < 1e-4);
    }));
}

TEST(HemisphereTable, SamplesFallAsTheDensitySays) {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
        HemisphereTable table(4, 16);
        table.set(lumpy_shares(64, seed), 0.1);
        // Counted in a grid of half the width and height.
        constexpr std::uint32_t samples = 200'000, rows = 8, columns = 32;
        std::vector<double> found(rows * columns), expected(rows * columns);
        const HemisphereTable bins(rows, columns);
        for (std::uint32_t bin = 0; bin < rows * columns; ++bin) {
            const Vec3 middle = bins.middle_of(bin);
            expected[bin] = samples * table.pdf(middle) * std::numbers::pi / static_cast<double>(middle.z) /
                            (rows * columns);
        }
        for (std::uint32_t i = 0; i < samples; ++i) {
            Sampler sampler(seed, Stream::gather, 7, i);
            const float u = sampler.uniform(), v = sampler.uniform();
            ++found[bins.cell_of(table.sample(u, v).direction)];
        }
        EXPECT_GT(study::chi_squared_p(found, expected), 1e-4) << seed;
    }
}

// Of an n x n grid of strata, what falls into a row of cells is within one stratum's width of its share:
// warped points stay apart.
TEST(HemisphereTable, StrataStayStrata) {
    HemisphereTable table(4, 16);
    table.set(lumpy_shares(64, 5), 0.1);
    constexpr int n = 50;
    std::vector<int> of_row(4);
    std::vector<double> share(4);
    for (std::uint32_t cell = 0; cell < 64; ++cell) {
        const Vec3 middle = table.middle_of(cell);
        share[cell / 16] += table.pdf(middle) * std::numbers::pi / static_cast<double>(middle.z) / 64;
    }
    Sampler sampler(1, Stream::gather, 3);
    float last = 0;
    for (int i = 0; i < n; ++i) {
        const float u = (static_cast<float>(i) + sampler.uniform()) / n;
        const Vec3 found = table.sample(u, sampler.uniform()).direction;
        const float sine2 = 1 - found.z * found.z;
        EXPECT_GE(sine2, last - 1e-6f);
        last = sine2;
        ++of_row[table.cell_of(found) / 16];
    }
    for (std::size_t row = 0; row < 4; ++row) EXPECT_NEAR(of_row[row], n * share[row], 2) << row;
}

TEST(HemisphereTable, SizesThatCannotBeAreRefused) {
    for (const auto& [rows, columns] : {std::pair{0u, 4u}, {65u, 4u}, {4u, 0u}, {4u, 5u}, {4u, 130u}})
        EXPECT_THROW(HemisphereTable(rows, columns), trace::UsageError) << rows << "x" << columns;
}

}  // namespace
}  // namespace regather::capture
