// tests/imports/home_text.h -- small homes of Sweet Home 3D, written by hand, and their import.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "imports/homes/sweethome3d.h"
#include "tests/imports/archive.h"
#include "tests/scratch.h"
#include "trace/bounds.h"

namespace regather::imports {

// A model 2 wide, 1 high and 4 deep, whose front (towards +z) is one material and all else another.
inline constexpr const char* wedge = R"(mtllib wedge.mtl
v -1 0 -2
v 1 0 -2
v 1 0 2
v -1 0 2
v -1 1 -2
v 1 1 -2
v 1 1 2
v -1 1 2
g front
usemtl face
f 4 3 7 8
g body
usemtl amber
f 1 2 3 4
f 5 8 7 6
f 2 1 5 6
f 1 4 8 5
f 3 2 6 7
g sweethome3d_window_pane
usemtl amber
f 4 3 7 8
g rest
f 1 2 3
)";
inline constexpr const char* library = "newmtl face\nKd 0.25 0.5 0.125\nillum 1\n";

struct HomeText {
    std::string walls = R"(<wall id='w' xStart='0' yStart='0' xEnd='400' yEnd='0' thickness='10'/>)";
    std::string piece =
        R"(<pieceOfFurniture name='p' model='m/wedge.obj' x='100' y='200' angle='1.5707963267948966' elevation='50' width='40' depth='20' height='10'/>)";
    std::string rest{};
    std::string text() const {
        return R"(<?xml version='1.0'?><home name='h' wallHeight='250'><property name='Author' value='A &amp; B'/>)"
               R"(<observerCamera attribute='observerCamera' x='100' y='200' z='170' yaw='3.14159265' pitch='0' fieldOfView='1'/>)" +
               walls + piece + rest +
               R"(<room floorColor='FF808080'><point x='0' y='0'/><point x='400' y='0'/><point x='400' y='300'/><point x='0' y='300'/></room></home>)";
    }
};

class Sweethome : public ::testing::Test {
protected:
    ImportedScene import(const std::string& xml, const std::string& model = wedge) {
        write_zip(scratch_ / "t.sh3d", {{"Home.xml", xml}, {"m/wedge.obj", model}, {"m/wedge.mtl", library}});
        return import_sweethome3d(scratch_ / "t.sh3d", "");
    }
    std::string refusal(const HomeText& text) {
        return data_error([&] { import(text.text()); });
    }
    static trace::Bounds3 bounds_of(const ImportedScene& scene, std::string_view material) {
        trace::Bounds3 bounds;
        for (const ImportedMesh& mesh : scene.meshes)
            if (scene.materials[mesh.material].name == material)
                bounds.include(trace::bounds_of(mesh.surface.vertices));
        return bounds;
    }
    static const Material* find(const ImportedScene& scene, std::string_view name) {
        for (const Material& material : scene.materials)
            if (material.name == name) return &material;
        return nullptr;
    }
    Scratch scratch_;
};

inline void expect_near(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-5);
    EXPECT_NEAR(a.y, b.y, 1e-5);
    EXPECT_NEAR(a.z, b.z, 1e-5);
}

}  // namespace regather::imports
