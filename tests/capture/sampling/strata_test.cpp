// The column of strata: where in the unit square a gather ray was drawn from.
#include "capture/sampling/strata.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "capture/capture.h"
#include "capture/query_pass.h"
#include "tests/capture/small_scenes.h"
#include "tests/scratch.h"

namespace regather::capture {
namespace {

TEST(Strata, APlaceIsTheMiddleOfItsCell) {
    const Strata ten(10);                                  // 2 rows of 5
    EXPECT_EQ(ten.place(0), 16384u << 16 | 6553u);         // a quarter, a tenth
    EXPECT_EQ(ten.place(4), 16384u << 16 | 58982u);        // a quarter, nine tenths
    EXPECT_EQ(ten.place(5), 3 * 16384u << 16 | 6553u);     // three quarters, a tenth
    EXPECT_EQ(Strata(3).place(2), 32768u << 16 | 54613u);  // one row: half, five sixths
    const Strata seven(7, StrataShape::even);          // rows of 3, 2 and 2 cells, as high as they are many
    EXPECT_EQ(seven.place(0), 14043u << 16 | 10922u);  // 3 of 14, a sixth
    EXPECT_EQ(seven.place(3), 37449u << 16 | 16384u);  // 8 of 14, a quarter
    EXPECT_EQ(seven.place(6), 56173u << 16 | 49152u);  // 12 of 14, three quarters
    EXPECT_EQ(Strata(7).place(6), 32768u << 16 | 60854u);  // one row: half, 13 of 14
    EXPECT_EQ(Strata(1 << 20).place((1 << 20) - 1), 65504u << 16 | 65504u);
}

// The smallest and largest coordinates of a cell's samples stand in for its edges.
TEST(Strata, AnyNumberOfCellsShareTheSquareEqually) {
    for (const std::uint32_t count : {1u, 2u, 5u, 7u, 12u, 14u, 23u, 48u, 97u, 101u}) {
        const Strata strata(count, StrataShape::even);
        std::vector<std::array<double, 4>> boxes;  // by least and most, along rows and columns
        for (std::uint32_t cell = 0; cell < count; ++cell) {
            std::array<double, 4> box{1, 0, 1, 0};
            for (std::uint32_t i = 0; i < 4000; ++i) {
                Sampler sampler(9, Stream::gather, cell, i);
                const Strata::Point point = strata.sample(cell, sampler);
                box = {std::fmin(box[0], point.along_rows), std::fmax(box[1], point.along_rows),
                       std::fmin(box[2], point.along_columns), std::fmax(box[3], point.along_columns)};
            }
            EXPECT_NEAR((box[1] - box[0]) * (box[3] - box[2]) * count, 1, 0.01) << cell << " of " << count;
            EXPECT_LT(std::fmax(box[1] - box[0], box[3] - box[2]) * std::sqrt(count), 1.8) << count;
            EXPECT_NEAR((box[0] + box[1]) / 2, (strata.place(cell) >> 16) / 65536.0, 1e-3);
            EXPECT_NEAR((box[2] + box[3]) / 2, (strata.place(cell) & 0xffff) / 65536.0, 1e-3);
            boxes.push_back(box);
        }
        for (std::size_t a = 0; a < boxes.size(); ++a)
            for (std::size_t b = 0; b < a; ++b)
                EXPECT_TRUE(boxes[a][0] >= boxes[b][1] || boxes[b][0] >= boxes[a][1] ||
                            boxes[a][2] >= boxes[b][3] || boxes[b][2] >= boxes[a][3])
                    << a << ", " << b << " of " << count;
    }
}

/// The floor of a closed box, seen from above.
scenes::Scene floor_of_a_box() {
    scenes::Scene scene = closed_box(0.5);
    scene.camera.position = {0.5f, 0.45f, 0.6f};
    scene.camera.target = {0.5f, 0.5f, 0};
    scene.camera.vertical_fov_degrees = 10;
    return scene;
}

TEST(Strata, AGatherRayIsInTheStratumThatItsDirectionIsIn) {
    // Cosine-weighted about +z: sin^2 theta and phi / 2 pi are uniform, the two sides of the unit square.
    const scenes::Scene scene = floor_of_a_box();
    const RayCaster caster(scene);
    const LightSampler lights(scene);
    const QueryConfig config{.width = 4, .height = 3, .gather_rays = 24, .shadow_rays = 1, .seed = 3};
    PixelWork work;
    QueryPass(scene, caster, lights, config, {}).run(0, 12, work);
    const Queries& queries = work.queries;
    ASSERT_EQ(queries.stratum.size(), queries.size());
    ASSERT_GT(queries.size(), 12u * 20);
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (std::size_t q = 0; q < queries.size(); ++q) {
        EXPECT_TRUE(seen.emplace(queries.pixel[q], queries.stratum[q]).second) << "each once a pixel";
        const Vec3 d = queries.direction[q];
        double phi = std::atan2(static_cast<double>(d.y), static_cast<double>(d.x)) / (2 * std::numbers::pi);
        if (phi < 0) phi += 1;
        // 4 rows of 6: half a cell to each side of the middle.
        EXPECT_NEAR(static_cast<double>(d.x) * d.x + static_cast<double>(d.y) * d.y,
                    (queries.stratum[q] >> 16) / 65536.0, 1.0 / 8 + 1e-4);
        EXPECT_NEAR(phi, (queries.stratum[q] & 0xffff) / 65536.0, 1.0 / 12 + 1e-4);
    }
}

TEST(Strata, AreLeftOutWhereNoGatherRayAsks) {
    for (const bool direct : {false, true}) {
        const Scratch scratch;
        CaptureConfig config;
        config.pixels = {.width = 4, .height = 3, .gather_rays = 4, .shadow_rays = 1, .seed = 3};
        if (direct) config.pixels.visualisation = Visualisation::direct;
        config.photon = {.photons = 100, .seed = 3};
        trace::TraceWriter writer(scratch / "trace", false);
        Captured captured = capture(floor_of_a_box(), config, {&writer});
        writer.finish(captured.info);
        trace::TraceReader trace(scratch / "trace");
        EXPECT_EQ(trace.has("query_stratum"), !direct);
        std::string why;
        for (const trace::LeftOut& part : trace.info().left_out)
            if (part.what == "query_stratum") why = part.why;
        EXPECT_EQ(why, direct ? "no gather rays ask these queries" : "");
    }
}

}  // namespace
}  // namespace regather::capture
