#include "meshes/ply.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <functional>

#include "tests/meshes/parsed.h"

namespace regather::meshes {
namespace {

using ::testing::HasSubstr;

const std::string vertex_lines = "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n";
const std::string face_lines = "element face 6\nproperty list uchar int vertex_indices\n";

std::string corner_rows(const std::string& between = "\n") {
    std::string rows;
    for (const auto& [x, y, z] : box_corners) rows += fmt::format("{} {} {}{}", x, y, z, between);
    return rows;
}

std::string face_rows(const std::string& behind_length = " ") {
    std::string rows;
    for (const auto& [a, b, c, d] : box_faces)
        rows += fmt::format("4{}{} {} {} {}\n", behind_length, a, b, c, d);
    return rows;
}

std::string ascii(const std::string& declared, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + declared + "end_header\n" + body;
}

std::string ascii_box() {
    return ascii(vertex_lines + face_lines, corner_rows() + face_rows());
}

// A binary box whose corners are of type Coordinate and whose indices are of type Index.
template <class Coordinate, class Index>
std::string binary(const std::string& coordinate, const std::string& index, bool big_endian,
                   const std::string& line_end = "\n", const std::string& more_header = "",
                   const std::string& before_faces = "") {
    std::string bytes =
        replaced("ply\nformat " + std::string(big_endian ? "binary_big_endian" : "binary_little_endian") +
                     " 1.0\nelement vertex 8\nproperty C x\nproperty C y\nproperty C z\n" + more_header +
                     "element face 6\nproperty list uchar I vertex_indices\nend_header\n",
                 "\n", line_end);
    bytes = replaced(replaced(bytes, " C ", " " + coordinate + " "), " I ", " " + index + " ");
    for (const auto& corner : box_corners)
        for (const int x : corner) put(bytes, static_cast<Coordinate>(x), big_endian);
    bytes += before_faces;
    for (const auto& face : box_faces) {
        bytes += '\4';
        for (const int i : face) put(bytes, static_cast<Index>(i), big_endian);
    }
    return bytes;
}

TEST(Ply, ABoxIsReadFromAllThreeForms) {
    expect_box(parsed(Format::ply, ascii_box()), "ascii");
    expect_box(parsed(Format::ply, binary<float, std::int32_t>("float", "int", false)), "little-endian");
    expect_box(parsed(Format::ply, binary<float, std::int32_t>("float", "int", true)), "big-endian");
}

TEST(Ply, EveryTypeHoldsCoordinatesAndIndices) {
    for (const bool big : {false, true}) {
        expect_box(parsed(Format::ply, binary<std::int8_t, std::uint8_t>("char", "uchar", big)),
                   "char uchar");
        expect_box(parsed(Format::ply, binary<std::uint8_t, std::int8_t>("uint8", "int8", big)),
                   "uint8 int8");
        expect_box(parsed(Format::ply, binary<std::int16_t, std::uint16_t>("short", "ushort", big)),
                   "short ushort");
        expect_box(parsed(Format::ply, binary<std::uint16_t, std::int16_t>("uint16", "int16", big)),
                   "uint16 int16");
        expect_box(parsed(Format::ply, binary<std::int32_t, std::uint32_t>("int32", "uint32", big)),
                   "int32 uint32");
        expect_box(parsed(Format::ply, binary<double, float>("float64", "float32", big)), "double float");
        expect_box(parsed(Format::ply, binary<double, std::uint32_t>("double", "uint", big)), "double uint");
    }
}

TEST(Ply, NegativeCoordinatesKeepTheirSign) {
    // A triangle with corners at -1 and -2 in signed bytes: area 2 x 3 / 2.
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\n"
        "property char z\nelement face 1\nproperty list uchar uchar vertex_index\nend_header\n";
    bytes += std::string("\xff\xfe\0\1\xfe\0\xff\1\0\3\0\1\2", 13);  // (-1, -2, 0), (1, -2, 0), (-1, 1, 0)
    const Mesh mesh = parsed(Format::ply, bytes);
    EXPECT_DOUBLE_EQ(area(mesh), 3);
    EXPECT_EQ(trace::bounds_of(mesh.surface.vertices).min, (Vec3{-1, -2, 0}));
}

TEST(Ply, ABinaryBodyMayOpenWithALineEnd) {
    // The first coordinate's lowest byte is 0x0a: 2.3509887e-38 is the float of the bits 0x0100000a; 10 is
    // the byte.
    std::string bytes = binary<float, std::int32_t>("float", "int", false);
    bytes[bytes.find("end_header\n") + 11] = '\n';
    const Mesh mesh = parsed(Format::ply, bytes);
    EXPECT_EQ(mesh.surface.triangles.size(), 12u);
    EXPECT_NEAR(area(mesh), 52, 1e-5);
    std::string chars = binary<std::uint8_t, std::uint8_t>("uchar", "uchar", false);
    for (const std::size_t corner : {0, 3, 4, 7}) chars[chars.find("end_header\n") + 11 + 3 * corner] = '\n';
    for (const std::size_t corner : {1, 2, 5, 6}) chars[chars.find("end_header\n") + 11 + 3 * corner] = 12;
    EXPECT_NEAR(area(parsed(Format::ply, chars)), 52, 1e-5);  // from x = 10 to 12
}

TEST(Ply, HeaderLinesEndAsTheFirstDoes) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        expect_box(parsed(Format::ply, replaced(ascii_box(), "\n", end)), "ascii");
        expect_box(parsed(Format::ply, binary<float, std::int32_t>("float", "int", true, end)), "binary");
    }
    // After a header that ends with CR the first byte of the body may be a line feed.
    std::string bytes = binary<float, std::int32_t>("float", "int", false, "\r");
    bytes[bytes.find("end_header\r") + 11] = '\n';
    EXPECT_EQ(parsed(Format::ply, bytes).surface.triangles.size(), 12u);
    expect_box(parsed(Format::ply, "\xEF\xBB\xBF" + ascii_box()), "byte order mark");
}

