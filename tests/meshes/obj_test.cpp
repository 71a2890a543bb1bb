#include "meshes/obj.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/meshes/parsed.h"

namespace regather::meshes {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string vertex_lines(const std::string& more = "") {
    std::string lines;
    for (const auto& [x, y, z] : box_corners) lines += fmt::format("v {} {} {}{}\n", x, y, z, more);
    return lines;
}

// `format`: of a corner, "{0}" is its number from 1, "{1}" counted back from the last vertex.
std::string face_lines(const std::string& format = "{0}") {
    std::string lines;
    for (const auto& face : box_faces) {
        lines += "f";
        for (const int i : face) lines += " " + fmt::format(fmt::runtime(format), i + 1, i - 8);
        lines += "\n";
    }
    return lines;
}

std::string box(const std::string& corner = "{0}") {
    return vertex_lines() + face_lines(corner);
}

Mesh obj(const std::string& text, const Files& files = {}) {
    return parsed(Format::obj, text, files);
}

TEST(Obj, ABoxIsReadHoweverItsCornersAreNamed) {
    expect_box(obj(box()), "v");
    expect_box(obj(box("{1}")), "relative");
    expect_box(obj("vt 0 0\nvt 1 0 0\n" + box("{0}/2")), "v/t");
    expect_box(obj("vt 0 0\n" + box("{1}/-1")), "relative v/t");
    expect_box(obj("vn 0 0 1\nvn 0 1 0\n" + box("{0}//2")), "v//n");
    expect_box(obj("vt 0 0\nvn 0 0 1\n" + box("{0}/1/1")), "v/t/n");
    expect_box(obj("vt 0 0\nvn 0 0 1\n" + box("{0}/1/-1")), "mixed signs");
    expect_box(obj(face_lines() + vertex_lines()), "faces first");
    expect_box(obj(box("{0}/")), "an empty texture coordinate");
}

TEST(Obj, LinesMayBeIndentedContinuedAndEndAnyhow) {
    expect_box(obj("\t  " + replaced(box(), "\n", "\n \t ")), "indented");
    expect_box(obj(replaced(box(), "\n", "\r\n")), "CR LF");
    expect_box(obj(replaced(box(), "\n", "\r")), "CR");
    expect_box(obj(replaced(box(), " ", "\t")), "tabs");
    expect_box(obj(replaced(box(), "\n", "  \n\n")), "blank lines");
    expect_box(obj("\xEF\xBB\xBF" + box()), "byte order mark");
    expect_box(obj(replaced(box(), "f ", "f \\\n  ")), "continued behind the keyword");
    expect_box(obj(replaced(box(), " 4", " \\\r\n4")), "continued within");
    expect_box(obj(replaced(box(), "\n", " # a comment \\\n")),
               "a backslash that ends a comment continues nothing");
    expect_box(obj("# a folder: C:\\models\\\n" + box()), "nor one in a line of comment");
    expect_box(obj(replaced(replaced(box(), "v ", "V "), "f ", "F ")), "upper case");
    expect_box(obj(box().substr(0, box().size() - 1)), "no last line end");
}

TEST(Obj, NumbersHaveTheFormsOfC) {
    expect_box(obj(
        replaced(replaced(replaced(box(), "v 2 3", "v +2.0 .3e1"), " 4\n", " 4.\n"), "v 0 0", "v -0 0e5")));
    EXPECT_EQ(obj("v 1e-400 0 0\nv 1E0 0 0\nv 0 +1 0\nf 1 2 3\n").surface.vertices[0], (Vec3{0, 0, 0}));
}

TEST(Obj, ColoursAndWeightsOfVerticesAreNamed) {
    const Mesh rgb = obj(vertex_lines(" 0.5 0.25 1") + face_lines());
    expect_box(rgb, "6 numbers");
    EXPECT_EQ(notes(rgb), "colours of vertices are not read: 8\n");
    const Mesh rgba = obj(vertex_lines(" 0.5 0.25 1 1") + face_lines());
    expect_box(rgba, "7 numbers");
    EXPECT_EQ(notes(rgba), "colours of vertices are not read: 8\n");
    EXPECT_EQ(notes(obj(vertex_lines(" 1") + face_lines())), "");
    const Mesh weighted = obj(vertex_lines(" 0.5") + face_lines());
    expect_box(weighted, "4 numbers");
    EXPECT_EQ(notes(weighted), "weights of vertices (a fourth number other than 1) are not used: 8\n");
    EXPECT_EQ(refused(Format::obj, vertex_lines(" 1 2")),
              "t: line 1: found a vertex of 5 numbers, expected 3, 4, 6 or 7");
    EXPECT_THAT(refused(Format::obj, vertex_lines(" 1 2 3 4 5")),
                HasSubstr("found a vertex of more than 7 numbers"));
}

TEST(Obj, AVertexAndANormalMakeAVertex) {
    // Two triangles over one edge: with one normal they share its two vertices, with two normals they do not.
    const std::string four = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvn 0 0 3\nvn 0 -1 1\n";
    const Mesh joined = obj(four + "f 1//1 2//1 3//1\nf 3//1 2//1 4//1\n");
    EXPECT_EQ(joined.surface.vertices.size(), 4u);
    EXPECT_EQ(joined.surface.normals[0], (Vec3{0, 0, 1}));
    const Mesh split = obj(four + "f 1//1 2//1 3//1\nf 3//2 2//2 4//2\n");
    EXPECT_EQ(split.surface.vertices.size(), 6u);
    EXPECT_EQ(split.surface.triangles[1], (Triangle{3, 4, 5}));
    EXPECT_EQ(split.surface.vertices[3], (Vec3{0, 1, 0}));
    EXPECT_FLOAT_EQ(split.surface.normals[3].z, std::sqrt(0.5f));
    const Mesh partly = obj(four + "f 1//1 2//1 3//1\nf 3 2 4\n");
    EXPECT_EQ(partly.surface.normals[partly.surface.triangles[1][0]], Vec3{});
}

TEST(Obj, VerticesThatNoFaceNamesAreLeftOut) {
    const Mesh mesh = obj("v 100 100 100\n" + box("{1}") + "v -50 0 0\n");
    expect_box(mesh);
    EXPECT_EQ(mesh.surface.vertices.size(), 8u);
}

TEST(Obj, PolygonsAreFilled) {
    // An L of area 3 with a corner on an edge: 7 corners, 5 triangles; a dart in it would go wrong as a fan.
    const Mesh mesh = obj("v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\nv 0 1 1\nf 1 2 3 4 5 6 7\n");
    EXPECT_EQ(mesh.surface.triangles.size(), 5u);
    EXPECT_DOUBLE_EQ(area(mesh), 3);
    EXPECT_EQ(notes(mesh), "");
    EXPECT_EQ(notes(obj("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nf 1 2 3 4\n")),
              "faces that cross themselves are filled as far as they can be: 1\n");
}

TEST(Obj, WhatIsNotATriangleIsNamed) {
    const Mesh mesh = obj(
        box() +
        "p 1 2\nl 1 2 3\nl 4 5\ncstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nend\nlod 2\nshadow_obj s.obj\nlod 3\n"
        "f 1 2\nf\nf 1 1 2\nf 3\n");
    expect_box(mesh);
    EXPECT_EQ(mesh.degenerate_faces, 4u);
    EXPECT_EQ(notes(mesh),
              "points (p) are not read: 1\nlines (l) are not read: 2\n"
              "lines of free-form curves and surfaces (curv, surf and the like) are not read: 4\n"
              "lines that open with \"lod\" are not read: 2\n"
              "lines that open with \"shadow_obj\" are not read: 1\n"
              "faces of fewer than three corners are left out: 3\n"
              "triangles without area are left out: 1\n");
}

TEST(Obj, SmoothingGroupsAreNamedWhereTheyWouldCount) {
    EXPECT_EQ(notes(obj("s 1\n" + box() + "s off\n")),
              "smoothing groups (s) are not read: faces without normals are flat: 1\n");
    EXPECT_EQ(notes(obj("s off\ns 0\n" + box())), "");
    EXPECT_EQ(notes(obj("s 1\nvn 0 0 1\n" + box("{0}//1"))), "");
}

TEST(Obj, GroupsAreThoseOfTheLastLine) {
    const Mesh mesh = obj(vertex_lines() + "f 4 3 2 1\ng lid of it\nf 5 6 7 8\no  side \nf 1 2 6\n");
    ASSERT_EQ(mesh.triangle_group.size(), 5u);
    EXPECT_EQ(mesh.groups[mesh.triangle_group[0]], "");
    EXPECT_EQ(mesh.groups[mesh.triangle_group[2]], "lid of it");
    EXPECT_EQ(mesh.groups[mesh.triangle_group[4]], "side");
}

TEST(Obj, SurplusNumbersAreNamedOrRefused) {
    const Mesh mesh = obj("vn 0 3 4 5\nvn 0 0 1\n" + box("{0}//1"));
    expect_box(mesh);
    EXPECT_EQ(mesh.surface.normals[0], (Vec3{0, 0.6f, 0.8f}));
    EXPECT_EQ(notes(mesh), "words behind the three numbers of a normal (vn) are not read: 1\n");
    for (const std::string numbers : {"5 6", "5 6 7 1 2", "5 6 7 1 2 3 4 8"})
        EXPECT_THAT(refused(Format::obj, "v " + numbers + "\n" + box()),
                    HasSubstr("t: line 1: found a vertex"))
            << numbers;
}

// --- materials ---

const Vec3 red{0.8f, 0.1f, 0.1f}, blue{0.1f, 0.1f, 0.8f};
const std::string red_mtl = "newmtl red\nKd 0.8 0.1 0.1\n", blue_mtl = "newmtl blue\nKd 0.1 0.1 0.8\n";
const std::string two_faces =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n";

Vec3 kd(const Mesh& mesh, std::size_t triangle) {
    return std::get<MtlTerms>(mesh.materials[mesh.triangle_material[triangle]].terms).kd;
}

void expect_red_and_blue(const Mesh& mesh) {
    ASSERT_EQ(mesh.surface.triangles.size(), 2u);
    EXPECT_EQ(kd(mesh, 0), red);
    EXPECT_EQ(kd(mesh, 1), blue);
    EXPECT_THAT(mesh.missing_libraries, ElementsAre());
}

TEST(ObjLibraries, SeveralInALineAndNamesWithBlanksAndQuotes) {
    expect_red_and_blue(obj("mtllib r.mtl b.mtl\n" + two_faces, {{"r.mtl", red_mtl}, {"b.mtl", blue_mtl}}));
    expect_red_and_blue(
        obj("mtllib r.mtl\nmtllib b.mtl\n" + two_faces, {{"r.mtl", red_mtl}, {"b.mtl", blue_mtl}}));
    expect_red_and_blue(
        obj("mtllib my red one.mtl b.MTL\n" + two_faces, {{"my red one.mtl", red_mtl}, {"b.MTL", blue_mtl}}));
    expect_red_and_blue(obj("mtllib both of them\n" + two_faces, {{"both of them", red_mtl + blue_mtl}}));
    expect_red_and_blue(obj("mtllib r b\n" + two_faces, {{"r", red_mtl}, {"b", blue_mtl}}));
    expect_red_and_blue(
        obj("mtllib \"r 1.mtl\"  \"b 1.mtl\"\n" + two_faces, {{"r 1.mtl", red_mtl}, {"b 1.mtl", blue_mtl}}));
    expect_red_and_blue(
        obj("mtllib lib\\r.mtl lib/b.mtl\n" + two_faces, {{"lib/r.mtl", red_mtl}, {"lib/b.mtl", blue_mtl}}));
    expect_red_and_blue(
        obj("mtllib r#1.mtl b.mtl # both\n" + two_faces, {{"r#1.mtl", red_mtl}, {"b.mtl", blue_mtl}}));
    expect_red_and_blue(
        obj(two_faces + "mtllib r.mtl b.mtl r.mtl\n", {{"r.mtl", red_mtl}, {"b.mtl", blue_mtl}}));
}

TEST(ObjLibraries, NamesOfMaterialsMayHoldBlanksAndSharps) {
    expect_red_and_blue(obj("mtllib m.mtl\n" + replaced(two_faces, "usemtl red", "usemtl dark red #2"),
                            {{"m.mtl", "newmtl  dark red #2 \nKd 0.8 0.1 0.1\n" + blue_mtl}}));
}

TEST(ObjLibraries, LinesWithoutANameAreNamedAndGrey) {
    const Mesh mesh =
        obj("mtllib\nmtllib r.mtl b.mtl\n" + two_faces + "usemtl\nf 1 2 4\nusemtl \"\"\nf 2 3 4\n",
            {{"r.mtl", red_mtl}, {"b.mtl", blue_mtl}});
    ASSERT_EQ(mesh.surface.triangles.size(), 4u);
    EXPECT_EQ(kd(mesh, 1), blue);
    for (const std::size_t triangle : {2u, 3u})
        EXPECT_EQ(mesh.materials[mesh.triangle_material[triangle]].name, "default");
    EXPECT_EQ(notes(mesh),
              "mtllib without a name is passed over: 1\n"
              "usemtl without a name: the faces behind it have \"default\", a grey: 2\n");
}

TEST(ObjLibraries, AMissingOneIsNamedAndItsMaterialsAreGrey) {
    const Mesh mesh = obj("mtllib gone.mtl b.mtl\n" + two_faces, {{"b.mtl", blue_mtl}});
    EXPECT_THAT(mesh.missing_libraries, ElementsAre("gone.mtl"));
    EXPECT_EQ(kd(mesh, 0), (Vec3{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(mesh.materials[mesh.triangle_material[0]].name, "red");
    EXPECT_FALSE(mesh.materials[mesh.triangle_material[0]].is_described);
    EXPECT_EQ(kd(mesh, 1), blue);
    EXPECT_TRUE(mesh.materials[mesh.triangle_material[1]].is_described);
    EXPECT_EQ(notes(mesh),
              "the material library \"gone.mtl\" is not there: 1\nmaterials that no library describes are "
              "grey: 1\n");
}

TEST(ObjLibraries, OneUnderTheObjectsOwnNameStandsInForIt) {
    const Mesh mesh = obj("mtllib old name.mtl\n" + two_faces, {{"t.mtl", red_mtl + blue_mtl}});
    expect_red_and_blue(mesh);
    EXPECT_EQ(notes(mesh),
              "the material library \"old name.mtl\" is not there, \"t.mtl\" is read in its place: 1\n");
}

TEST(ObjLibraries, FacesWithoutAMaterialAreGreyAndUnknownNamesAreNamed) {
    const Mesh plain = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(plain.materials[plain.triangle_material[0]].name, "default");
    EXPECT_EQ(kd(plain, 0), (Vec3{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(notes(plain), "");
    const Mesh unknown = obj("mtllib b.mtl\n" + two_faces + "usemtl unused\n", {{"b.mtl", blue_mtl}});
    EXPECT_EQ(notes(unknown), "materials that no library describes are grey: 1\n");
}

TEST(ObjLibraries, TheLastMaterialOfANameCounts) {
    const Mesh mesh = obj("mtllib r.mtl b.mtl\n" + two_faces,
                          {{"r.mtl", "newmtl red\nKd 1 1 1\n" + red_mtl}, {"b.mtl", blue_mtl}});
    expect_red_and_blue(mesh);
    EXPECT_EQ(notes(mesh), "materials that are defined twice are read as the last of the name says: 1\n");
}

TEST(Obj, DamageIsRefusedWithItsLine) {
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto with = [&](const std::string& more) { return refused(Format::obj, three + more); };
    EXPECT_EQ(with("f 1 2 4\n"), "t: line 4: found the vertex 4, expected 1 to 3");
    EXPECT_EQ(
        with("\nf 1 2 3\nf 1 2 99999999999\n"),
        "t: line 6: found the vertex 99999999999 in the corner \"99999999999\", expected a smaller number");
    EXPECT_EQ(with("f 1 2 0\n"),
              "t: line 4: found the vertex 0 in the corner \"0\", expected 1 or more, or a negative number");
    EXPECT_EQ(
        with("f 1 2 -4\n"),
        "t: line 4: found the vertex -4 in the corner \"-4\", expected -3 to -1, counted back from here");
    EXPECT_EQ(with("f 1/1 2/1 3/1\n"),
              "t: line 4: found the texture coordinate 1, expected none: the file has none");
    EXPECT_EQ(with("vn 0 0 1\nf 1//1 2//1 3//2\n"), "t: line 5: found the normal 2, expected 1 to 1");
    EXPECT_EQ(with("f 1//-1 2 3\n"),
              "t: line 4: found the normal -1 in the corner \"1//-1\", expected a normal before it");
    EXPECT_EQ(with("f 1 2 3.5\n"),
              "t: line 4: found the corner \"3.5\", expected whole numbers: v, v/t, v//n or v/t/n");
    EXPECT_EQ(with("f 1///2 2 3\n"), "t: line 4: found the corner \"1///2\", expected v, v/t, v//n or v/t/n");
    EXPECT_EQ(with("v 1 2\n"), "t: line 4: found a vertex without its numbers, expected a finite number");
    EXPECT_EQ(with("v 1 2 x\n"), "t: line 4: found \"x\", expected a finite number");
    EXPECT_EQ(with("v 1 1e39 0\n"), "t: line 4: found \"1e39\", expected a finite number");
    EXPECT_EQ(with("vn nan 0 0\n"), "t: line 4: found \"nan\", expected a finite number");
    EXPECT_EQ(refused(Format::obj, three + std::string("f 1 2 3\nf 1\0 2 3\n", 18)),
              "t: line 5: found a NUL character, expected text");
    EXPECT_EQ(with(""), "t: found no triangle with an area, expected at least one");
    EXPECT_EQ(refused(Format::obj, ""), "t: found no triangle with an area, expected at least one");
}

TEST(Obj, EveryCutIsRefusedOrReadsAsAPartOfTheBox) {
    const std::string text = box();
    for (std::size_t length = 0; length < text.size(); ++length) {
        try {
            const Mesh mesh = obj(text.substr(0, length));
            EXPECT_LE(mesh.surface.triangles.size(), 12u);
            EXPECT_LE(area(mesh), 52);
        } catch (const trace::DataError&) {
        }
    }
}

}  // namespace
}  // namespace regather::meshes
