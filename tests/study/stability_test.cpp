#include "study/stability.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "study/chi_squared.h"
#include "study/half_vector.h"
#include "study/room.h"
#include "trace/error.h"

namespace regather::study {
namespace {

class Group : public testing::TestWithParam<const CaseGroup*> {};

TEST_P(Group, HoldsItsBounds) {
    for (const Case& one : GetParam()->cases()) {
        if (one.timed || one.full_only) continue;
        const results::StabilityRow row = run_case(*GetParam(), one, Effort::quick);
        EXPECT_TRUE(row.passed.value())
            << one.name << ": " << one.quantity << " " << row.error.value_or(NAN) << ", allowed "
            << row.allowed_error.value_or(NAN) << " (" << row.reason << ")";
    }
}

std::vector<const CaseGroup*> all_groups() {
    std::vector<const CaseGroup*> groups;
    for (const CaseGroup& group : case_groups()) groups.push_back(&group);
    return groups;
}
INSTANTIATE_TEST_SUITE_P(Stability, Group, testing::ValuesIn(all_groups()),
                         [](const auto& name) { return std::string(name.param->name); });

TEST(Stability, NamesOfCasesAreDistinct) {
    std::set<std::string> names;
    std::size_t count = 0;
    for (const CaseGroup& group : case_groups())
        for (const Case& one : group.cases()) {
            names.insert(fmt::format("{}: {}", group.name, one.name));
            ++count;
        }
    EXPECT_EQ(names.size(), count);
    EXPECT_GE(count, 100u);
}

TEST(Stability, UnknownGroupsAreRefusedWithTheKnownOnes) {
    try {
        case_group("lobe");
        FAIL();
    } catch (const trace::UsageError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("found \"lobe\", expected one of place, transport"));
    }
}

Case measuring(double error, double allowed) {
    return {"c", "q", "r", [=](Effort) { return Reading{error, allowed}; }};
}

TEST(Stability, WhatIsNoNumberHasFailed) {
    const CaseGroup& group = case_groups().front();
    EXPECT_TRUE(*run_case(group, measuring(1, 1), Effort::quick).passed);
    EXPECT_FALSE(*run_case(group, measuring(1.1, 1), Effort::quick).passed);
    for (const double bad : {std::nan(""), HUGE_VAL}) {
        const auto row = run_case(group, measuring(bad, HUGE_VAL), Effort::quick);
        EXPECT_FALSE(*row.passed);
        EXPECT_FALSE(row.error.has_value());
        EXPECT_FALSE(*run_case(group, measuring(0, bad), Effort::quick).passed);
    }
    const Case throwing{"c", "q", "r", [](Effort) -> Reading { throw std::runtime_error("no memory"); }};
    const auto row = run_case(group, throwing, Effort::quick);
    EXPECT_FALSE(*row.passed);
    EXPECT_EQ(row.reason, "no memory");
}

TEST(Stability, ASampleThatScattersTooMuchHasFailedHoweverSmallItsError) {
    EXPECT_DOUBLE_EQ(sampled(0.02, 0.001, 0.01).allowed, 0.046);
    EXPECT_DOUBLE_EQ(sampled(0.02, 0.001, 0.01).error, 0.02);
    EXPECT_THROW(sampled(0, 0, 0.023), std::runtime_error);  // 0.1035 would be allowed
    EXPECT_THROW(sampled(0, 0, 0.01, 0.04), std::runtime_error);
    EXPECT_THROW(sampled(0, 0, std::nan("")), std::runtime_error);
    const Case noisy{"c", "q", "r", [](Effort) { return sampled(0.01, 0, 1); }};
    const auto row = run_case(case_groups().front(), noisy, Effort::quick);
    EXPECT_FALSE(*row.passed);
    EXPECT_THAT(row.reason, testing::HasSubstr("scatters too much"));
}

// Abramowitz and Stegun, Table 26.8.
TEST(ChiSquared, HasTheTabulatedTails) {
    EXPECT_NEAR(chi_squared_tail(3.84146, 1), 0.05, 1e-6);
    EXPECT_NEAR(chi_squared_tail(18.3070, 10), 0.05, 1e-6);
    EXPECT_NEAR(chi_squared_tail(2.15586, 10), 0.995, 1e-6);
    EXPECT_NEAR(chi_squared_tail(149.449, 100), 0.001, 1e-6);
    EXPECT_NEAR(chi_squared_tail(67.3276, 100), 0.995, 1e-6);
    EXPECT_NEAR(chi_squared_tail(2, 2), std::exp(-1.0), 1e-14);  // exactly exp(-x / 2)
    EXPECT_EQ(chi_squared_tail(0, 5), 1);
}

TEST(ChiSquared, ComparesCountsCellByCell) {
    const double due[] = {10, 20, 30, 0}, same[] = {10, 20, 30, 0}, other[] = {20, 20, 20, 0},
                 impossible[] = {10, 20, 29, 1};
    EXPECT_EQ(chi_squared_p(same, due), 1);
    EXPECT_NEAR(chi_squared_p(other, due), std::exp(-(10.0 + 100.0 / 30) / 2),
                1e-12);  // two degrees of freedom
    EXPECT_EQ(chi_squared_p(impossible, due), 0);
    // Cells that expect fewer than 5 are one; a leftover that expects less than 1 is none.
    const double few_due[] = {10, 10, 1.5, 0.5}, few[] = {10, 10, 4, 1}, least_due[] = {10, 10, 0.6},
                 least[] = {10, 10, 3};
    EXPECT_NEAR(chi_squared_p(few, few_due), std::exp(-(3.0 * 3 / 2) / 2), 1e-12);
    EXPECT_EQ(chi_squared_p(least, least_due), 1);
}

TEST(ChiSquared, SidakSharesTheSignificanceAmongTests) {
    EXPECT_NEAR(1 - std::pow(1 - sidak(0.01, 24), 24), 0.01, 1e-12);
    EXPECT_NEAR(sidak(0.05, 1), 0.05, 1e-15);
}

TEST(HalfVectorLobe, FindsThePlaceThatADirectionIsFrom) {
    for (const double degrees : {0.0, 45.0, 89.0, 89.999})
        for (const float exponent : {1.0f, 1e3f, 1e6f}) {
            const HalfVectorLobe lobe(exponent, degrees);
            for (const double u : {0.3, 0.7, 0.95}) {
                const double v = 0.1;
                const auto sample = lobe.at(u, v);
                ASSERT_EQ(sample.along > 0 && sample.direction[2] > 0, u > lobe.least_u(v))
                    << degrees << " " << exponent << " " << u;
                if (u <= lobe.least_u(v)) continue;
                const auto [back_u, back_v] = lobe.place_of({static_cast<float>(sample.direction[0]),
                                                             static_cast<float>(sample.direction[1]),
                                                             static_cast<float>(sample.direction[2])});
                EXPECT_NEAR(back_u, u, 2e-3) << degrees << " " << exponent;
                EXPECT_NEAR(back_v, v, 2e-3) << degrees << " " << exponent;
            }
        }
}

TEST(Room, IsClosedAndFacesInwards) {
    const Room room = furnace(0.5);
    const trace::Vec3 middle{0.5f, 0.5f, 0.5f};
    for (const auto& t : room.scene.triangles) {
        const trace::Vec3 a = room.scene.vertices[t[0]], b = room.scene.vertices[t[1]],
                          c = room.scene.vertices[t[2]];
        EXPECT_GT(dot(cross(b - a, c - a), middle - a), 0);
    }
    EXPECT_EQ(room.scene.triangles.size(), 12u);
    EXPECT_EQ(room.scene.lights.size(), 6u);
}

}  // namespace
}  // namespace regather::study
