#include "scenes/camera_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/catalogue.h"
#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

using ::testing::HasSubstr;

Scene along(std::vector<KeyFrame> keys) {
    Scene scene;
    scene.name = "t";
    scene.camera.vertical_fov_degrees = 40;
    scene.frames = keys.back().frame + 1;
    scene.camera_path = std::move(keys);
    return scene;
}

TEST(CameraPath, PassesThroughItsKeysWithTheScenesFieldOfView) {
    const Scene scene =
        along({{0, {0, 0, 1}, {1, 0, 1}}, {3, {1, 2, 1}, {4, 0, 0}}, {10, {5, 2, 2}, {4, 9, 0}, {0, 1, 1}}});
    for (const KeyFrame& key : scene.camera_path) {
        const Camera camera = camera_at(scene, key.frame);
        EXPECT_EQ(camera.position, key.position);
        EXPECT_EQ(camera.target, key.target);
        EXPECT_LT(length(camera.up - normalize(key.up)), 1e-6f);
        EXPECT_EQ(camera.vertical_fov_degrees, 40);
    }
}

TEST(CameraPath, ACurveByHand) {
    // Keys at x = 0, 4, 12 and frames 0, 4, 8: slopes 1, 12 / 8 and 2 a frame. Frame 2 (t = 1/2) of the first
    // stretch: (0 + 4) / 2 + 4 (1 - 1.5) / 8 = 1.75; frame 6: (4 + 12) / 2 + 4 (1.5 - 2) / 8 = 7.75.
    const Scene scene =
        along({{0, {0, 0, 1}, {0, 9, 1}}, {4, {4, 0, 1}, {0, 9, 1}}, {8, {12, 0, 1}, {0, 9, 1}}});
    EXPECT_FLOAT_EQ(camera_at(scene, 2).position.x, 1.75f);
    EXPECT_FLOAT_EQ(camera_at(scene, 6).position.x, 7.75f);
    // Uneven keys: slope at the middle key is (6 - 0) / (6 - 0) = 1; frame 1 of the stretch of 2 frames from
    // 0 to 2: 1 + 2 (1 - 1) / 8 = 1.
    const Scene uneven =
        along({{0, {0, 0, 1}, {0, 9, 1}}, {2, {2, 0, 1}, {0, 9, 1}}, {6, {6, 0, 1}, {0, 9, 1}}});
    for (std::uint32_t frame = 0; frame <= 6; ++frame)
        EXPECT_FLOAT_EQ(camera_at(uneven, frame).position.x, static_cast<float>(frame));
}

TEST(CameraPath, HasNoKinkAtItsKeys) {
    // Steps of one frame of a path 1000 frames long: on a smooth curve two successive ones differ by h^2
    // times a bounded second derivative; a kink of the slope would show as a difference like h.
    const Scene scene = along({{0, {0, 0, 0}, {9, 9, 9}},
                               {300, {3, 0, 0}, {9, 9, 9}},
                               {450, {3, 3, 0}, {9, 9, 9}},
                               {1000, {0, 3, 3}, {9, 9, 9}}});
    for (std::uint32_t frame = 1; frame + 1 < scene.frames; ++frame) {
        const Vec3 before = camera_at(scene, frame - 1).position, at = camera_at(scene, frame).position;
        const Vec3 after = camera_at(scene, frame + 1).position;
        EXPECT_LT(length((after - at) - (at - before)), 1e-3f) << frame;
    }
}

TEST(CameraPath, UpTurnsEvenly) {
    // A quarter turn in 9 frames: 10 degrees each.
    const Scene scene = along({{0, {0, -3, 0}, {0, 0, 0}, {0, 0, 2}}, {9, {0, -4, 0}, {0, 0, 0}, {3, 0, 0}}});
    for (std::uint32_t frame = 0; frame < 10; ++frame) {
        const Vec3 up = camera_at(scene, frame).up;
        const double angle = frame * 10 * 3.14159265358979 / 180;
        EXPECT_NEAR(up.x, std::sin(angle), 1e-6);
        EXPECT_NEAR(up.z, std::cos(angle), 1e-6);
    }
}