TEST(Ply, AsciiValuesMayBePartedAnyhow) {
    expect_box(parsed(Format::ply, ascii(vertex_lines + face_lines, corner_rows() + face_rows("\n"))),
               "length alone");
    const std::string body = corner_rows() + face_rows();
    expect_box(parsed(Format::ply, ascii(vertex_lines + face_lines, replaced(body, "\n", " "))), "one line");
    expect_box(parsed(Format::ply, ascii(vertex_lines + face_lines, replaced(body, " ", "\n"))),
               "one value a line");
    expect_box(parsed(Format::ply, ascii(vertex_lines + face_lines, replaced(body, "\n", "\r\n\r\n\t"))),
               "blank lines");
    // Three coordinates in rows of two.
    std::string rows;
    int place = 0;
    for (const auto& corner : box_corners)
        for (const int x : corner) rows += fmt::format("{}{}", x, ++place % 2 == 0 ? "\n" : " ");
    expect_box(parsed(Format::ply, ascii(vertex_lines + face_lines, rows + face_rows())), "rows of two");
}

TEST(Ply, OtherElementsArePassedOverWhereverTheyStandAndNamed) {
    const std::string tag = "element tag 2\nproperty list uchar double weights\nproperty short id\n";
    const std::string tag_rows = "2 0.5 nan -3\n0 7\n";
    const Mesh before =
        parsed(Format::ply, ascii(tag + vertex_lines + face_lines, tag_rows + corner_rows() + face_rows()));
    const Mesh between =
        parsed(Format::ply, ascii(vertex_lines + tag + face_lines, corner_rows() + tag_rows + face_rows()));
    const Mesh behind =
        parsed(Format::ply, ascii(vertex_lines + face_lines + tag, corner_rows() + face_rows() + tag_rows));
    for (const Mesh& mesh : {before, between, behind}) {
        expect_box(mesh);
        EXPECT_EQ(notes(mesh), "elements \"tag\" are not read: 2\n");
    }
    std::string raw;
    for (const auto& [weights, id] : {std::pair{2, -3}, {0, 7}}) {
        raw += static_cast<char>(weights);
        for (int w = 0; w < weights; ++w) put(raw, 0.5);
        put(raw, static_cast<std::int16_t>(id));
    }
    expect_box(parsed(Format::ply, binary<float, std::int32_t>("float", "int", false, "\n", tag, raw)),
               "binary");
    const Mesh empty = parsed(
        Format::ply,
        ascii(vertex_lines + "element nothing 1000000000000\n" + face_lines, corner_rows() + face_rows()));
    expect_box(empty, "without properties");
    EXPECT_EQ(notes(empty), "elements \"nothing\" are not read: 1000000000000\n");
}

