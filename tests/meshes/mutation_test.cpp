// Damaged mesh files: whatever a few bytes are changed to, a file is read or refused in one line, and what is
// read is whole. The damage is drawn from a fixed seed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/meshes/parsed.h"

namespace regather::meshes {
namespace {

// Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014.
class Random {
public:
    std::uint64_t below(std::uint64_t n) {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return (z ^ (z >> 31)) % n;
    }

private:
    std::uint64_t state_ = 1;
};

std::string damaged(std::string bytes, Random& random) {
    static const std::array<std::string, 12> pieces{
        "-1", "0",    "99999999999",        "1e999", "nan",      "\n",
        "/",  "\xff", std::string(1, '\0'), "\"",    "{\"a\":[", "18446744073709551615"};
    for (std::uint64_t changes = 1 + random.below(4); changes > 0 && !bytes.empty(); --changes) {
        const std::size_t at = random.below(bytes.size());
        switch (random.below(5)) {
            case 0:
                bytes[at] = static_cast<char>(random.below(256));
                break;
            case 1:
                bytes.erase(at, 1 + random.below(8));
                break;
            case 2:
                bytes.insert(at, pieces[random.below(pieces.size())]);
                break;
            case 3:
                bytes.replace(at, 1 + random.below(3), pieces[random.below(pieces.size())]);
                break;
            default:
                bytes.insert(at, bytes.substr(random.below(bytes.size()), 1 + random.below(40)));
        }
    }
    return bytes;
}

void expect_whole(const Mesh& mesh) {
    const Surface& surface = mesh.surface;
    ASSERT_FALSE(surface.triangles.empty());
    ASSERT_EQ(surface.normals.size(), surface.vertices.size());
    ASSERT_EQ(mesh.triangle_material.size(), surface.triangles.size());
    for (const Vec3 p : surface.vertices) ASSERT_TRUE(trace::is_finite(p));
    for (const Vec3 n : surface.normals) ASSERT_TRUE(n == Vec3{} || std::abs(length(n) - 1) < 1e-4f);
    for (const Triangle& t : surface.triangles)
        for (const std::uint32_t v : t) ASSERT_LT(v, surface.vertices.size());
    for (const std::uint32_t m : mesh.triangle_material) ASSERT_LT(m, mesh.materials.size());
    for (const std::uint32_t g : mesh.triangle_group) ASSERT_LT(g, mesh.groups.size());
}

// How many of `times` damaged files were read.
int read_of(int times, Format format, const std::string& bytes, const Files& files,
            bool damages_file = true) {
    Random random;
    int read = 0;
    for (int i = 0; i < times; ++i) {
        const std::string changed = damaged(damages_file ? bytes : files.begin()->second, random);
        Files beside = files;
        if (!damages_file) beside.begin()->second = changed;
        try {
            const Mesh mesh = parsed(format, damages_file ? changed : bytes, beside);
            expect_whole(mesh);
            ++read;
        } catch (const trace::DataError& error) {
            for (const char c : std::string_view(error.what()))
                EXPECT_GE(static_cast<unsigned char>(c), 0x20);
        }
    }
    return read;
}

const std::string obj_text =
    "# a box with a hole\nmtllib m.mtl\nv 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 4 1 0 0\nv 1e0 +1 .5\nvt 0 "
    "0\nvn 0 0 1\n"
    "g lid\nusemtl red\ns 1\nf 1 2 3 4\nf 1/1 2/1 5/1\nf -1//1 -2//1 -3//1\nf 1/1/1 2 \\\n 6\nl 1 2\np 1\n";
const std::string mtl_text =
    "newmtl red\nKd 0.8 0.1 0.1\nKe 1 1 1\nd -halo 0.5\nTr 0.5\nmap_Kd -s 1 1 1 a b.png\nNs 10\nillum 2\n";

TEST(Damaged, Obj) {
    EXPECT_GT(read_of(3000, Format::obj, obj_text, {{"m.mtl", mtl_text}}), 20);
}

TEST(Damaged, Mtl) {
    EXPECT_GT(read_of(3000, Format::obj, obj_text, {{"m.mtl", mtl_text}}, false), 20);
}

TEST(Damaged, AsciiPly) {
    EXPECT_GT(
        read_of(
            3000, Format::ply,
            "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 4\nproperty float x\nproperty "
            "double y\n"
            "property int z\nproperty uchar red\nproperty float nx\nproperty float ny\nproperty float nz\n"
            "element face 2\nproperty list uchar int vertex_indices\nelement tristrips 1\n"
            "property list int int vertex_indices\nend_header\n0 0 0 9 0 0 1\n2 0 0 9 0 0 1\n2 3 0 9 0 0 1\n"
            "0 3 4 9 0 0 1\n4 0 1 2 3\n3 0 1 2\n5 0 1 2 -1 3\n",
            {}),
        20);
}

TEST(Damaged, BinaryPly) {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty short y\n"
        "property uchar z\nelement tag 1\nproperty list uchar short id\nelement face 1\n"
        "property list uint ushort vertex_indices\nend_header\n";
    for (const int v : {0, 1, 2, 3}) {
        put(bytes, static_cast<float>(v % 2), true);
        put(bytes, static_cast<std::int16_t>(v / 2), true);
        put(bytes, static_cast<std::uint8_t>(v));
    }
    bytes += std::string("\2\0\1\0\2\0\0\0\4\0\0\0\1\0\3\0\2", 17);
    EXPECT_GT(read_of(3000, Format::ply, bytes, {}), 20);
}

const std::string gltf_text =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0, "scale": [-1, 2, 1]}, {"children": [2], "rotation": [0, 0, 1, 0]}, {"mesh": 0, "skin": 0}], "skins": [{"joints": [0]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1, "material": 0, "mode": 5}]}], "materials": [{"name": "m", "emissiveFactor": [1, 0, 0], "pbrMetallicRoughness": {"roughnessFactor": 0.5}}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 0}}}, {"bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR"}], "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 4}], "buffers": [{"byteLength": 52BUFFER}]})";

std::string gltf_bytes() {
    std::string bytes;
    for (const float x : {0.f, 0.f, 1.f, 2.f, 0.f, 0.f, 0.f, 3.f, 0.f, 2.f, 3.f, 4.f}) put(bytes, x);
    return bytes + std::string("\0\1\2\3", 4);
}

std::string gltf_with(const std::string& buffer) {
    std::string text = gltf_text;
    return text.replace(text.find("BUFFER"), 6, buffer);
}

TEST(Damaged, Gltf) {
    EXPECT_GT(read_of(3000, Format::gltf, gltf_with(R"(, "uri": "b.bin")"), {{"b.bin", gltf_bytes()}}), 20);
    EXPECT_GT(read_of(1000, Format::gltf, gltf_with(R"(, "uri": "b.bin")"), {{"b.bin", gltf_bytes()}}, false),
              20);
}

TEST(Damaged, Glb) {
    std::string json = gltf_with("");
    while (json.size() % 4 != 0) json += ' ';
    std::string bytes = "glTF";
    put(bytes, std::uint32_t{2});
    put(bytes, static_cast<std::uint32_t>(28 + json.size() + 52));
    put(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    put(bytes, std::uint32_t{52});
    bytes += std::string("BIN\0", 4) + gltf_bytes();
    EXPECT_GT(read_of(3000, Format::gltf, bytes, {}), 20);
}

}  // namespace
}  // namespace regather::meshes
