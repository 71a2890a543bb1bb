#include "scenes/loader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

using ::testing::HasSubstr;

const std::string light = R"({"corner": [0, 0, 3], "edge_u": [0, 2, 0], "edge_v": [3, 0, 0], )";

TEST(Loader, ASceneBecomesTrianglesInTheFilesOrderWithLightsLast) {
    SceneText text;
    text.materials += R"(, "black": {"kind": "diffuse", "diffuse": [0, 0, 0]})";
    text.shapes += R"(, {"type": "box", "material": "black", "min": [0, 0, 0], "max": [1, 1, 1]})";
    text.lights = light + R"("radiance": [1, 2, 3], "material": "white"})";
    const Scene scene = parse(text.text());
    EXPECT_EQ(scene.name, "t");
    ASSERT_EQ(scene.triangles.size(), 2u + 12 + 2);
    const auto material = [&](std::size_t t) { return scene.materials[scene.triangle_material[t]].name; };
    EXPECT_EQ(material(1), "white");
    EXPECT_EQ(material(2), "black");
    EXPECT_EQ(material(14), "white");
    EXPECT_EQ(scene.triangle_light[13], -1);
    EXPECT_EQ(scene.triangle_light[14], 0);
    EXPECT_EQ(scene.triangle_light[15], 0);
    EXPECT_EQ(scene.camera.position, (Vec3{0, -3, 1}));
    EXPECT_EQ(scene.camera.vertical_fov_degrees, 50);
}

TEST(Loader, ALightsTrianglesFaceTheWayItShines) {
    const Scene scene = parse(SceneText{.lights = light + R"("radiance": [1, 2, 3]})"}.text());
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].normal(), (Vec3{0, 0, -1}));
    for (std::size_t t = 2; t < 4; ++t) {
        const auto [a, b, c] = scene.triangles[t];
        EXPECT_LT(cross(scene.vertices[b] - scene.vertices[a], scene.vertices[c] - scene.vertices[a]).z, 0);
    }
}

TEST(Loader, PowerIsPiTimesAreaTimesRadiance) {
    const Scene by_power = parse(SceneText{.lights = light + R"("power": [60, 30, 0]})"}.text());
    const float per_watt = 1 / (std::numbers::pi_v<float> * 6);
    EXPECT_NEAR(by_power.lights[0].radiance.x, 60 * per_watt, 1e-5);
    EXPECT_NEAR(by_power.lights[0].power().x, 60, 1e-4);
    EXPECT_NEAR(by_power.lights[0].power().y, 30, 1e-4);
    EXPECT_EQ(by_power.lights[0].power().z, 0);
    const Scene by_radiance = parse(SceneText{.lights = light + R"("radiance": [1, 2, 3]})"}.text());
    EXPECT_NEAR(by_radiance.lights[0].power().z, std::numbers::pi * 6 * 3, 1e-4);
}

TEST(Loader, ALightWithoutAMaterialIsBlack) {
    const Scene scene = parse(
        SceneText{.lights = light + R"("power": [1, 1, 1]}, )" + light + R"("power": [2, 2, 2]})"}.text());
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.triangle_material[2], scene.triangle_material[5]);
    const Material& material = scene.materials[scene.triangle_material[2]];
    EXPECT_EQ(material.kind, MaterialKind::diffuse);
    EXPECT_EQ(material.diffuse, Vec3{});
}

