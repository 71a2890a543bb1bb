#include "capture/fingerprint.h"

#include <gtest/gtest.h>

#include "scenes/loader.h"

namespace regather::capture {
namespace {

TEST(Fingerprint, IsTheSameAgainAndAnotherForWhatLooksOtherwise) {
    scenes::Scene scene = scenes::load_scene("cornell");
    const std::string known = fingerprint(scene);
    EXPECT_EQ(known.size(), 16u);
    EXPECT_EQ(fingerprint(scene), known);
    scene.camera.position.y += 0.01f;
    EXPECT_NE(fingerprint(scene), known);
    EXPECT_NE(fingerprint(scenes::load_scene("caustics")), known);
}

}  // namespace
}  // namespace regather::capture
