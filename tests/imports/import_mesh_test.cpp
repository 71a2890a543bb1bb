#include "imports/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "imports/orbit.h"
#include "scenes/loader.h"
#include "tests/imports/archive.h"
#include "tests/scratch.h"
#include "trace/bounds.h"

namespace regather::imports {

using scenes::Scene;
namespace {

using ::testing::HasSubstr;
using Up = MeshImportOptions::Up;

// A tetrahedron 30 high along y, far from the origin.
constexpr const char* model = R"(mtllib m.mtl
v 100 100 100
v 110 100 100
v 100 100 110
v 100 130 100
usemtl red
f 1 2 3
f 1 4 2
usemtl shiny
f 1 3 4
f 2 4 3
)";
constexpr const char* library =
    "newmtl red\nKd 0.5 0 0\nillum 1\nnewmtl shiny\nKd 0.25 0.25 0.25\nKs 0.5 0.5 0.5\nNs 30\n";

trace::Bounds3 bounds_of_object(const ImportedScene& scene) {
    trace::Bounds3 bounds;
    for (const ImportedMesh& mesh : scene.meshes)
        if (scene.materials[mesh.material].name != "studio_floor")
            bounds.include(trace::bounds_of(mesh.surface.vertices));
    return bounds;
}

TEST(ImportMesh, TheObjectStandsInTheMiddleOfTheFloorAtItsSize) {
    const Scratch scratch;
    trace::write_whole(scratch / "m.obj", model);
    trace::write_whole(scratch / "m.mtl", library);
    trace::Bounds3 bounds = bounds_of_object(import_mesh(scratch / "m.obj", {.up = Up::y, .size = 3}));
    EXPECT_NEAR(bounds.min.z, 0, 1e-5);
    EXPECT_NEAR(bounds.max.z, 3, 1e-5);
    EXPECT_NEAR(bounds.min.x + bounds.max.x, 0, 1e-5);
    EXPECT_NEAR(bounds.extent().x, 1, 1e-5);
    EXPECT_NEAR(bounds.extent().y, 1, 1e-5);
    bounds = bounds_of_object(import_mesh(scratch / "m.obj", {.up = Up::z, .size = 3}));
    EXPECT_NEAR(bounds.extent().z, 1, 1e-5);
    EXPECT_NEAR(bounds.extent().y, 3, 1e-5);
}

TEST(ImportMesh, FacesStayOutwardWhicheverAxisIsUp) {
    const Scratch scratch;
    trace::write_whole(scratch / "m.obj", model);
    for (const Up up : {Up::x, Up::y, Up::z}) {
        const ImportedScene scene = import_mesh(scratch / "m.obj", {.up = up, .size = 3});
        double volume = 0;
        for (const ImportedMesh& mesh : scene.meshes)
            if (scene.materials[mesh.material].name != "studio_floor")
                for (const auto& [a, b, c] : mesh.surface.triangles)
                    volume +=
                        static_cast<double>(dot(mesh.surface.vertices[a],
                                                cross(mesh.surface.vertices[b], mesh.surface.vertices[c]))) /
                        6;
        EXPECT_NEAR(volume, 0.5, 1e-4);  // 1 x 1 x 3 / 6
    }
}

TEST(ImportMesh, EachAxisOfTheFileGoesToItsOwn) {
    // Edges of 1, 2 and 3 along x, y and z from one corner.
    const Scratch scratch;
    trace::write_whole(scratch / "m.obj",
                       "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    // Where x, y and z of the file point in the scene, whose z is up.
    const std::array<std::pair<Up, std::array<Vec3, 3>>, 3> cases{
        {{Up::x, {{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}}},
         {Up::y, {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}},
         {Up::z, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}}};
    for (const auto& [up, directions] : cases) {
        const ImportedScene scene = import_mesh(scratch / "m.obj", {.up = up, .size = 3});
        const Surface& surface = scene.meshes.back().surface;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Vec3 edge = directions[axis] * static_cast<float>(axis + 1);
            bool is_there = false;
            for (const Vec3 a : surface.vertices)
                for (const Vec3 b : surface.vertices) is_there |= length(b - a - edge) < 1e-5f;
            EXPECT_TRUE(is_there) << axis;
        }
        const trace::Bounds3 bounds = bounds_of_object(scene);
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(std::abs(dot(bounds.extent(), directions[axis])), static_cast<float>(axis + 1),
                        1e-5f);
    }
}

TEST(ImportMesh, MaterialsAreTheFilesAndTheSceneLoads) {
    const Scratch scratch;
    trace::write_whole(scratch / "m.obj", model);
    trace::write_whole(scratch / "m.mtl", library);
    write_scene(import_mesh(scratch / "m.obj"), scratch / "out");
    const Scene scene = scenes::load_scene((scratch / "out/scene.json").string());
    EXPECT_EQ(scene.triangles.size(), 4u + 128 + 2);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_GE(scene.frames, 30u);
    bool red = false, shiny = false;
    for (const Material& material : scene.materials) {
        red |= material.name == "red" && material.kind == MaterialKind::diffuse &&
               material.diffuse == Vec3{0.5f, 0, 0};
        shiny |= material.name == "shiny" && material.kind == MaterialKind::glossy && material.exponent == 30;
    }
    EXPECT_TRUE(red && shiny);
}

TEST(ImportMesh, NonsenseIsRefused) {
    const Scratch scratch;
    trace::write_whole(scratch / "m.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
    EXPECT_THAT(data_error([&] { import_mesh(scratch / "m.obj"); }),
                HasSubstr("m.obj: line 3: found the vertex 9"));
    EXPECT_THAT(data_error([&] { import_mesh(scratch / "gone.ply"); }), HasSubstr("gone.ply: found no file"));
    trace::write_whole(scratch / "m.obj", model);
    EXPECT_THROW(import_mesh(scratch / "m.obj", {.size = 0}), trace::UsageError);
    EXPECT_THROW(import_mesh(scratch / "m.obj", {.size = std::nan("")}), trace::UsageError);
}

TEST(Orbit, EveryKeyIsOnTheCircleAndTheFramesRise) {
    const std::vector<KeyFrame> keys = keys_of({.center = {1, 2, 3},
                                                .distance = 2,
                                                .height = 0.5,
                                                .from_degrees = -90,
                                                .to_degrees = 90,
                                                .frames = 36});
    EXPECT_EQ(keys.front().frame, 0u);
    EXPECT_EQ(keys.back().frame, 35u);
    EXPECT_NEAR(keys.front().position.y, 0, 1e-6);
    EXPECT_NEAR(keys.back().position.y, 4, 1e-6);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        EXPECT_NEAR(std::hypot(keys[i].position.x - 1, keys[i].position.y - 2), 2, 1e-6);
        EXPECT_TRUE(i == 0 || keys[i].frame > keys[i - 1].frame);
    }
    EXPECT_EQ(keys_of({.center = {}, .frames = 2}).size(), 2u);
}

}  // namespace
}  // namespace regather::imports
