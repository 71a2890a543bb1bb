// Where pieces, lamps, openings and cameras of a home end up, at asymmetric values. The numbers are worked
// out by hand, or by Sweet Home 3D's rules (ModelManager.getPieceOfFurnitureNormalizedModelTransformation)
// written down as three rotations.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/imports/home_text.h"

namespace regather::imports {
namespace {

using ::testing::HasSubstr;

constexpr double quarter_turn = 1.5707963267948966;

// A prism over the triangle (-1, -2), (1, -2), (-1, 2) of x and z: the middle of its box is on its slanted
// side.
constexpr const char* prism = R"(usemtl face
v -1 0 -2
v 1 0 -2
v -1 0 2
v -1 1 -2
v 1 1 -2
v -1 1 2
f 1 2 3
f 4 6 5
f 1 4 5 2
f 2 5 6 3
f 3 6 4 1
)";

class HomePlacing : public Sweethome {
protected:
    ImportedScene with_piece(const std::string& attributes, const std::string& model = wedge,
                             const std::string& tag = "pieceOfFurniture", const std::string& children = "") {
        HomeText text;
        text.piece = fmt::format("<{} name='p' model='m/wedge.obj' x='100' y='200' elevation='50' {}>{}</{}>",
                                 tag, attributes, children, tag);
        return import(text.text(), model);
    }
    Vec3 lamp(const std::string& attributes) {
        const ImportedScene scene =
            with_piece("width='40' depth='20' height='10' power='0.5' " + attributes, wedge, "light",
                       "<lightSource x='0.75' y='0.1' z='0.9' color='FFFFFFFF' diameter='0.1'/>");
        EXPECT_EQ(scene.lights.size(), 1u);
        return scene.lights.at(0).center;
    }
    // The corners of the face "face" in one material, seen from above.
    static bool has_corner(const ImportedScene& scene, float x, float y) {
        for (const ImportedMesh& mesh : scene.meshes)
            if (scene.materials[mesh.material].name == "face")
                for (const Vec3 p : mesh.surface.vertices)
                    if (std::abs(p.x - x) < 1e-5f && std::abs(p.y - y) < 1e-5f) return true;
        return false;
    }
};

TEST_F(HomePlacing, ALampIsMeasuredFromTheLeftTheFrontAndTheFootOfItsPiece) {
    // 0.25 of 40 cm right of the middle, 0.4 of 20 cm in front of it (down the plan), 0.9 of 10 cm up.
    expect_near(lamp(""), {1.1f, -2.08f, 0.59f});
    // A quarter turn, clockwise on the plan: the front looks to the left, the right side down.
    expect_near(lamp(fmt::format("angle='{}'", quarter_turn)), {0.92f, -2.1f, 0.59f});
    expect_near(lamp("modelMirrored='true'"), {0.9f, -2.08f, 0.59f});
    expect_near(lamp("modelMirrored='true' angle='0.5'"), {0.87388770f, -2.02226405f, 0.59f});
}

TEST_F(HomePlacing, ALampLeansWithItsPiece) {
    expect_near(lamp("pitch='0.3' roll='-0.5' angle='0.7'"), {1.00281950f, -2.08684469f, 0.76596427f});
}

TEST_F(HomePlacing, APieceIsPitchedFirstAndRolledThen) {
    // Pitched by a quarter turn the front looks up and the top backward; rolled by another one, what looked
    // up looks right, and what was right looks down: the front is the right side, 20 cm deep from left to
    // right, 40 cm high, 10 cm from front to back.
    const ImportedScene scene =
        with_piece(fmt::format("width='40' depth='20' height='10' pitch='{0}' roll='{0}'", quarter_turn));
    const trace::Bounds3 front = bounds_of(scene, "face");
    expect_near(front.min, {1.1f, -2.05f, 0.5f});
    expect_near(front.max, {1.1f, -1.95f, 0.9f});
    const trace::Bounds3 body = bounds_of(scene, "amber");
    expect_near(body.min, {0.9f, -2.05f, 0.5f});
    expect_near(body.max, {1.1f, -1.95f, 0.9f});
}

TEST_F(HomePlacing, PitchRollAndAngleTogether) {
    const ImportedScene scene =
        with_piece("width='40' depth='20' height='10' pitch='0.3' roll='-0.5' angle='0.7'");
    const trace::Bounds3 front = bounds_of(scene, "face");
    expect_near(front.min, {0.78538042f, -2.20306605f, 0.55186868f});
    expect_near(front.max, {1.06985809f, -1.92481574f, 0.82747756f});
    EXPECT_NEAR(bounds_of(scene, "amber").min.z, 0.5, 1e-5);  // it stands on its lowest corner
}

TEST_F(HomePlacing, APieceTurnsAboutTheMiddleOfItsOwnBox) {
    const ImportedScene scene = with_piece("width='40' depth='20' height='10' angle='0.5'", prism);
    EXPECT_TRUE(has_corner(scene, 0.87242604f, -1.81635664f));  // back left
    EXPECT_TRUE(has_corner(scene, 1.22345907f, -2.00812685f));  // back right
    EXPECT_TRUE(has_corner(scene, 0.77654093f, -1.99187315f));  // front left
}

TEST_F(HomePlacing, AModelRotationKeepsTheMiddleWhereTheHomeSaysSo) {
    // (x, z) -> (0.6 x + 0.8 z, -0.8 x + 0.6 z) takes the triangle to (-2.2, -0.4), (-1, -2), (1, 2): 3.2 x
    // 4, its middle at (-0.6, 0) of the unturned one's. 10 cm a unit.
    const std::string turned =
        "width='32' depth='40' height='10' modelRotation='0.6 0 0.8 0 1 0 -0.8 0 0.6' ";
    const ImportedScene centred = with_piece(turned, prism);
    EXPECT_NEAR(bounds_of(centred, "face").min.x, 0.84, 1e-5);
    EXPECT_NEAR(bounds_of(centred, "face").max.x, 1.16, 1e-5);
    const ImportedScene left = with_piece(turned + "modelCenteredAtOrigin='false'", prism);
    EXPECT_NEAR(bounds_of(left, "face").min.x, 0.78, 1e-5);
    EXPECT_NEAR(bounds_of(left, "face").max.x, 1.1, 1e-5);
    EXPECT_NEAR(bounds_of(left, "face").min.z, 0.5, 1e-5);
}

TEST_F(HomePlacing, AGroupsOwnAngleAndMirroringAreInItsPiecesAlready) {
    const HomeText plain;
    HomeText grouped;
    grouped.piece =
        "<furnitureGroup name='g' x='10' y='20' angle='1' elevation='30' modelMirrored='true' width='1' "
        "depth='2' height='3'>" +
        plain.piece + "</furnitureGroup>";
    for (const char* material : {"face", "amber"}) {
        const trace::Bounds3 alone = bounds_of(import(plain.text()), material),
                             in_group = bounds_of(import(grouped.text()), material);
        EXPECT_EQ(alone.min, in_group.min);
        EXPECT_EQ(alone.max, in_group.max);
    }
}

TEST_F(HomePlacing, ACameraPitchesDownward) {
    const auto with_observer = [&](double pitch) {
        std::string text = HomeText{}.text();
        const std::string level = "yaw='3.14159265' pitch='0'";
        text.replace(text.find(level), level.size(), fmt::format("yaw='0.3' pitch='{}'", pitch));
        return import(text);
    };
    const ImportedScene down = with_observer(0.5), up = with_observer(-0.5);
    expect_near(down.camera.target - down.camera.position, {-0.25934338f, -0.83838664f, -0.47942554f});
    expect_near(up.camera.target - up.camera.position, {-0.25934338f, -0.83838664f, 0.47942554f});
    EXPECT_EQ(down.camera.up, (Vec3{0, 0, 1}));
    // Straight down: what is ahead on the plan is up in the picture.
    const ImportedScene plan = with_observer(quarter_turn);
    expect_near(plan.camera.target - plan.camera.position, {0, 0, -1});
    expect_near(plan.camera.up, {-0.29552021f, -0.95533649f, 0});
    expect_near(plan.camera_path[0].up, {-std::sin(0.3f - 0.35f), -std::cos(0.3f - 0.35f), 0});
}

class HomeOpenings : public Sweethome {
protected:
    // Whether the left face (y = 0.05 m) of the wall from (0, 0) to (400, 0) is there at x and z [m].
    static bool covered(const ImportedScene& scene, double x, double z) {
        for (const ImportedMesh& mesh : scene.meshes) {
            if (scene.materials[mesh.material].name != "wall") continue;
            for (const auto& triangle : mesh.surface.triangles) {
                std::array<Vec3, 3> p{};
                bool on_face = true;
                for (std::size_t i = 0; i < 3; ++i) {
                    p[i] = mesh.surface.vertices[triangle[i]];
                    on_face = on_face && std::abs(p[i].y - 0.05f) < 1e-6f;
                }
                if (!on_face) continue;
                bool inside = true;
                for (std::size_t i = 0; i < 3; ++i) {
                    const Vec3 a = p[i], b = p[(i + 1) % 3];
                    inside = inside && (b.x - a.x) * (z - a.z) - (b.z - a.z) * (x - a.x) <= 0;
                }
                if (inside) return true;
            }
        }
        return false;
    }
    ImportedScene with(const std::string& attributes, const std::string& tag = "doorOrWindow") {
        HomeText text;
        text.piece = fmt::format("<{} name='d' model='m/wedge.obj' {}/>", tag, attributes);
        return import(text.text());
    }
    // The hole is [x0, x1] x [z0, z1] and nothing more.
    static void expect_hole(const ImportedScene& scene, double x0, double x1, double z0, double z1) {
        const double e = 0.004, x = (x0 + x1) / 2, z = (z0 + z1) / 2;
        for (const auto& [at_x, at_z] : {std::pair{x0 + e, z}, {x1 - e, z}, {x, z0 + e}, {x, z1 - e}})
            EXPECT_FALSE(covered(scene, at_x, at_z)) << at_x << " " << at_z;
        for (const auto& [at_x, at_z] : {std::pair{x0 - e, z}, {x1 + e, z}, {x, z0 - e}, {x, z1 + e}})
            EXPECT_TRUE(covered(scene, at_x, at_z)) << at_x << " " << at_z;
    }
};

TEST_F(HomeOpenings, APartOfTheFrontIsCut) {
    const std::string window = "x='200' y='0' elevation='100' width='80' depth='30' height='100' ";
    const std::string part =
        "wallThickness='0.3333' wallDistance='0.3333' wallWidth='0.5' wallLeft='0.1' wallHeight='0.4' "
        "wallTop='0.2' ";
    expect_hole(with(window), 1.6, 2.4, 1, 2);
    // From 8 cm right of the left edge on, 40 cm; from 20 cm below the top down, 40 cm.
    expect_hole(with(window + part), 1.68, 2.08, 1.4, 1.8);
    expect_hole(with(window + part + "modelMirrored='true'"), 1.92, 2.32, 1.4, 1.8);
    expect_hole(with(window + part + "angle='3.14159265358979'"), 1.92, 2.32, 1.4, 1.8);
}

TEST_F(HomeOpenings, AnyPieceMayBeADoorOrAWindow) {
    const std::string place = "x='200' y='0' elevation='20' width='60' depth='30' height='110' ";
    EXPECT_TRUE(covered(with(place, "pieceOfFurniture"), 2, 0.5));
    EXPECT_TRUE(covered(with(place + "doorOrWindow='false'", "pieceOfFurniture"), 2, 0.5));
    expect_hole(with(place + "doorOrWindow='true'", "pieceOfFurniture"), 1.7, 2.3, 0.2, 1.3);
    EXPECT_TRUE(covered(with(place + "visible='false'"), 2, 0.5));
}

TEST_F(HomeOpenings, OneThatCutsBothSidesNeedsOnlyTouchTheWall) {
    // From y = 4 to y = 34: 1 of the wall's 10 cm.
    const std::string window = "x='200' y='19' elevation='100' width='80' depth='30' height='100' ";
    EXPECT_TRUE(covered(with(window), 2, 1.5));
    expect_hole(with(window + "wallCutOutOnBothSides='true'"), 1.6, 2.4, 1, 2);
    // Not parallel to it (its left corner is 1.9 cm in the wall), or 1 cm away.
    EXPECT_TRUE(covered(with("x='200' y='22' angle='0.1' elevation='100' width='80' depth='30' height='100' "
                             "wallCutOutOnBothSides='true'"),
                        1.7, 1.5));
    EXPECT_TRUE(covered(
        with(
            "x='200' y='21' elevation='100' width='80' depth='30' height='100' wallCutOutOnBothSides='true'"),
        2, 1.5));
}

class HomeLeftOut : public Sweethome {
protected:
    std::string notes(const std::string& xml) {
        std::string all;
        for (const std::string& line : import(xml).notes) all += line + "\n";
        return all;
    }
};

TEST_F(HomeLeftOut, WhatIsNotUsedIsSaidInOneLineAKind) {
    HomeText text;
    text.walls =
        "<wall id='w' xStart='0' yStart='0' xEnd='400' yEnd='0' thickness='10' pattern='x' "
        "glow='2'><baseboard attribute='leftSideBaseboard'/>"
        "<baseboard attribute='rightSideBaseboard'/><texture attribute='leftSideTexture' name='t'/></wall>";
    text.piece =
        "<doorOrWindow name='d' id='1' icon='2' model='m/wedge.obj' x='1' y='900' width='4' depth='2' "
        "height='1' cutOutShape='M0,1 v-0.8 a0.5,0.2 0 1,1 1,0 v0.8 z'><sash xAxis='1'/></doorOrWindow>"
        "<light name='l' model='m/wedge.obj' x='1' y='900' width='4' depth='2' height='1' power='0' "
        "modelFlags='2'><lightSourceMaterial name='m'/></light>"
        "<furnitureGroup name='g'><tesseract/><pieceOfFurniture name='p' staircaseCutOutShape='M0' "
        "model='m/wedge.obj' x='1' y='900' width='4' depth='2' height='1'/></furnitureGroup>";
    text.rest =
        "<dimensionLine xStart='0'/><dimensionLine xStart='1'/><label "
        "x='1'><text>t</text></label><polyline><point x='1' y='2'/></polyline><environment "
        "skyColor='FF000000' photoWidth='3'/>"
        "<camera attribute='topCamera' lens='SPHERICAL' x='1' y='2' z='3' yaw='0' pitch='1' "
        "fieldOfView='1'/><property name='plugin' value='v'/>";
    EXPECT_EQ(notes(text.text()),
              "left out as not seen: <property> (once), <sash> (once), icon (once), id (once), name (once), "
              "pattern (once), photoWidth (once)\n"
              "left out of camera: lens (taken as PINHOLE) (once)\n"
              "left out of doorOrWindow: cutOutShape (its rectangle is cut) (once)\n"
              "left out of environment: skyColor (once)\n"
              "left out of furnitureGroup: <tesseract> (once)\n"
              "left out of home: <camera attribute='topCamera'> (once), <dimensionLine> (2 times), <label> "
              "(once), <polyline> (once)\n"
              "left out of light: <lightSourceMaterial> (once), modelFlags (once)\n"
              "left out of pieceOfFurniture: staircaseCutOutShape (once)\n"
              "left out of wall: <baseboard> (2 times), <texture> (once), glow (once)\n");
}

TEST_F(HomeLeftOut, AHomeOfWhichAllIsUsedLeavesNothingToSay) {
    std::string text = HomeText{}.text();
    EXPECT_EQ(notes(text), "");
}

TEST_F(HomeLeftOut, LevelsThatTheViewHidesAndRoomsThatCrossThemselvesAreTold) {
    HomeText text;
    text.rest =
        "<level id='a' elevation='0' height='250' floorThickness='12' visible='false'/>"
        "<room><point x='0' y='0'/><point x='100' y='100'/><point x='100' y='0'/><point x='0' "
        "y='90'/></room>";
    const std::string all = notes(text.text());
    EXPECT_THAT(
        all,
        HasSubstr("left out of level: floorThickness (once), visible='false' (taken all the same) (once)\n"));
    EXPECT_THAT(all, HasSubstr("left out of room: parts of one that crosses itself (once)\n"));
}

TEST_F(HomeLeftOut, TextBetweenElementsIsTold) {
    HomeText text;
    text.walls =
        "stray<wall id='w' xStart='0' yStart='0' xEnd='400' yEnd='0' thickness='10'>1<!-- 2 --></wall>"
        "<![CDATA[more]]> \n <label x='1'><text>t</text>u</label>";
    EXPECT_EQ(notes(text.text()),
              "left out of home: <label> (once), text between elements (2 times)\n"
              "left out of wall: text between elements (once)\n");
}

TEST_F(HomeLeftOut, NamesOfTheFileAreCutAndEscaped) {
    HomeText text;
    text.rest = "<evil\xc2\x9b" + std::string(1000, 'x') + "/>";
    EXPECT_THAT(notes(text.text()), HasSubstr("left out of home: <evil\\u{9b}xxxx"));
    EXPECT_THAT(notes(text.text()), HasSubstr("xxx... (once)\n"));
    EXPECT_LT(notes(text.text()).size(), 100u);
}

class HomeRefusals : public Sweethome {};

TEST_F(HomeRefusals, WhatStandsBesideTheHomeIsRefused) {
    const std::string home = HomeText{}.text(), at = "t.sh3d: Home.xml: line ",
                      expected = ", expected a <home> in XML, and nothing beside it";
    const auto refused = [&](const std::string& xml) {
        try {
            import(xml);
        } catch (const trace::DataError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(refused(home + "\n\nstray"), HasSubstr(at + "3: found text outside any element" + expected));
    EXPECT_THAT(refused(home + "\n<home name='i'/>"),
                HasSubstr(at + "2: found the element \"home\" beside another one" + expected));
    EXPECT_THAT(refused("<!-- none -->"), HasSubstr(at + "1: found no element, expected a <home> in XML"));
    EXPECT_EQ(refused("<!-- one -->" + home.substr(home.find("<home")) + "\n<!-- two -->\n"), "");
}

TEST_F(HomeRefusals, TheLineIsNamed) {
    HomeText text;
    text.walls =
        "\n<wall id='a' xStart='0' yStart='0'\n xEnd='1' yEnd='1' thickness='1'/>\n<wall id='b' xStart='0' "
        "yStart='zero' xEnd='1' yEnd='1' thickness='1'/>";
    EXPECT_THAT(refusal(text), HasSubstr("t.sh3d: Home.xml: line 4: wall[1].yStart: found \"zero\", expected "
                                         "a number from -1000000 to 1000000"));
    text.walls = "\n\n<wall id=a/>";
    EXPECT_THAT(refusal(text),
                HasSubstr("t.sh3d: Home.xml: line 3: found an attribute that is not name=\"value\""));
}

TEST_F(HomeRefusals, ContradictionsAndOtherWordsAreRefused) {
    const auto with = [&](const std::string& rest) {
        HomeText text;
        text.rest = rest;
        return refusal(text);
    };
    const std::string wall = "<wall id='a' xStart='0' yStart='0' xEnd='1' yEnd='1' thickness='1' ";
    EXPECT_THAT(with(wall + "level='attic'/>"),
                HasSubstr("wall[1].level: found \"attic\", expected the id of a level"));
    EXPECT_THAT(with(wall + "thickness='2'/>"), HasSubstr("found the attribute \"thickness\" twice"));
    EXPECT_THAT(with(wall + "arcExtent='1e38'/>"), HasSubstr("wall[1].arcExtent: found \"1e38\""));
    EXPECT_THAT(with("<level id='a' elevation='0' height='1'/><level id='a' elevation='0' height='1'/>"),
                HasSubstr("level[1].id: found \"a\""));
    EXPECT_THAT(with("<level id='a' elevation='0' height='1' viewable='TRUE'/>"),
                HasSubstr("viewable: found \"TRUE\", expected true or false"));
    EXPECT_THAT(data_error([&] { import("<?xml version='1.0' encoding='ISO-8859-1'?><home/>"); }),
                HasSubstr("line 1: found the encoding \"ISO-8859-1\", expected UTF-8"));
    EXPECT_THAT(data_error([&] { import("<house/>"); }),
                HasSubstr("found the element \"house\", expected <home>"));
}

TEST_F(HomeRefusals, WhatWouldTakeTooLongIsRefused) {
    HomeText text;
    text.piece.clear();
    for (int i = 0; i < 101; ++i)
        text.piece += fmt::format(
            "<doorOrWindow name='d' model='m/wedge.obj' x='{}' y='0' width='1' depth='30' height='{}'/>",
            10 + 3 * i, 1 + i);
    EXPECT_THAT(refusal(text),
                HasSubstr("wall[0]: found 101 doors and windows, expected at most 100 in one wall"));
    HomeText points;
    points.rest = "<room>";
    for (int i = 0; i < 4001; ++i) points.rest += fmt::format("<point x='{}' y='{}'/>", i, i % 7);
    points.rest += "</room>";
    EXPECT_THAT(refusal(points), HasSubstr("room[0]: found more than 4000 points, expected fewer"));
    std::string many = "<home>";
    for (int i = 0; i < 4'000'000; ++i) many += "<a/>";
    EXPECT_THAT(data_error([&] { import(many + "</home>"); }),
                HasSubstr("found 4000002 elements and attributes, expected at most 4000000"));
}

}  // namespace
}  // namespace regather::imports