TEST(Ply, FacesMayStandBeforeTheirVertices) {
    expect_box(parsed(Format::ply, ascii(face_lines + vertex_lines, face_rows() + corner_rows())));
}

TEST(Ply, PropertiesStandInAnyOrderAndOthersAreNamed) {
    // z, a list, colour, y, x; and two properties of a face round its list.
    std::string declared =
        "element vertex 8\nproperty float z\nproperty list uchar int near\nproperty uchar red\n"
        "property float y\nproperty float x\n";
    declared +=
        "element face 6\nproperty float quality\nproperty list uint uint vertex_index\nproperty list uchar "
        "float texcoord\n";
    std::string rows;
    for (const auto& [x, y, z] : box_corners) rows += fmt::format("{} 2 7 8 255 {} {}\n", z, y, x);
    for (const auto& [a, b, c, d] : box_faces)
        rows += fmt::format("nan 4 {} {} {} {} 2 0.5 0.25\n", a, b, c, d);
    const Mesh mesh = parsed(Format::ply, ascii(declared, rows));
    expect_box(mesh);
    EXPECT_EQ(notes(mesh),
              "the properties \"near, red\" of vertices are not read: 8\n"
              "the properties \"quality, texcoord\" of faces are not read: 6\n");
}

TEST(Ply, NormalsAreKeptAtUnitLengthAndOnesThatAreNoneAreZero) {
    const std::string declared =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\n"
        "element face 1\nproperty list uchar int vertex_indices\n";
    const Mesh mesh =
        parsed(Format::ply, ascii(declared, "0 0 0 0 0 2\n1 0 0 0 0 0\n0 1 0 nan 0 0\n3 0 1 2\n"));
    EXPECT_EQ(mesh.surface.normals, (std::vector<Vec3>{{0, 0, 1}, {}, {}}));
    EXPECT_EQ(notes(mesh), "");
    std::string half = replaced(declared, "property float nz\n", "");
    const Mesh flat = parsed(Format::ply, ascii(half, "0 0 0 0 2\n1 0 0 0 2\n0 1 0 0 2\n3 0 1 2\n"));
    EXPECT_EQ(flat.surface.normals, std::vector<Vec3>(3));
    EXPECT_EQ(notes(flat), "the properties \"nx, ny\" of vertices are not read: 3\n");
}

TEST(Ply, FacesOfFewerThanThreeCornersAreLeftOutAndCounted) {
    const Mesh mesh = parsed(Format::ply, ascii(vertex_lines + replaced(face_lines, "face 6", "face 9"),
                                                corner_rows() + "0\n1 4\n" + face_rows() + "2 0 1\n"));
    expect_box(mesh);
    EXPECT_EQ(mesh.degenerate_faces, 3u);
    EXPECT_EQ(notes(mesh), "faces of fewer than three corners are left out: 3\n");
}

TEST(Ply, FacesWithoutAreaAreNamedApartFromThoseOfFewCorners) {
    const Mesh mesh =
        parsed(Format::ply, ascii(vertex_lines + replaced(face_lines, "face 6", "face 10"),
                                  corner_rows() + "3 1 1 4\n3 0 2 0\n0\n" + face_rows() + "3 7 7 7\n"));
    expect_box(mesh);
    EXPECT_EQ(mesh.degenerate_faces, 4u);
    EXPECT_EQ(notes(mesh),
              "faces of fewer than three corners are left out: 1\n"
              "triangles without area are left out: 3\n");
}