TEST(Loader, MaterialsKeepWhatTheirKindHasAndNothingElse) {
    SceneText text;
    text.materials += R"(,
        "g": {"kind": "glossy", "diffuse": [0.7, 0.2, 0.1], "specular": [0.3, 0.1, 0.2], "exponent": 7},
        "m": {"kind": "mirror", "specular": [0.9, 0.8, 0.7]},
        "d": {"kind": "dielectric", "index_of_refraction": 1.33})";
    const Scene scene = parse(text.text());
    const auto named = [&](const std::string& name) {
        for (const Material& m : scene.materials)
            if (m.name == name) return m;
        ADD_FAILURE() << name;
        return Material{};
    };
    EXPECT_EQ(named("g").kind, MaterialKind::glossy);
    EXPECT_EQ(named("g").exponent, 7);
    EXPECT_EQ(named("g").specular, (Vec3{0.3f, 0.1f, 0.2f}));
    EXPECT_EQ(named("m").kind, MaterialKind::mirror);
    EXPECT_EQ(named("m").specular, (Vec3{0.9f, 0.8f, 0.7f}));
    EXPECT_EQ(named("m").diffuse, Vec3{});
    EXPECT_EQ(named("d").kind, MaterialKind::dielectric);
    EXPECT_EQ(named("d").index_of_refraction, 1.33f);
    EXPECT_EQ(named("d").diffuse, Vec3{});
}

struct Refused {
    SceneText scene;
    std::string message;  // after "t.json: "
};

void expect_refusals(const std::vector<Refused>& cases) {
    for (const Refused& one : cases) EXPECT_EQ(refusal(one.scene.text()), "t.json: " + one.message);
}

std::string quad(const std::string& corner, const std::string& u, const std::string& v,
                 const std::string& more = "") {
    return R"({"type": "quad", "material": "white", "corner": )" + corner + R"(, "edge_u": )" + u +
           R"(, "edge_v": )" + v + more + "}";
}
std::string box(const std::string& min, const std::string& max, const std::string& more = "") {
    return R"({"type": "box", "material": "white", "min": )" + min + R"(, "max": )" + max + more + "}";
}
std::string sphere(const std::string& radius, const std::string& segments) {
    return R"({"type": "sphere", "material": "white", "center": [0, 0, 0], "radius": )" + radius +
           R"(, "segments": )" + segments + "}";
}
std::string camera(const std::string& position, const std::string& target, const std::string& up,
                   const std::string& fov) {
    return R"({"position": )" + position + R"(, "target": )" + target + R"(, "up": )" + up +
           R"(, "vertical_fov_degrees": )" + fov + "}";
}

TEST(LoaderRefuses, UnknownKeysAndNamesTheNearest) {
    expect_refusals({
        {{.camera = R"({"position": [0, 0, 0], "taget": [0, 0, 1]})"},
         "camera.taget: found unknown key \"taget\", expected \"target\" (keys of a camera: position, "
         "target, up, "
         "vertical_fov_degrees)"},
        {{.shapes =
              R"({"type": "sphere", "material": "white", "center": [0, 0, 0], "radios": 1, "segments": 9})"},
         "shapes[0].radios: found unknown key \"radios\", expected \"radius\" (keys of a sphere shape: type, "
         "material, center, "
         "radius, segments)"},
        {{.materials = R"("white": {"kind": "diffuse", "diffuse": [0, 0, 0], "exponent": 2})"},
         "materials.white.exponent: found unknown key \"exponent\", expected \"kind\" (keys of a diffuse "
         "material: kind, "
         "diffuse)"},
        {{.shapes = R"({"typ": "sphere", "material": "white"})"},
         "shapes[0].typ: found unknown key \"typ\", expected \"type\" (keys of a shape: type, material, "
         "corner, edge_u, "
         "edge_v, divide, corners, min, max, rotate_z_degrees, center, radius, segments, from, to, "
         "radius_to, "
         "smooth, profile, axis, tube, tube_segments, size, amplitude, wavelength, phase_degrees, depth, "
         "cells, "
         "seed, growth, blades, height, width, reach, file, materials, up_axis, scale, translate, object, "
         "at)"},
    });
}

