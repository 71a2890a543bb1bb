// Mesh files as shapes of a scene: where they stand, what is counted, named and refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class MeshShape : public ::testing::Test {
protected:
    Scene scene(const std::string& shapes) const {
        return parse_scene(SceneText{.shapes = shapes}.text(), "t.json", folder_.path());
    }
    ScratchFolder folder_;
};

TEST_F(MeshShape, YUpBecomesZUp) {
    folder_.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const Scene turned = scene(R"({"type": "mesh", "file": "t.obj", "material": "white", "up_axis": "y"})");
    // The file's y is up: its (0, 2, 0) stands at (0, 0, 2), and its (0, 0, 3), towards the viewer, at (0,
    // -3, 0).
    EXPECT_EQ(turned.bounds().min, (Vec3{0, -3, 0}));
    EXPECT_EQ(turned.bounds().max, (Vec3{1, 0, 2}));
    const Scene plain = scene(R"({"type": "mesh", "file": "t.obj", "material": "white"})");
    EXPECT_EQ(plain.bounds().max, (Vec3{1, 2, 3}));
}

TEST_F(MeshShape, IsScaledThenTurnedThenMoved) {
    folder_.write("t.obj", "v 1 0 0\nv 2 0 0\nv 1 1 1\nf 1 2 3\n");
    const Scene placed = scene(R"({"type": "mesh", "material": "white", "file": "t.obj", "scale": 2,
        "rotate_z_degrees": 90, "translate": [10, 20, 30]})");
    ASSERT_EQ(placed.triangles.size(), 1u);
    // (1, 1, 1) -> (2, 2, 2) -> (-2, 2, 2) -> (8, 22, 32)
    const Vec3 expected[] = {{10, 22, 30}, {10, 24, 30}, {8, 22, 32}};
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(length(placed.vertices[placed.triangles[0][i]] - expected[i]), 0, 1e-5) << i;
}

TEST_F(MeshShape, ARefusalNamesItsFieldAndTheMeshFile) {
    const std::string shape = R"({"type": "mesh", "material": "white", "file": "none.ply"})";
    EXPECT_THAT(refusal(SceneText{.shapes = shape}.text(), folder_.path()),
                HasSubstr("shapes[0].file: found \"none.ply\", expected a readable mesh (" +
                          (folder_.path() / "none.ply").string() +
                          ": found no file, expected an OBJ, PLY or glTF mesh)"));
}

TEST_F(MeshShape, FacesWithoutAreaAreCounted) {
    folder_.write("d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
    const std::string shape = R"({"type": "mesh", "material": "white", "file": "d.obj"})";
    const Scene twice = scene(shape + "," + shape);
    EXPECT_EQ(twice.triangles.size(), 2u);
    EXPECT_EQ(twice.degenerate_faces_dropped, 2u);
}

TEST_F(MeshShape, WhatAFileHoldsBeyondItIsNotedOnceHoweverOftenItStands) {
    folder_.write("n.obj", "v 0 0 0 1 1 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\nl 2 3\n");
    folder_.write("p.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string noted = R"({"type": "mesh", "material": "white", "file": "n.obj")",
                      plain = R"({"type": "mesh", "material": "white", "file": "p.obj"})";
    const std::string file = (folder_.path() / "n.obj").string();
    for (const std::string place :
         {"}", R"(, "translate": [5000, 0, 0]})"})  // the second is recentred, and built anew
        EXPECT_THAT(scene(noted + place + "," + noted + place).notes,
                    ElementsAre(file + ": colours of vertices are not read: 1",
                                file + ": lines (l) are not read: 2"));
    EXPECT_THAT(scene(plain).notes, ElementsAre());
}

TEST(MeshAsAScene, IsAnsweredWithWhatToType) {
    for (const std::string name : {"teapot.obj", "a/b.PLY", "c.glb"}) {
        try {
            load_scene(name);
            FAIL();
        } catch (const trace::UsageError& error) {
            EXPECT_THAT(error.what(), HasSubstr("regather import mesh " + name + " -o DIR"));
        }
    }
}

}  // namespace
}  // namespace regather::scenes
