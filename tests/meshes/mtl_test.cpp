#include "meshes/mtl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::meshes {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Library {
    std::vector<Material> materials;
    std::vector<std::string> notes;
    const MtlTerms& terms(std::size_t i = 0) const { return std::get<MtlTerms>(materials.at(i).terms); }
};

Library read(const std::string& text) {
    Notes notes;
    std::vector<Material> materials = read_mtl(text, "m.mtl", notes);
    return {std::move(materials), notes.lines()};
}

std::string refused(const std::string& text) {
    try {
        read(text);
    } catch (const trace::DataError& error) {
        return error.what();
    }
    return "";
}

TEST(Mtl, TermsAreReadInLettersOfAnyCaseAndLinesOfAnyForm) {
    for (const std::string end : {"\n", "\r\n", "\r", "\n\t  "}) {
        std::string text =
            "newmtl paint\nKa 0 0 0\nKd 0.1 0.2 0.3\nks 0.4 0.5 0.6\nNS 70\nNi 1.5\nd 0.75\nillum 3\nnewmtl "
            "other\n";
        for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + end.size()))
            text.replace(at, 1, end);
        const Library library = read("\xEF\xBB\xBF# by hand\n" + text);
        ASSERT_EQ(library.materials.size(), 2u);
        EXPECT_EQ(library.materials[0].name, "paint");
        EXPECT_EQ(library.terms().kd, (Vec3{0.1f, 0.2f, 0.3f}));
        EXPECT_EQ(library.terms().ks, (Vec3{0.4f, 0.5f, 0.6f}));
        EXPECT_EQ(library.terms().ns, 70);
        EXPECT_EQ(library.terms().ni, 1.5f);
        EXPECT_EQ(library.terms().d, 0.75f);
        EXPECT_EQ(library.terms().illum, 3);
        EXPECT_EQ(library.terms(1).kd,
                  (Vec3{0.5f, 0.5f, 0.5f}));  // nothing is taken over from the one before
        EXPECT_EQ(library.terms(1).d, 1);
        EXPECT_THAT(library.notes, IsEmpty());
    }
}

TEST(Mtl, OneNumberStandsForThreeChannels) {
    EXPECT_EQ(read("newmtl a\nKd 0.25\n").terms().kd, (Vec3{0.25f, 0.25f, 0.25f}));
}

TEST(Mtl, OpacityComesFromDAndElseFromTr) {
    EXPECT_FLOAT_EQ(read("newmtl a\nTr 0.75\n").terms().d, 0.25f);
    const Library agreeing = read("newmtl a\nd 0.25\nTr 0.75\nnewmtl b\nTr 0\n");
    EXPECT_FLOAT_EQ(agreeing.terms().d, 0.25f);
    EXPECT_EQ(agreeing.terms(1).d, 1);
    EXPECT_THAT(agreeing.notes, IsEmpty());
    // Some programs write Tr as they write d.
    for (const std::string text : {"newmtl a\nd 1\nTr 1\n", "newmtl a\nTr 1\nd 1\n"}) {
        EXPECT_EQ(read(text).terms().d, 1);
        EXPECT_THAT(read(text).notes,
                    ElementsAre("materials whose d and Tr contradict each other are read by d: 1"));
    }
    const Library halo = read("newmtl a\nd -halo 0.5\n");
    EXPECT_EQ(halo.terms().d, 0.5f);
    EXPECT_THAT(halo.notes,
                ElementsAre("opacities that depend on the view (d -halo) are read as even ones: 1"));
}

TEST(Mtl, EmissionIsReadAndNamed) {
    const Library library = read("newmtl dark\nKe 0 0 0\nnewmtl lamp\nKe 5 4 3\n");
    EXPECT_EQ(library.materials[0].emission, Vec3{});
    EXPECT_EQ(library.materials[1].emission, (Vec3{5, 4, 3}));
    EXPECT_THAT(library.notes, ElementsAre("materials that emit light (Ke) do not shine: 1"));
}