TEST(LoaderRefuses, MissingKeys) {
    expect_refusals({
        {{.camera = R"({"position": [0, 0, 0], "up": [0, 0, 1], "vertical_fov_degrees": 50})"},
         "camera.target: found nothing, expected three coordinates [m], each from -1e12 to 1e12"},
        {{.shapes = R"({"type": "sphere", "material": "white", "center": [0, 0, 0], "segments": 9})"},
         "shapes[0].radius: found nothing, expected a length [m], above 0 and at most 1e6"},
        {{.shapes = R"({"material": "white"})"},
         "shapes[0].type: found nothing, expected \"quad\", \"patch\", \"box\", \"sphere\", \"cylinder\", "
         "\"lathe\", \"torus\", \"ripple\", \"terrain\", \"tuft\", \"mesh\" or \"instances\""},
        {{.materials = R"("white": {"diffuse": [0, 0, 0]})"},
         "materials.white.kind: found nothing, expected \"diffuse\", \"glossy\", \"mirror\" or "
         "\"dielectric\""},
        {{.shapes = ""}, "scene: found neither shapes nor lights, expected at least one of them"},
    });
    EXPECT_EQ(refusal("{}"),
              "t.json: name: found nothing, expected a name of 1 to 64 letters, digits, '_', '-' or '.'");
}

TEST(LoaderRefuses, WrongTypes) {
    expect_refusals({
        {{.name = "3"}, "name: found 3, expected a name of 1 to 64 letters, digits, '_', '-' or '.'"},
        {{.name = R"("a/b\n")"},
         "name: found \"a/b\\n\", expected a name of 1 to 64 letters, digits, '_', '-' or '.'"},
        {{.camera = "[1]"}, "camera: found a list of 1, expected an object"},
        {{.materials = R"("white": 5)"}, "materials.white: found 5, expected an object"},
        {{.shapes = "null"}, "shapes[0]: found null, expected an object"},
        {{.shapes = quad("\"here\"", "[1, 0, 0]", "[0, 1, 0]")},
         "shapes[0].corner: found \"here\", expected three coordinates [m], each from -1e12 to 1e12"},
        {{.shapes = quad("[0, true, 0]", "[1, 0, 0]", "[0, 1, 0]")},
         "shapes[0].corner[1]: found true, expected three coordinates [m], each from -1e12 to 1e12"},
        {{.shapes = R"({"type": 4})"},
         "shapes[0].type: found 4, expected \"quad\", \"patch\", \"box\", \"sphere\", \"cylinder\", "
         "\"lathe\", \"torus\", \"ripple\", \"terrain\", \"tuft\", \"mesh\" or \"instances\""},
        {{.shapes = sphere("\"1\"", "9")},
         "shapes[0].radius: found \"1\", expected a length [m], above 0 and at most 1e6"},
    });
    EXPECT_EQ(refusal("[]"), "t.json: scene: found an empty list, expected an object");
    EXPECT_EQ(
        refusal(R"({"name": "t", "camera": {}, "shapes": {}})"),
        "t.json: camera.position: found nothing, expected three coordinates [m], each from -1e12 to 1e12");
}

TEST(LoaderRefuses, WrongLengths) {
    expect_refusals({
        {{.shapes = quad("[0, 0]", "[1, 0, 0]", "[0, 1, 0]")},
         "shapes[0].corner: found a list of 2, expected three coordinates [m], each from -1e12 to 1e12"},
        {{.shapes = quad("[0, 0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]")},
         "shapes[0].corner: found a list of 4, expected three coordinates [m], each from -1e12 to 1e12"},
        {{.shapes = quad("[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]", R"(, "divide": [1, 2, 3])")},
         "shapes[0].divide: found a list of 3, expected two whole numbers of cells, each from 1 to 10000"},
        {{.shapes = box("[0, 0, 0]", "[1, 1, 1]", R"(, "divide": [1, 2])")},
         "shapes[0].divide: found a list of 2, expected three whole numbers of cells, each from 1 to 10000"},
    });
}

