#include "imports/maps/bsp.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "imports/maps/entity_keys.h"
#include "tests/imports/bsp_text.h"
#include "trace/error.h"

namespace regather::imports {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string refusal(const std::vector<std::uint8_t>& bytes) {
    try {
        read_bsp(bytes, "m.bsp");
    } catch (const trace::DataError& error) {
        return error.what();
    }
    return "taken";
}

void set(std::vector<std::uint8_t>& bytes, std::size_t at, std::int32_t value) {
    std::memcpy(&bytes[at], &value, 4);
}

TEST(Bsp, AHandMadeMapHasWhatWasPutIn) {
    const Bsp bsp = read_bsp(hand_made_map().bytes(), "m.bsp");
    ASSERT_EQ(bsp.faces.size(), 4u);
    EXPECT_EQ(bsp.faces[2].kind, BspFace::Kind::patch);
    EXPECT_EQ(bsp.faces[2].patch_width, 3u);
    EXPECT_EQ(bsp.textures[1].name, "textures/x/lamp_2k");
    EXPECT_EQ(bsp.vertices[8].position, (Vec3{192, 0, 0}));
    EXPECT_EQ(bsp.indices, (std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}));
    EXPECT_EQ(bsp.entities.at(1).value("origin"), "0 0 24");
    EXPECT_EQ(bsp.entities.at(1).value("target"), "");
    EXPECT_EQ(bsp.nodes.at(0).children, (std::array<std::int32_t, 2>{-1, -2}));
    EXPECT_EQ(bsp.leaves.at(1).brush_count, 1u);
    EXPECT_EQ(bsp.models.at(0).face_count, 4u);
}

TEST(Bsp, EveryCutFileIsRefused) {
    const auto whole = hand_made_map().bytes();
    for (std::size_t size = 0; size + 1 < whole.size(); ++size)
        EXPECT_NE(refusal({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}), "taken")
            << size;
}

TEST(Bsp, OtherFilesAreNamed) {
    auto bytes = hand_made_map().bytes();
    set(bytes, 4, 47);
    EXPECT_EQ(refusal(bytes), "m.bsp: version: found 47, expected 46");
    bytes[0] = 'R';
    EXPECT_EQ(refusal(bytes), "m.bsp: magic: found \"RBSP\", expected \"IBSP\"");
}

TEST(Bsp, LumpsOutsideTheFileAndHalfRecordsAreRefused) {
    auto bytes = hand_made_map().bytes();
    set(bytes, 8 + 8 * BspText::vertices, std::numeric_limits<std::int32_t>::max());
    EXPECT_THAT(refusal(bytes), HasSubstr("lump of vertices: found"));
    bytes = hand_made_map().bytes();
    set(bytes, 8 + 8 * BspText::faces + 4, -104);
    EXPECT_THAT(refusal(bytes), HasSubstr("lump of faces: found -104 bytes"));
    bytes = hand_made_map().put(BspText::planes, 0).bytes();
    EXPECT_THAT(refusal(bytes), HasSubstr("lump of planes: found 100 bytes, expected a multiple of 16"));
}

TEST(Bsp, LumpsThatShareBytesAreRefused) {
    auto bytes = hand_made_map().bytes();
    std::int32_t planes = 0;
    std::memcpy(&planes, &bytes[8 + 8 * BspText::planes], 4);
    set(bytes, 8 + 8 * BspText::nodes, planes + 16);  // within the six planes of 16 bytes
    EXPECT_THAT(refusal(bytes),
                HasSubstr(fmt::format("m.bsp: lump of nodes: found it from byte {} on, expected it behind "
                                      "the lump of planes, which ends at {}",
                                      planes + 16, planes + 96)));
    set(bytes, 8 + 8 * BspText::nodes + 4, 0);  // an empty one may lie anywhere
    EXPECT_THAT(refusal(bytes), Not(HasSubstr("expected it behind")));
}

TEST(Bsp, LumpsThatAreNotReadAreCounted) {
    auto map = hand_made_map();
    map.put(BspText::effects, std::array<char, 72>{}).put(BspText::leaf_faces, 0, 1, 2);
    map.put(BspText::light_maps, std::array<std::array<char, 128>, 3 * 128>{});
    EXPECT_THAT(
        read_bsp(map.bytes(), "m.bsp").left_out.lines(),
        ::testing::ElementsAre("left out of the map: fogs (once), leaf faces (3 times), light maps (once)"));
}

TEST(Bsp, TextOfEntitiesIsBounded) {
    auto map = hand_made_map();
    map.text(std::string(17u << 20, ' '));
    EXPECT_THAT(refusal(map.bytes()), HasSubstr("m.bsp: lump of entities: found 178"));
}