TEST(Mtl, TheFileOfATextureStandsBehindItsOptions) {
    const auto texture = [](const std::string& line) {
        return read("newmtl a\n" + line + "\n").materials[0].texture;
    };
    EXPECT_EQ(texture("map_Kd wood grain.png"), "wood grain.png");
    EXPECT_EQ(texture("map_Kd -s 2 2 1 -o 0.5 -clamp on -mm 0 1 tex\\wood.png"), "tex\\wood.png");
    EXPECT_EQ(texture("map_Ks shine.png"), "");
    const Library library = read("newmtl a\nmap_Kd a.png\nmap_Bump b.png\nnewmtl b\nmap_Kd c.png\n");
    EXPECT_THAT(library.notes,
                ElementsAre("textures (map_Kd) are not read: 2", "textures (map_bump) are not read: 1"));
}

TEST(Mtl, WhatIsNotUnderstoodIsNamed) {
    const Library library = read(
        "newmtl a\nKd spectral red.rfl\nKs xyz 0.1 0.2 0.3\nPr 0.5\nPr 0.5\nTf 1 0 0\nTf 1 1 1\nhello "
        "world\n");
    EXPECT_EQ(library.terms().kd, (Vec3{0.5f, 0.5f, 0.5f}));
    EXPECT_THAT(library.notes, ElementsAre("colours given as spectra or in CIE XYZ are not read: 2",
                                           "the material term \"pr\" is not read: 2",
                                           "colours of transmitted light (Tf) are not read: 1",
                                           "the material term \"hello\" is not read: 1"));
}

TEST(Mtl, SurplusWordsAndAmbientColoursAreNamed) {
    const Library library = read(
        "newmtl a\nKa 0 0.25 0\nKd 1 0 0 7\nKs 0.5 0.25 0.125 0.5 # four\nNs 10 20\nillum 2 x\nnewmtl b\n"
        "Ka 0.5\nNs 30 40\nd -halo 0.75 1\nKd 0.5 # one\nPr 1 2 3\n");
    EXPECT_EQ(library.terms().kd, (Vec3{1, 0, 0}));
    EXPECT_EQ(library.terms().ks, (Vec3{0.5f, 0.25f, 0.125f}));
    EXPECT_EQ(library.terms().ns, 10);
    EXPECT_THAT(library.notes,
                ElementsAre("ambient colours (Ka) are not read: 2",
                            "words behind the numbers of the material term \"kd\" are not read: 1",
                            "words behind the numbers of the material term \"ks\" are not read: 1",
                            "words behind the numbers of the material term \"ns\" are not read: 2",
                            "words behind the numbers of the material term \"illum\" are not read: 1",
                            "opacities that depend on the view (d -halo) are read as even ones: 1",
                            "words behind the numbers of the material term \"d\" are not read: 1",
                            "the material term \"pr\" is not read: 1"));
}

TEST(Mtl, DamageIsRefusedWithItsLine) {
    EXPECT_EQ(refused("Kd 1 1 1\n"), "m.mtl: line 1: found \"kd\" before the first newmtl, expected newmtl");
    EXPECT_EQ(refused("newmtl\n"), "m.mtl: line 1: found newmtl without a name, expected newmtl NAME");
    EXPECT_EQ(refused("newmtl a\nKd 1 1\n"),
              "m.mtl: line 2: found a term without its number, expected a finite number");
    EXPECT_EQ(refused("newmtl a\n\nNs nan\n"), "m.mtl: line 3: found \"nan\", expected a finite number");
    EXPECT_EQ(refused("newmtl a\nKd 1 1 1e39\n"), "m.mtl: line 2: found \"1e39\", expected a finite number");
    EXPECT_EQ(refused("newmtl a\nillum 2.5\n"),
              "m.mtl: line 2: found illum 2.5, expected a whole number from 0 to 10");
    EXPECT_THAT(refused(std::string("newmtl a\0b\n", 11)), HasSubstr("line 1: found a NUL character"));
}

}  // namespace
}  // namespace regather::meshes
