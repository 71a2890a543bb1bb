#include "results/computation_row.h"

#include <gtest/gtest.h>

#include "results/csv.h"

namespace regather::results {
namespace {

ComputationRow estimate(std::string model, std::string parameter, double total, double divided,
                        double times) {
    ComputationRow row;
    row.model = std::move(model);
    row.parameter = std::move(parameter);
    row.what = "the " + row.parameter;
    row.factor = 4;
    row.total_flop = total;
    row.divided_total_flop = divided;
    row.times_total_flop = times;
    return row;
}

TEST(ComputationRow, IsWrittenAsDrawnByHand) {
    ComputationRow drawn = estimate("measured", "found", 431446032384, 0.5, 1e12);
    drawn.scene = "room";
    drawn.value = 98.75;
    drawn.source = "found_photons / queries";
    drawn.rays = 184025088;
    drawn.generation_flop = 1;
    drawn.casting_flop = 2;
    drawn.gather_flop = 3;
    drawn.sampling_flop = 4;
    drawn.caching_flop = 5;
    EXPECT_EQ(to_csv<ComputationRow>(std::span(&drawn, 1)),
              "scene,model,parameter,what,value,source,factor,rays,generation_flop,casting_flop,gather_flop,"
              "sampling_flop,caching_flop,total_flop,divided_total_flop,times_total_flop\n"
              "room,measured,found,the found,98.75,found_photons / queries,4,184025088,1,2,3,4,5,"
              "431446032384,0.5,1000000000000\n");
}

TEST(SensitivityTable, SortsByTheSwingOfTheLastEstimate) {
    const std::vector<ComputationRow> rows{
        estimate("paper", "rays", 200, 150, 400), estimate("paper", "k", 200, 190, 240),
        estimate("paper", "idle", 200, 200, 200), estimate("mine", "rays", 50, 49, 54),
        estimate("mine", "k", 50, 20, 170)};
    EXPECT_EQ(text_of(sensitivity_table(rows)),
              "change of the total when one parameter alone is divided by 4 and times 4\n"
              "parameter  what                 paper              mine\n"
              "k          the k      -5.0 %  +20.0 %  -60.0 % +240.0 %\n"
              "rays       the rays  -25.0 % +100.0 %   -2.0 %   +8.0 %\n"
              "no change by: idle\n");
}

TEST(SensitivityTable, OfNoRowsIsEmpty) {
    EXPECT_TRUE(sensitivity_table({}).empty());
}

}  // namespace
}  // namespace regather::results