TEST(LoaderRefuses, MaterialsThatMakeOrLoseMoreLightThanTheyGet) {
    const std::string wanted = ", expected three reflectances (red, green, blue), each from 0 to 1";
    expect_refusals({
        {{.materials = R"("white": {"kind": "diffuse", "diffuse": [0, -0.1, 0]})"},
         "materials.white.diffuse[1]: found -0.1" + wanted},
        {{.materials = R"("white": {"kind": "diffuse", "diffuse": [0, 0, 1.5]})"},
         "materials.white.diffuse[2]: found 1.5" + wanted},
        {{.materials = R"("white": {"kind": "mirror", "specular": [2, 0, 0]})"},
         "materials.white.specular[0]: found 2" + wanted},
        {{.materials =
              R"("white": {"kind": "glossy", "diffuse": [0.5, 0.8, 0], "specular": [0.5, 0.5, 0], "exponent": 9})"},
         "materials.white: found diffuse + specular = 1.3 in green, expected at most 1 in each channel"},
        {{.materials =
              R"("white": {"kind": "glossy", "diffuse": [0, 0, 0], "specular": [0, 0, 0], "exponent": 0.5})"},
         "materials.white.exponent: found 0.5, expected a Blinn-Phong exponent, from 1 to 1e6"},
        {{.materials = R"("white": {"kind": "dielectric", "index_of_refraction": 0.9})"},
         "materials.white.index_of_refraction: found 0.9, expected an index of refraction, from 1 to 10"},
        {{.materials = R"("white": {"kind": "mirro"})"},
         "materials.white.kind: found \"mirro\", expected \"mirror\" (materials: diffuse, glossy, mirror, "
         "dielectric)"},
    });
}

TEST(LoaderRefuses, NumbersThatAreNotFinite) {
    EXPECT_THAT(refusal(SceneText{.shapes = sphere("1e999", "9")}.text()), HasSubstr("1e999"));
    EXPECT_THAT(refusal(SceneText{.shapes = sphere("NaN", "9")}.text()), HasSubstr("line 1, column "));
    expect_refusals({{{.shapes = sphere("1e300", "9")},
                      "shapes[0].radius: found 1e+300, expected a length [m], above 0 and at most 1e6"}});
}

TEST(LoaderRefuses, ShapesWithoutAreaOrVolume) {
    const std::string edge = ", expected a vector of three lengths [m], not all zero, each from -1e6 to 1e6";
    expect_refusals({
        {{.shapes = quad("[0, 0, 0]", "[0, 0, 0]", "[0, 1, 0]")},
         "shapes[0].edge_u: found a vector of length 0" + edge},
        {{.shapes = quad("[0, 0, 0]", "[1, 2, 3]", "[-2, -4, -6]")},
         "shapes[0].edge_v: found a vector parallel to edge_u: no area, expected one at an angle to edge_u"},
        {{.shapes = box("[0, 0, 0]", "[1, 0, 1]")},
         "shapes[0].max: found y = 0, not above min's 0, expected a box with min < max on each axis"},
        {{.shapes = box("[0, 0, 2]", "[1, 1, 1]")},
         "shapes[0].max: found z = 1, not above min's 2, expected a box with min < max on each axis"},
        {{.shapes = sphere("0", "9")},
         "shapes[0].radius: found 0, expected a length [m], above 0 and at most 1e6"},
        {{.shapes = sphere("-1", "9")},
         "shapes[0].radius: found -1, expected a length [m], above 0 and at most 1e6"},
        {{.shapes =
              quad("[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]") +
              R"(, {"type": "sphere", "material": "white", "center": [9e5, 9e5, 9e5], "radius": 0.001, "segments": 3})"},
         "shapes[1]: found 6 of 6 triangles without area in 32-bit floats, expected a larger or less divided "
         "shape, or one nearer to the others"},
    });
}

