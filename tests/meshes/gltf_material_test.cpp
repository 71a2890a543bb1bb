#include "meshes/gltf_material.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/meshes/gltf_box.h"

namespace regather::meshes {
namespace {

using ::testing::HasSubstr;

TEST(Gltf, MaterialsAreReadByTheirFactors) {
    Parts parts;
    parts.material = R"("alphaMode": "BLEND", "emissiveFactor": [1, 0.5, 0.25],
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.3, "roughnessFactor": 0.2,
                                 "baseColorTexture": {"index": 0}},
        "normalTexture": {"index": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.9}, "KHR_materials_ior": {"ior": 1.33},
                       "KHR_materials_emissive_strength": {"emissiveStrength": 8}, "KHR_materials_sheen": {}})";
    const Mesh mesh = read(parts);
    EXPECT_EQ(mesh.materials[0].name, "material 0");
    EXPECT_EQ(mesh.materials[0].emission, (Vec3{8, 4, 2}));
    const auto& terms = std::get<MetallicRoughness>(mesh.materials[0].terms);
    EXPECT_EQ(terms.base_color, (Vec3{0.5f, 0.25f, 0.125f}));
    EXPECT_EQ(terms.alpha, 0.75f);
    EXPECT_EQ(terms.metallic, 0.3f);
    EXPECT_EQ(terms.roughness, 0.2f);
    EXPECT_EQ(terms.transmission, 0.9f);
    EXPECT_EQ(terms.index_of_refraction, 1.33f);
    EXPECT_EQ(notes(mesh),
              "textures of materials are not read: 2\n"
              "the extension \"KHR_materials_sheen\" of materials is not read: 1\n"
              "materials that emit light (emissiveFactor) do not shine: 1\n");
    parts.material = R"("alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.1]})";
    EXPECT_EQ(std::get<MetallicRoughness>(read(parts).materials[0].terms).alpha, 1);
    EXPECT_EQ(notes(read(parts)), "alpha masks of materials are not applied: 1\n");
    parts.material = R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1]})";
    EXPECT_THAT(refused(parts), HasSubstr("materials[0].pbrMetallicRoughness.baseColorFactor: found a list "
                                          "of 3, expected a list of 4 numbers"));
    parts = {};
    parts.primitive = R"("attributes": {"POSITION": 0}, "indices": 1)";
    const Mesh plain = read(parts);
    EXPECT_EQ(plain.materials[plain.triangle_material[0]].name, "default");
}

TEST(Gltf, FactorsOutsideTheirRangesAreRefused) {
    const auto with = [](const std::string& material) {
        Parts parts;
        parts.material = material;
        return refused(parts);
    };
    const std::string share = ", expected a number from 0 to 1", at = "t: line 1, materials[0].";
    for (const auto& [key, value] : {std::pair{"metallicFactor", "5"}, std::pair{"roughnessFactor", "-3"}})
        EXPECT_EQ(with(fmt::format(R"("pbrMetallicRoughness": {{"{}": {}}})", key, value)),
                  fmt::format("{}pbrMetallicRoughness.{}: found {}{}", at, key, value, share));
    EXPECT_EQ(with(R"("pbrMetallicRoughness": {"baseColorFactor": [0.25, 2, 0, 1]})"),
              at + "pbrMetallicRoughness.baseColorFactor[1]: found 2" + share);
    EXPECT_EQ(with(R"("pbrMetallicRoughness": {"baseColorFactor": [0.25, 0, -1, 1]})"),
              at + "pbrMetallicRoughness.baseColorFactor[2]: found -1" + share);
    EXPECT_EQ(with(R"("emissiveFactor": [0.5, 1, 1.5])"), at + "emissiveFactor[2]: found 1.5" + share);
    EXPECT_EQ(with(R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 1.25}})"),
              at + "extensions.KHR_materials_transmission.transmissionFactor: found 1.25" + share);
    EXPECT_EQ(
        with(R"("extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": -8}})"),
        at + "extensions.KHR_materials_emissive_strength.emissiveStrength: found -8, expected a number of "
             "0 or more");
    EXPECT_EQ(with(R"("extensions": {"KHR_materials_ior": {"ior": -1.5}})"),
              at + "extensions.KHR_materials_ior.ior: found -1.5, expected a number of 0 or more");
    EXPECT_EQ(with(R"("alphaMode": "blend")"),
              at + "alphaMode: found \"blend\", expected \"OPAQUE\", \"MASK\" or \"BLEND\"");
    EXPECT_EQ(with(R"("alphaMode": "OPAQUE", "pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0.5, 1]})"),
              "");
}

}  // namespace
}  // namespace regather::meshes
