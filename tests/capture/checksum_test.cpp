#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>

#include "capture/capture.h"
#include "tests/capture/small_scenes.h"

namespace regather::capture {
namespace {

Scene scene_with_everything() {
    Scene scene = closed_box(0.5);
    scene.normals.resize(scene.vertices.size());
    return scene;
}

// What a picture or a trace depends on, each changed by itself, to a value that no other change gives.
TEST(SceneChecksum, ChangesWithEachFieldOfTheScene) {
    const std::map<std::string, std::function<void(Scene&)>> changes{
        {"vertex", [](Scene& s) { s.vertices[1].y += 0.25f; }},
        {"a vertex more",
         [](Scene& s) {
             s.vertices.push_back({});
             s.normals.push_back({});
         }},
        {"normal", [](Scene& s) { s.normals[2].x = 1; }},
        {"triangle", [](Scene& s) { std::swap(s.triangles[0][1], s.triangles[0][2]); }},
        {"triangles change places", [](Scene& s) { std::swap(s.triangles[0], s.triangles[1]); }},
        {"material of a triangle", [](Scene& s) { s.triangle_material[1] += 1; }},
        {"light of a triangle", [](Scene& s) { s.triangle_light[1] = 7; }},
        {"kind", [](Scene& s) { s.materials[0].kind = scenes::MaterialKind::mirror; }},
        {"diffuse", [](Scene& s) { s.materials[0].diffuse.z += 0.125f; }},
        {"specular", [](Scene& s) { s.materials[0].specular.y += 0.125f; }},
        {"exponent", [](Scene& s) { s.materials[0].exponent += 1; }},
        {"index of refraction", [](Scene& s) { s.materials[0].index_of_refraction += 0.125f; }},
        {"corner", [](Scene& s) { s.lights[0].corner.x += 0.25f; }},
        {"edge u", [](Scene& s) { s.lights[0].edge_u.x += 0.25f; }},
        {"edge v", [](Scene& s) { s.lights[0].edge_v.x += 0.25f; }},
        {"radiance", [](Scene& s) { s.lights[0].radiance.y += 1; }},
        {"position", [](Scene& s) { s.camera.position.z += 1; }},
        {"target", [](Scene& s) { s.camera.target.z += 1; }},
        {"up", [](Scene& s) { s.camera.up.x += 1; }},
        {"field of view", [](Scene& s) { s.camera.vertical_fov_degrees += 1; }},
    };
    std::map<std::string, std::string> by_checksum{{checksum(scene_with_everything()), "no change"}};
    for (const auto& [what, change] : changes) {
        Scene scene = scene_with_everything();
        change(scene);
        const auto [same, added] = by_checksum.emplace(checksum(scene), what);
        EXPECT_TRUE(added) << what << " gives the checksum of: " << same->second;
    }
}

// Its own name, its materials' names and where it is from are for people; frames give their cameras.
TEST(SceneChecksum, IsBlindToWhatNoPictureShows) {
    const std::string before = checksum(scene_with_everything());
    Scene scene = scene_with_everything();
    scene.name += "x";
    scene.materials[0].name += "x";
    scene.origin = scene.licence = "elsewhere";
    scene.frames = 5;
    EXPECT_EQ(checksum(scene), before);
}

}  // namespace
}  // namespace regather::capture