TEST(LoaderRefuses, AbsurdSizesBeforeMakingThem) {
    expect_refusals({
        {{.shapes = sphere("1", "100000")},
         "shapes[0].segments: found 100000, expected a whole number of segments, from 3 to 4096"},
        {{.shapes = sphere("1", "2")},
         "shapes[0].segments: found 2, expected a whole number of segments, from 3 to 4096"},
        {{.shapes = sphere("1", "8.5")},
         "shapes[0].segments: found 8.5, expected a whole number of segments, from 3 to 4096"},
        {{.shapes = quad("[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]", R"(, "divide": [1e6, 1e6])")},
         "shapes[0].divide[0]: found 1e+06, expected two whole numbers of cells, each from 1 to 10000"},
        {{.shapes = quad("[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]", R"(, "divide": [0, 4])")},
         "shapes[0].divide[0]: found 0, expected two whole numbers of cells, each from 1 to 10000"},
        {{.shapes = quad("[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]") + "," +
                    quad("[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]", R"(, "divide": [10000, 10000])")},
         "shapes[1]: found 200000000 triangles after 2 of the shapes before, expected at most 50000000 in a "
         "scene"},
    });
}

TEST(LoaderRefuses, UnknownMaterials) {
    SceneText text;
    text.materials += R"(, "walnut": {"kind": "diffuse", "diffuse": [0, 0, 0]})";
    text.shapes =
        R"({"type": "sphere", "material": "wallnut", "center": [0, 0, 0], "radius": 1, "segments": 9})";
    expect_refusals({{text, "shapes[0].material: found unknown material \"wallnut\", expected \"walnut\""},
                     {{.materials = ""},
                      "shapes[0].material: found \"white\", expected a material, and the scene has none"},
                     {{.lights = light + R"("power": [1, 1, 1], "material": "wite"})"},
                      "lights[0].material: found unknown material \"wite\", expected \"white\""}});
}

TEST(LoaderRefuses, CamerasThatSeeNothing) {
    const std::string fov = ", expected an angle in degrees, above 0 and below 180";
    expect_refusals({
        {{.camera = camera("[1, 2, 3]", "[1, 2, 3]", "[0, 0, 1]", "50")},
         "camera.target: found the camera's position, expected a target apart from the position"},
        {{.camera = camera("[0, 0, 0]", "[0, 0, -4]", "[0, 0, 1]", "50")},
         "camera.up: found a direction parallel to the view, expected one at an angle to target - position"},
        {{.camera = camera("[0, 0, 0]", "[0, 0, -4]", "[0, 0, 0]", "50")},
         "camera.up: found a vector of length 0, expected a direction of three numbers, not all zero, each "
         "from -1e6 to 1e6"},
        {{.camera = camera("[0, 0, 0]", "[0, 4, 0]", "[0, 0, 1]", "0")},
         "camera.vertical_fov_degrees: found 0" + fov},
        {{.camera = camera("[0, 0, 0]", "[0, 4, 0]", "[0, 0, 1]", "180")},
         "camera.vertical_fov_degrees: found 180" + fov},
    });
    EXPECT_EQ(refusal(SceneText{.camera = camera("[0, 0, 0]", "[0, 4, 0]", "[0, 0, 1]", "179.9")}.text()),
              "");
}

TEST(LoaderRefuses, LightsThatDoNotShine) {
    expect_refusals({
        {{.lights = light + R"("power": [1, 1, 1], "radiance": [1, 1, 1]})"},
         "lights[0]: found both radiance and power, expected exactly one of them"},
        {{.lights = R"({"corner": [0, 0, 3], "edge_u": [0, 2, 0], "edge_v": [3, 0, 0]})"},
         "lights[0]: found neither radiance nor power, expected exactly one of them"},
        {{.lights = light + R"("power": [0, 0, 0]})"},
         "lights[0].power: found a light that emits nothing, expected three powers [W], each from 0 to 1e12, "
         "not all zero"},
        {{.lights = light + R"("radiance": [0, -1, 0]})"},
         "lights[0].radiance[1]: found -1, expected three radiances [W/(m^2 sr)], each from 0 to 1e12, not "
         "all zero"},
        {{.lights = R"({"corner": [0, 0, 3], "edge_u": [0, 2, 0], "edge_v": [0, 3, 0], "power": [1, 1, 1]})"},
         "lights[0].edge_v: found a vector parallel to edge_u: no area, expected one at an angle to edge_u"},
    });
}