TEST(CameraPath, FramesBeyondItAndScenesWithoutItAreRefused) {
    const auto refused = [](const Scene& scene, std::uint32_t frame) -> std::string {
        try {
            camera_at(scene, frame);
        } catch (const trace::UsageError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refused(along({{0, {0, 0, 0}, {1, 0, 0}}, {4, {0, 1, 0}, {1, 0, 0}}}), 5),
              "frame: found 5, expected 0 to 4 in the scene t");
    EXPECT_THAT(refused(load_scene("box"), 0), HasSubstr("the scene box has no camera path"));
}

TEST(CameraPath, TheFirstFrameOfEachEmbeddedPathIsItsStandingCamera) {
    std::size_t paths = 0;
    for (const EmbeddedScene& entry : catalogue()) {
        const Scene scene = load_scene(entry.name);
        if (scene.camera_path.empty()) continue;
        ++paths;
        EXPECT_GE(scene.frames, 30u) << entry.name;
        const Camera first = camera_at(scene, 0);
        EXPECT_EQ(first.position, scene.camera.position) << entry.name;
        EXPECT_EQ(first.target, scene.camera.target) << entry.name;
        EXPECT_EQ(first.up, scene.camera.up) << entry.name;
    }
    EXPECT_EQ(paths, 7u);
}

std::string with_path(const std::string& path) {
    std::string text = SceneText{}.text();
    return text.insert(1, "\"camera_path\": " + path + ", ");
}

TEST(CameraPath, IsReadFromTheFile) {
    const Scene scene = parse(with_path(
        R"({"frames": 5, "keys": [{"frame": 0, "position": [0, -3, 1], "target": [0, 0, 1]}, {"frame": 4, "position": [1, -3, 1], "target": [0, 0, 1], "up": [0, 1, 1]}]})"));
    EXPECT_EQ(scene.frames, 5u);
    ASSERT_EQ(scene.camera_path.size(), 2u);
    EXPECT_EQ(scene.camera_path[1].position, (Vec3{1, -3, 1}));
    EXPECT_EQ(scene.camera_path[1].up, (Vec3{0, 1, 1}));
    EXPECT_EQ(scene.camera_path[0].up, (Vec3{0, 0, 1}));
}

TEST(CameraPath, KeysThatDoNotMakeAPathAreRefused) {
    const auto keys = [](const std::string& first, const std::string& last) {
        return refusal(with_path(R"({"frames": 5, "keys": [{"frame": )" + first +
                                 R"(, "position": [0, -3, 1], "target": [0, 0, 1]}, {"frame": )" + last +
                                 R"(, "position": [1, -3, 1], "target": [0, 0, 1]}]})"));
    };
    EXPECT_EQ(keys("0", "4"), "");
    EXPECT_EQ(keys("1", "4"),
              "t.json: camera_path.keys[0].frame: found 1, expected 0 in the first key frame");
    EXPECT_EQ(
        keys("0", "3"),
        "t.json: camera_path.keys[1].frame: found 3, expected 4, the last frame, in the last key frame");
    EXPECT_THAT(
        keys("0", "0"),
        HasSubstr("camera_path.keys[1].frame: found 0 after 0, expected a whole number, below frames"));
    EXPECT_THAT(keys("0", "5"), HasSubstr("camera_path.keys[1].frame: found 5"));
    EXPECT_THAT(refusal(with_path(
                    R"({"frames": 5, "keys": [{"frame": 0, "position": [0, -3, 1], "target": [0, 0, 1]}]})")),
                HasSubstr("camera_path.keys: found a list of 1, expected a list of at least two"));
    EXPECT_THAT(
        refusal(with_path(
            R"({"frames": 5, "keys": [{"frame": 0, "position": [0, -3, 1], "target": [0, -3, 1]}, {"frame": 4, "position": [1, -3, 1], "target": [0, 0, 1]}]})")),
        HasSubstr("camera_path.keys[0].target: found the key frame's position"));
}

}  // namespace
}  // namespace regather::scenes
