// Table 2 of the paper: the figures that its rows give, and those that are printed.
#include "study/computation/computation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "study/computation/computation_job.h"
#include "study/computation/estimate.h"
#include "trace/error.h"

namespace regather::study {
namespace {

using testing::HasSubstr;

/// What parse_values() says against `words`; "" when it takes them.
std::string refusal(const std::vector<std::string>& words) {
    try {
        parse_values(words, "--set");
    } catch (const trace::UsageError& error) {
        return error.what();
    }
    return "";
}

// 1024 x 768 x 2 eye rays; 117 rays each of 18 and 20 x 30 FLOP, 101 gathers each of 100 x 20 FLOP.
TEST(Table2, ItsRowsMultiplyToLessThanIsPrinted) {
    const Operations rows = operations(Computation());
    EXPECT_EQ(rows.eye_rays, 1572864);
    EXPECT_EQ(rows.shadow_rays, 25165824);
    EXPECT_EQ(rows.rays(), 184025088);
    EXPECT_EQ(rows.generation, 3312451584);
    EXPECT_EQ(rows.casting, 110415052800);
    EXPECT_EQ(rows.gathers, 317718528000);
    EXPECT_EQ(rows.sampling, 0);
    EXPECT_EQ(rows.caching, 0);
    EXPECT_EQ(rows.total(), 431446032384);
}

// Printed: 187170816 rays, 3.37, 112, 321 and 437 GFLOP, each rounded to so many digits.
TEST(Table2, ItsPrintedSumsAreThoseOf102GatherRaysAnd102Gathers) {
    const Operations print = operations(printed_computation());
    EXPECT_EQ(print.rays(), 187170816);
    EXPECT_NEAR(print.generation, 3.37e9, 0.005e9);
    EXPECT_NEAR(print.casting, 112e9, 0.5e9);
    EXPECT_NEAR(print.gathers, 321e9, 0.5e9);
    EXPECT_NEAR(print.total(), 437e9, 0.5e9);
    // Neither change does without the other.
    Computation rays, gathers;
    rays[Input::gather_rays] = 102;
    gathers[Input::gathers] = 102;
    EXPECT_GT(321e9 - operations(rays).gathers, 0.5e9);
    EXPECT_NE(operations(gathers).rays(), 187170816);
    // The 101 gathers of its own row as gather rays, beside the eye ray's one, are too few, too.
    rays[Input::gather_rays] = 101;
    EXPECT_NE(operations(rays).rays(), 187170816);
}

TEST(Operations, EachParameterStandsWhereItBelongs) {
    Computation of;
    of.values = {3, 2, 0.5, 5, 7, 11, 13, 2, 17, 3, 19, 23, 29, 31, 37, 41, 43, 47, 0.25, 52};
    const Operations at = operations(of);
    EXPECT_EQ(at.eye_rays, 6);
    EXPECT_EQ(at.specular_rays, 3);
    EXPECT_EQ(at.shadow_rays, 30);
    EXPECT_EQ(at.gather_rays, 42);
    EXPECT_EQ(at.rays(), 81);
    EXPECT_EQ(at.generation, 81 * 11);
    EXPECT_EQ(at.casting, 81 * (13 * 2 + 17 * 3));
    EXPECT_EQ(at.gathers, 6 * 19 * (23 * 29 + 31 * 37));
    EXPECT_EQ(at.sampling, 6 * 41 + 42 * 43);
    EXPECT_EQ(at.caching, 6 * (47 + 0.25 * 52));
    EXPECT_EQ(at.total(), 891 + 6237 + 206796 + 2052 + 360);
}

TEST(Parameters, EachHasANameAndAPlaceInItsRange) {
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < input_count; ++i) {
        const ComputationParameter& parameter = computation_parameters()[i];
        EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
        EXPECT_NO_THROW(check_value(static_cast<Input>(i), parameter.paper, "here"));
        for (const double absurd :
             {-1.0, 1e300, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
            EXPECT_THROW(check_value(static_cast<Input>(i), absurd, "here"), trace::UsageError)
                << parameter.name << ' ' << absurd;
    }
}

// By hand from the figures above: the BRDFs are 317718528000 of 431446032384, shadow rays 25165824 x 618.
TEST(Sensitivity, EachParameterAloneIsDividedAndMultiplied) {
    const auto rows = sensitivity_of({"paper", "", {}}, 2);
    ASSERT_EQ(rows.size(), input_count);
    const auto row = [&](Input input) { return rows[static_cast<std::size_t>(input)]; };
    EXPECT_EQ(row(Input::brdf_flops).parameter, "brdf_flops");
    EXPECT_EQ(row(Input::brdf_flops).divided_total_flop, 272586768384);
    EXPECT_EQ(row(Input::brdf_flops).times_total_flop, 749164560384);
    EXPECT_EQ(row(Input::shadow_rays).divided_total_flop, 423669792768);
    EXPECT_EQ(row(Input::shadow_rays).times_total_flop, 446998511616);
    EXPECT_EQ(row(Input::intersection_flops).times_total_flop, 431446032384 + 110415052800);
    EXPECT_EQ(row(Input::pixels).divided_total_flop, 431446032384 / 2);
    EXPECT_EQ(row(Input::records).times_total_flop, 431446032384);  // of what costs nothing
    EXPECT_EQ(row(Input::ray_flops).value, 18);
    EXPECT_EQ(row(Input::ray_flops).total_flop, 431446032384);
    EXPECT_EQ(row(Input::ray_flops).rays, 184025088);
    EXPECT_EQ(sensitivity_of({"paper", "", {}}, 3)[static_cast<std::size_t>(Input::samples)].times_total_flop,
              3 * 431446032384);
}

RC_GTEST_PROP(Sensitivity, TheTotalIsLinearInEachParameter, ()) {
    ComputationEstimate estimate{"any", "", {}};
    for (std::size_t i = 0; i < input_count; ++i)
        estimate.counted.values.values[i] = *rc::gen::inRange(1, 40);
    const int factor = *rc::gen::inRange(2, 9);
    for (const results::ComputationRow& row : sensitivity_of(estimate, factor)) {
        // Of a total a + b x: b x / f and f b x beside a.
        const double up = *row.times_total_flop - *row.total_flop,
                     down = *row.total_flop - *row.divided_total_flop;
        RC_ASSERT(up >= 0);
        RC_ASSERT(std::abs(up - factor * down) <= 1e-9 * *row.total_flop);
    }
}

TEST(Values, AreNamedOrRefusedWithTheNearestName) {
    const auto values = parse_values(std::vector<std::string>{"gathers=102", "samples=0.5"}, "--set");
    ASSERT_EQ(values.size(), 2u);
    EXPECT_EQ(values[0].input, Input::gathers);
    EXPECT_EQ(values[0].value, 102);
    EXPECT_EQ(values[1].input, Input::samples);
    EXPECT_EQ(values[1].value, 0.5);
    EXPECT_THAT(refusal({"gather_ray=7"}), HasSubstr("--set: unknown parameter \"gather_ray\"; nearest: "
                                                     "gather_rays; known: pixels, samples,"));
    EXPECT_THAT(refusal({"gathers=1", "gathers=2"}), HasSubstr("--set: gathers is given twice"));
    for (const char* word : {"gathers", "gathers=", "gathers=x", "gathers=1x", "gathers=nan", "gathers=inf"})
        EXPECT_THAT(refusal({word}), HasSubstr("expected gathers=NUMBER")) << word;
    EXPECT_THAT(refusal({"pixels=0.5"}), HasSubstr("pixels is 0.5, expected a number from 1 to 4294967296"));
    EXPECT_THAT(refusal({"found=-1"}), HasSubstr("found is -1"));
}

TEST(Computation, TellsRowsPrintAndWhatEachNeeds) {
    const ComputationResult result = run({.traces = {}, .settings = {"brdf_flops=10"}, .factor = 2}, {});
    ASSERT_EQ(result.tables.size(), 2u);
    const std::string text = results::text_of(result.tables);
    for (const char* part :
         {"187170816  184025088  187170816  184025088", "437      431.4      436.5      272.6",
          "117 an eye ray", "119 an eye ray: they need 102 gather rays where the row has 100",
          "they need 102 gathers an eye ray (320.9) where the row has 101 (317.7)", "--set"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_EQ(result.rows.size(), 3 * input_count);
    EXPECT_EQ(result.rows.front().model, "paper");
    EXPECT_EQ(result.rows.back().model, "set");
    for (const double factor : {1.0, 0.5, 1001.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(run({.traces = {}, .settings = {}, .factor = factor}, {}), trace::UsageError);
}

}  // namespace
}  // namespace regather::study
