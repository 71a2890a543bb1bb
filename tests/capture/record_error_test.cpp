// What packed photons do to estimates and to a whole picture.
#include "capture/record_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/capture.h"
#include "capture/images/flip.h"
#include "capture/images/image_error.h"
#include "spatial/photons/nearest.h"
#include "tests/capture/small_scenes.h"
#include "trace/packed_photon.h"

namespace regather::capture {
namespace {

TEST(RecordError, AnEstimateOfTheSamePhotonsChangesAsTheAreaOfItsDisc) {
    // Seven photons of unlike powers and directions; two far ones make the box. Each moves by d at most, so
    // that the disc's radius r does, too: the estimate changes by ((r / (r - d))^2 - 1) of itself at most.
    std::vector<trace::Photon> photons(9);
    const float x[] = {0.0131f, -0.0277f, 0.0419f, -0.0533f, 0.0617f, 0.0749f, -0.0891f, -50000, 90000};
    for (std::size_t i = 0; i < photons.size(); ++i) {
        const auto n = static_cast<float>(i);
        photons[i].position = {x[i], 0.003f * n, 0};
        trace::encode_power({0.5f + n, 0.07f * n + 0.1f, 3 / (1 + n)}, photons[i].power);
        trace::encode_direction(trace::normalize(trace::Vec3{0.3f * n - 1, 0.2f, -1}), photons[i]);
        trace::encode_normal({0, 0, 1}, photons[i]);
    }
    const Material material{.name = "red", .diffuse = {0.8f, 0.3f, 0.1f}};
    const auto estimate = [&] {
        const std::vector<trace::Photon> heap = spatial::left_balanced(photons);
        const spatial::PhotonKd tree(heap);
        spatial::NearestSet found(6, std::numeric_limits<float>::infinity());
        spatial::nearest(tree, {0.002f, 0.001f, 0}, found);
        return reflected_radiance(tree, found, {&material, {0, 0, 1}, {0, 0, 1}}, Filter::none, true);
    };
    const trace::Vec3 whole = estimate();
    const double radius = 0.0729 - 0.001, moved = trace::pack_positions(photons);
    ASSERT_GT(moved, 0.001);
    ASSERT_LT(moved, 0.034);  // half a step of 140000 / 2097151, and less along y
    const trace::Vec3 packed = estimate();
    const double most = std::pow(radius / (radius - moved), 2) - 1;
    EXPECT_NE(packed.x, whole.x);
    for (int c = 0; c < 3; ++c)
        EXPECT_LE(std::fabs(static_cast<double>(packed[c]) / static_cast<double>(whole[c]) - 1), most) << c;
}

CaptureConfig small(PhotonRecord record) {
    CaptureConfig config;
    config.pixels = {
        .width = 24, .height = 16, .gather_rays = 4, .shadow_rays = 1, .max_specular = 16, .seed = 5};
    config.photon = {.photons = 5000, .seed = 5};
    config.gather.k = 30;
    config.record = record;
    return config;
}

TEST(RecordError, OfACaptureIsThatOfItsImageAgainstTheOneFromWholePhotons) {
    const scenes::Scene scene = closed_box(0.6);
    const Captured whole = capture(scene, small(PhotonRecord::whole));
    const Captured packed = capture(scene, small(PhotonRecord::packed));
    EXPECT_FALSE(whole.record_error);
    ASSERT_TRUE(packed.record_error);
    const RecordError& error = *packed.record_error;
    const double mean = mean_radiance(whole.image);
    EXPECT_DOUBLE_EQ(error.relative_rmse, image_errors(packed.image, whole.image).rmse / mean);
    EXPECT_NEAR(error.relative_mean, mean_radiance(packed.image) / mean - 1, 1e-12);
    EXPECT_DOUBLE_EQ(error.flip, mean_flip(hdr_flip(packed.image, whole.image)));
    // A box of 1 m: half a step is 2.4e-7 m, a gather's radius some 0.06 m.
    EXPECT_GT(error.farthest, 1e-7);
    EXPECT_LT(error.farthest, 5e-7);
    EXPECT_GT(error.relative_rmse, 0);
    EXPECT_LT(error.relative_rmse, 1e-3);
    EXPECT_EQ(packed.info.parameters.find("photon_record")->number(), 16);
    EXPECT_EQ(whole.info.parameters.find("photon_record"), nullptr);
    EXPECT_EQ(packed.info.counts.find("packed_relative_rmse")->number(), error.relative_rmse);
}

TEST(RecordError, OfBlackImagesIsNothing) {
    const Image black{3, 2, std::vector<trace::Vec3>(6)};
    const RecordError error = record_error(black, black, 0.5);
    EXPECT_EQ(error.farthest, 0.5);
    EXPECT_EQ(error.relative_rmse, 0);
    EXPECT_EQ(error.relative_mean, 0);
    EXPECT_EQ(error.flip, 0);
}

}  // namespace
}  // namespace regather::capture