TEST(Ply, TriangleStripsTurnEverySecondTriangleAndMinusOneBeginsAnew) {
    // The upper half of an octahedron as one strip would be; here two quads, each a strip of four.
    const std::string declared =
        "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\n";
    const Mesh mesh = parsed(
        Format::ply, ascii(declared, "0 0 0\n1 0 0\n0 2 0\n1 2 0\n0 4 0\n1 4 0\n10 0 1 2 3 -1 2 3 4 5 -1\n"));
    EXPECT_EQ(mesh.surface.triangles.size(), 4u);
    EXPECT_DOUBLE_EQ(area(mesh), 4);
    for (const auto& [a, b, c] : mesh.surface.triangles) {
        const Vec3 p = mesh.surface.vertices[a];
        EXPECT_GT(cross(mesh.surface.vertices[b] - p, mesh.surface.vertices[c] - p).z, 0);
    }
    EXPECT_EQ(notes(mesh), "");
    const Mesh with_short_ones =
        parsed(Format::ply,
               ascii(replaced(declared, "tristrips 1", "tristrips 3"),
                     "0 0 0\n1 0 0\n0 2 0\n1 2 0\n0 4 0\n1 4 0\n0\n10 0 1 -1 -1 3 -1 0 1 2 3\n2 4 5\n"));
    EXPECT_DOUBLE_EQ(area(with_short_ones), 2);
    EXPECT_EQ(notes(with_short_ones), "triangle strips of fewer than three corners are left out: 4\n");
}

TEST(Ply, WhatFollowsTheLastElementIsNamed) {
    EXPECT_EQ(notes(parsed(Format::ply, ascii_box() + " \r\n\t\n")), "");
    EXPECT_EQ(notes(parsed(Format::ply, ascii_box() + "\n9 9 9")),
              "bytes behind the last element are not read: 5\n");
    std::string commented = ascii_box();
    commented.insert(4, "comment TextureFile a.png\nobj_info made by hand\n");
    EXPECT_EQ(notes(parsed(Format::ply, commented)), "textures (comments TextureFile) are not read: 1\n");
}