TEST(EntityKeys, ClassesAndKeysThatAreNotUsedAreCounted) {
    LeftOut left_out;
    count_left_out(read_entities(R"({ "classname" "worldspawn" "message" "m" "music" "a.wav" "ambient" "5" }
        { "classname" "light" "origin" "0 0 0" "light" "300" "_color" "1 1 1" "target" "t1" }
        { "classname" "light" "origin" "0 0 0" "target" "t1" }
        { "classname" "info_player_deathmatch" "origin" "0 0 0" "angle" "90" "nobots" "1" }
        { "classname" "weapon_shotgun" "origin" "0 0 0" "team" "a" } { "classname" "item_quad" "origin" "0 0 0" "team" "b" }
        { "classname" "func_door" "model" "*1" "origin" "0 0 0" "speed" "100" }
        { "classname" "target_speaker" "origin" "0 0 0" } { "classname" "target_speaker" } { "origin" "0 0 0" })",
                                 "m"),
                   left_out);
    EXPECT_THAT(left_out.lines(),
                ::testing::ElementsAre(
                    "left out of entities: target_speaker (2 times), without a classname (once)",
                    "left out of entity info_player_deathmatch: nobots (once)",
                    "left out of entity items: team (2 times)", "left out of entity light: target (2 times)",
                    "left out of entity worldspawn: ambient (once), music (once)",
                    "left out of moving parts: speed (once)"));
}

TEST(Bsp, IndicesThatLeadNowhereAreRefused) {
    EXPECT_THAT(refusal(hand_made_map().face(3, 1, 0, 4, 0, 6).bytes()),
                HasSubstr("faces[4].texture: found 3"));
    EXPECT_THAT(refusal(hand_made_map().face(0, 5, 0, 4, 0, 6).bytes()), HasSubstr("faces[4].type: found 5"));
    EXPECT_THAT(refusal(hand_made_map().face(0, 1, 15, 4, 0, 6).bytes()),
                HasSubstr("faces[4].vertices: found 4 from 15"));
    EXPECT_THAT(refusal(hand_made_map().face(0, 1, 0, 3, 0, 6).bytes()),
                HasSubstr("faces[4].mesh vertices: found 3"));
    EXPECT_THAT(refusal(hand_made_map().face(0, 1, 0, 4, 0, 5).bytes()), HasSubstr("three a triangle"));
    EXPECT_THAT(refusal(hand_made_map().face(0, 1, 0, 4, 0x7fffffff, 0x7fffffff).bytes()),
                HasSubstr("a part of 6"));
    EXPECT_THAT(refusal(hand_made_map().put(BspText::leaf_brushes, 1).bytes()),
                HasSubstr("leaf brushes[1].brush"));
    EXPECT_THAT(refusal(hand_made_map().model(0, 1).bytes()),
                HasSubstr("models[1].faces: found 5 with the models"));
}

TEST(Bsp, PatchesNeedOddSizesThatMatchTheirPoints) {
    EXPECT_THAT(refusal(hand_made_map().face(2, 2, 8, 8, 0, 0, 4, 2).bytes()),
                HasSubstr("size: found 4 x 2"));
    EXPECT_THAT(refusal(hand_made_map().face(2, 2, 8, 9, 0, 0, 65537, 65537).bytes()),
                HasSubstr("size: found 65537"));
    EXPECT_THAT(refusal(hand_made_map().face(2, 2, 8, 9, 0, 0, 3, 5).bytes()), HasSubstr("expected 3 x 5"));
}

TEST(Bsp, NodesFormATreeOrAreRefused) {
    const std::array<std::int32_t, 6> box{};
    EXPECT_THAT(refusal(hand_made_map().put(BspText::nodes, 0, 1, -1, box).bytes()),
                HasSubstr("nodes[1].children: found 1"));
    EXPECT_THAT(refusal(hand_made_map().put(BspText::nodes, 0, -1, -3, box).bytes()),
                HasSubstr("one of 2 leaves"));
    const auto shared = hand_made_map().put(BspText::nodes, 0, 2, 2, box).put(BspText::nodes, 0, -1, -1, box);
    EXPECT_THAT(refusal(shared.bytes()), HasSubstr("nodes[1].children: found 2"));
}

TEST(Bsp, NumbersThatAreNoneOrTooLargeAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(refusal(hand_made_map().vertex({0, nan, 0}, {0, 0, 1}).bytes()),
                HasSubstr("vertices[17].position: found nan"));
    EXPECT_THAT(refusal(hand_made_map().vertex({0, 2e6f, 0}, {0, 0, 1}).bytes()),
                HasSubstr("vertices[17].position"));
    EXPECT_THAT(refusal(hand_made_map().vertex({}, {0, 0, nan}).bytes()), HasSubstr("vertices[17].normal"));
}

TEST(Bsp, EntityTextIsReadByThePairAndRefusedWithItsLine) {
    const auto entities = read_entities("{\n\"a\" \"1 {2}\"\n\"b\" \"\"\n} {}", "m");
    ASSERT_EQ(entities.size(), 2u);
    EXPECT_EQ(entities[0].value("a"), "1 {2}");
    EXPECT_TRUE(entities[1].pairs.empty());
    for (const char* damaged :
         {"{\n\"a\" \"1", "{\n\"a\" }", "{\n\"a\" \"1\"", "{\n{", "{\nword", "\n\"a\""}) {
        try {
            read_entities(damaged, "m");
            ADD_FAILURE() << damaged;
        } catch (const trace::DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr("m: entities, line 2: found")) << damaged;
        }
    }
}

}  // namespace
}  // namespace regather::imports