TEST(LoaderRefuses, SyntaxErrorsWithLineAndColumn) {
    EXPECT_THAT(refusal("{\n  \"name\": \"t\",\n  \"camera\" 5\n}"), HasSubstr("t.json: line 3, column 12"));
    EXPECT_THAT(refusal(""), HasSubstr("t.json: line 1, column 1"));
    EXPECT_THAT(refusal("{} {}"), HasSubstr("t.json: line 1, column 4"));
    EXPECT_THAT(refusal("{\"name\": \"\xff\"}"), HasSubstr("t.json: line 1, column 11"));
    EXPECT_THAT(refusal(std::string(100'000, '[')), HasSubstr("found objects or lists 65 deep"));
}

TEST(LoaderRefuses, KeysThatStandTwice) {
    EXPECT_EQ(refusal(R"({"name": "t", "shapes": [{}, {"radius": 1, "x": {"radius": 1}, "radius": 2}]})"),
              "t.json: line 1, column 64: found the key \"radius\" a second time, expected each key once in "
              "an object");
}

TEST(LoaderRefuses, WithTheLineOfTheValue) {
    try {
        parse("{\n\"name\": \"t\",\n\"camera\": {\n\"position\": 7}}");
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_THAT(error.what(),
                    testing::StartsWith("t.json: line 3, camera.target: found nothing, expected three"));
    }
}

TEST(LoaderRefuses, AnyCutOfAValidFileInOneLine) {
    SceneText whole;
    whole.lights = light + R"("power": [1, 1, 1]})";
    const std::string text = whole.text();
    ASSERT_EQ(refusal(text), "");
    for (std::size_t length = 0; length < text.size(); ++length) {
        const std::string message = refusal(text.substr(0, length));
        EXPECT_THAT(message, HasSubstr("t.json: line 1, column ")) << length;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

TEST(LoaderRefuses, NamesAndPathsThatLeadNowhere) {
    const auto refused_by = [](const std::string& name) -> std::string {
        try {
            load_scene(name);
        } catch (const trace::UsageError& error) {
            return std::string("usage: ") + error.what();
        } catch (const trace::DataError& error) {
            return std::string("data: ") + error.what();
        }
        return "";
    };
    EXPECT_EQ(refused_by("rom"),
              "usage: scene: found \"rom\", expected \"room\" or a JSON file (embedded scenes: room, box, "
              "furnace, house, arena, cornell, caustics, prism, meadow, keyhole)");
    EXPECT_EQ(refused_by("no/such.json"),
              "data: no/such.json: found no file, expected a JSON scene or one of the embedded scenes room, "
              "box, furnace, house, arena, cornell, caustics, prism, meadow, keyhole");
    const ScratchFolder folder;
    EXPECT_EQ(refused_by(folder.path().string()),
              "data: " + folder.path().string() + ": found a folder, expected a file");
    EXPECT_THAT(refused_by(folder.write("empty.json", "").string()), HasSubstr("line 1, column 1"));
}

TEST(Loader, ASceneFileIsReadFromDiskWithMeshesBesideIt) {
    const ScratchFolder folder;
    folder.write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto file = folder.write(
        "s.json", SceneText{.shapes = R"({"type": "mesh", "material": "white", "file": "tri.obj"})"}.text());
    EXPECT_EQ(load_scene(file.string()).triangles.size(), 1u);
}

}  // namespace
}  // namespace regather::scenes
