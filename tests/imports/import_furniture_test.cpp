#include "imports/furniture/demonstration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "imports/furniture/furniture_catalogue.h"
#include "tests/imports/archive.h"
#include "tests/scenes/closed_surface.h"
#include "tests/scratch.h"

namespace regather::imports {
namespace {

using scenes::is_closed;
using ::testing::HasSubstr;

TEST(FurnitureCatalogue, PropertiesAreLatin1WithEscapes) {
    const auto values = read_properties(
        "# comment \\\n name = Ren\xe9 \n\ncreator#1=\\u00a9 Ca\\u0301t\n! no = value\nmodel#1=/a/b.obj\r\n",
        "c");
    EXPECT_EQ(values.size(), 3u);
    EXPECT_EQ(values.at("name"), "Ren\xc3\xa9");
    EXPECT_EQ(values.at("creator#1"), "\xc2\xa9 Ca\xcc\x81t");
    EXPECT_EQ(values.at("model#1"), "/a/b.obj");
}

TEST(FurnitureCatalogue, PropertiesGoOnInTheNextLineAndAreCutAtTheFirstSeparator) {
    const auto values = read_properties(
        "a = one, \\\r\n    two\\\\\nb:three=3\nc four five\nd\\=\\:e=\\\tsix\nalone\nlast=\\", "c");
    EXPECT_EQ(values, (std::map<std::string, std::string, std::less<>>{{"a", "one, two\\"},
                                                                       {"b", "three=3"},
                                                                       {"c", "four five"},
                                                                       {"d=:e", " six"},
                                                                       {"alone", ""},
                                                                       {"last", ""}}));
    EXPECT_EQ(data_error([] { read_properties("a=1\n\nb=\\u12g4\n", "c.properties"); }),
              "c.properties: line 3: found \"12g4\", expected four hexadecimal digits after \\u");
}

TEST(FurnitureCatalogue, KeysThatAreNotUsedAreCounted) {
    const Scratch scratch;
    write_zip(scratch / "c.sh3f",
              {{"PluginFurnitureCatalog.properties",
                "id=x\nlicense=CC0\nmodel#1=/a.obj\nmodel#2=/b.obj\nname#1=A\nname#2=B\nicon#1=/i.png\n"}});
    const FurnitureCatalogue catalogue(scratch / "c.sh3f");
    LeftOut left_out;
    catalogue.count_left_out(left_out);
    EXPECT_EQ(catalogue.models(), 2u);
    EXPECT_THAT(left_out.lines(),
                ::testing::ElementsAre("left out of catalogues: icon# (once), id (once), name# (2 times)"));
}

TEST(FurnitureCatalogue, TheCreatorIsFoundByTheModel) {
    const Scratch scratch;
    write_zip(scratch / "c.sh3f",
              {{"PluginFurnitureCatalog.properties", "license=CC0\nmodel#7=/a/b.obj\ncreator#7=Jay\n"}});
    const FurnitureCatalogue catalogue(scratch / "c.sh3f");
    EXPECT_EQ(catalogue.value("license"), "CC0");
    EXPECT_EQ(catalogue.creator_of("a/b.obj"), "Jay");
    EXPECT_EQ(catalogue.creator_of("a/c.obj"), "");
}

TEST(ImportFurniture, AMissingModelOrCatalogueIsNamed) {
    const Scratch scratch;
    write_zip(scratch / "c.sh3f", {{"PluginFurnitureCatalog.properties", "license=CC0\n"}});
    write_zip(scratch / "d.sh3f", {{"readme", "no catalogue"}});
    const auto refusal = [&](const char* name) {
        const std::filesystem::path file = scratch / name;
        return data_error([&] { import_furniture({&file, 1}); });
    };
    EXPECT_THAT(refusal("c.sh3f"), HasSubstr("found no entry blendswap-cc-0/oakTable/oakTable.obj"));
    EXPECT_THAT(refusal("d.sh3f"),
                HasSubstr("d.sh3f: PluginFurnitureCatalog.properties: found no such entry"));
    EXPECT_THAT(refusal("gone.sh3f"), HasSubstr("gone.sh3f: found no file"));
    std::filesystem::create_directory(scratch / "empty");
    EXPECT_THAT(refusal("empty"), HasSubstr("found no .sh3f file"));
}

TEST(FurniturePackage, GlassAndGlossOnATableWithAuthorsAndLicences) {
    const std::filesystem::path folder = "/usr/share/sweethome3d/furniture";
    REQUIRE_FILE_OF("sweethome3d-furniture", folder);
    const ImportedScene scene = import_furniture({&folder, 1});
    EXPECT_GE(scene.triangle_count(), 10'000u);
    EXPECT_LE(scene.triangle_count(), 100'000u);
    EXPECT_GE(scene.frames, 30u);
    for (const char* author : {"Swapnilrocks98", "Kator Legaz", "Jay-Artist", "Hedgehogpro"})
        EXPECT_THAT(scene.origin, HasSubstr(author));
    for (const char* licence : {"Creative Commons Attribution 3.0", "Public domain"})
        EXPECT_THAT(scene.licence, HasSubstr(licence));
    std::size_t glass = 0, glossy = 0;
    for (const ImportedMesh& mesh : scene.meshes) {
        const Material& material = scene.materials[mesh.material];
        glass += material.kind == MaterialKind::dielectric;
        glossy += material.kind == MaterialKind::glossy;
        EXPECT_TRUE(material.kind != MaterialKind::dielectric || is_closed(mesh.surface)) << material.name;
    }
    EXPECT_GE(glass, 6u);
    EXPECT_GE(glossy, 3u);
}

}  // namespace
}  // namespace regather::imports