TEST(Ply, DamageIsRefusedWithItsPlace) {
    const auto with = [](const std::string& what, const std::string& by) {
        std::string text = ascii_box();
        text.replace(text.find(what), what.size(), by);
        return refused(Format::ply, text);
    };
    EXPECT_EQ(with("ply", "plx"), "t: line 1: found no \"ply\" in the first line, expected a PLY file");
    EXPECT_EQ(
        with("ascii", "asci"),
        "t: line 2: found the format \"asci\", expected ascii, binary_little_endian or binary_big_endian");
    EXPECT_EQ(with("ascii 1.0", "ascii 2.0"), "t: line 2: found the version \"2.0\", expected 1.0");
    EXPECT_EQ(with("format ascii 1.0\n", ""),
              "t: line 8: found a header without its format, expected a line \"format FORM 1.0\" in it");
    EXPECT_THAT(with("element vertex 8", "element vertex -8"),
                HasSubstr("line 3: found \"element vertex -8\", expected element NAME COUNT"));
    EXPECT_THAT(with("float y", "flaot y"),
                HasSubstr("line 5: found the type \"flaot\", expected char, uchar, short"));
    EXPECT_THAT(with("float y", "float x"),
                HasSubstr("line 5: found a second property \"x\", expected one in an element"));
    EXPECT_THAT(with("element face", "element vertex"),
                HasSubstr("line 7: found a second element \"vertex\""));
    EXPECT_THAT(with("list uchar", "list float"), HasSubstr("line 8: found a list whose length is a float"));
    EXPECT_THAT(with("property float z", "propperty float z"),
                HasSubstr("line 6: found \"propperty float z\", expected format"));
    EXPECT_THAT(with("end_header", "end_haeder"), HasSubstr("line 9: found \"end_haeder\""));
    EXPECT_EQ(with("float z", "float w"), "t: found no property \"z\" of vertex, expected x, y and z");
    EXPECT_EQ(with("vertex_indices", "indices"),
              "t: found no list vertex_indices of face, expected one (or vertex_index)");
    EXPECT_EQ(with("2 3 4\n", "2 x 4\n"),
              "t: line 16: found \"x\", expected a finite number for \"y\" of vertex 7 of 8");
    EXPECT_EQ(with("2 3 4\n", "2 nan 4\n"),
              "t: line 16: found \"nan\", expected a finite number for \"y\" of vertex 7 of 8");
    EXPECT_EQ(with("2 3 4\n", "2 1e39 4\n"),
              "t: line 16: found \"1e39\", expected a finite number for \"y\" of vertex 7 of 8");
    EXPECT_EQ(with("4 3 2 1 0", "4 3 2 1 8"),
              "t: line 18: found the vertex 8 in face 1 of 6, expected 0 to 7");
    EXPECT_EQ(with("4 3 2 1 0", "4 3 2 1 -1"),
              "t: line 18: found the vertex -1 in face 1 of 6, expected 0 to 7");
    EXPECT_EQ(with("4 3 2 1 0", "4 3 2 1 0.5"),
              "t: line 18: found \"0.5\", expected a whole number in \"vertex_indices\" of face 1 of 6");
    EXPECT_EQ(with("4 3 0 4 7\n", "4 3 0"),
              "t: line 23: found a list of 4 for 4 bytes, expected what is there of face 6 of 6");
    EXPECT_EQ(refused(Format::ply,
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
                      "float z\nend_header\n1 2 3\n"),
              "t: found no element \"face\", expected one: a cloud of points has no surface");
    EXPECT_EQ(
        refused(Format::ply,
                "ply\nformat ascii 1.0\nelement face 0\nproperty list uchar int vertex_index\nend_header\n"),
        "t: found no element \"vertex\", expected one");
}

TEST(Ply, EveryCutIsRefused) {
    const std::string text = ascii_box();
    // An ASCII file that only lacks its last line end is whole.
    for (std::size_t length = 0; length + 2 < text.size(); ++length)
        EXPECT_NE(refused(Format::ply, text.substr(0, length)), "") << length;
    const std::string bytes = binary<float, std::uint16_t>("float", "ushort", true);
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_NE(refused(Format::ply, bytes.substr(0, length)), "") << length;
}

TEST(Ply, WhatIsDeclaredAndCannotBeThereIsRefusedInBoundedMemory) {
    rusage before{};
    getrusage(RUSAGE_SELF, &before);
    EXPECT_EQ(
        refused(Format::ply,
                ascii("element vertex 100000000\nproperty float x\nproperty float y\nproperty float z\n" +
                          face_lines,
                      "0 0 0\n")),
        "t: found 6 bytes for 100000000 times \"vertex\", expected a file that holds what its header "
        "declares");
    EXPECT_THAT(refused(Format::ply, ascii("element vertex 18446744073709551615\nproperty float x\nproperty "
                                           "float y\nproperty float z\n" +
                                               face_lines,
                                           "")),
                HasSubstr("found 18446744073709551615 vertices, expected at most 150000000"));
    EXPECT_THAT(
        refused(Format::ply, ascii("element tag 18446744073709551615\nproperty float x\nproperty int y\n" +
                                       vertex_lines + face_lines,
                                   "")),
        HasSubstr("found 0 bytes for 18446744073709551615 times \"tag\""));
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty char x\nproperty char y\nproperty "
        "char z\n"
        "element face 1\nproperty list uint int vertex_index\nend_header\n";
    bytes += std::string(3, '\0') + "\xff\xff\xff\xff" + std::string(8, '\0');
    EXPECT_THAT(refused(Format::ply, bytes),
                HasSubstr("found a list of 4294967295 for 8 bytes, expected what is there of face 1 of 1"));
    rusage after{};
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024);  // [KiB]
}

}  // namespace
}  // namespace regather::meshes
