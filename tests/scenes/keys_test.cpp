#include "scenes/keys.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/scenes/scene_text.h"

namespace regather::scenes {
namespace {

std::string between(char mark, std::string_view word) {
    return fmt::format("{0}{1}{0}", mark, word);
}

TEST(Keys, TheFormatsPageNamesEveryKeyAndKind) {
    const char* source = std::getenv("REGATHER_SOURCE_DIR");
    if (source == nullptr) GTEST_SKIP() << "REGATHER_SOURCE_DIR is set by ctest";
    std::ifstream file(std::string(source) + "/docs/scene_format.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    std::vector<Kind> kinds{scene_kind(), camera_kind(), camera_path_kind(), key_frame_kind(), growth_kind()};
    for (const Kind& kind : light_kinds()) kinds.push_back(kind);
    for (const Kind& kind : shape_kinds()) kinds.push_back(kind);
    for (const Kind& kind : material_kinds()) kinds.push_back(kind);
    for (const Kind& kind : kinds) {
        EXPECT_NE(page.find(kind.name), std::string::npos) << kind.name;
        for (const Key& key : kind.keys)
            EXPECT_NE(page.find(between('`', key.name)), std::string::npos) << key.name;
    }
}

// A scene with every key of the format in it, each marked with $ before its name.
const std::string every_key = R"({"$name": "t",
"$camera": {"$position": [0, -3, 1], "$target": [0, 0, 1], "$up": [0, 0, 1], "$vertical_fov_degrees": 50},
"$origin": "here", "$licence": "none",
"$camera_path": {"$frames": 3, "$keys": [{"$frame": 0, "$position": [0, -3, 1], "$target": [0, 0, 1], "$up": [0, 0, 1]},
  {"$frame": 2, "$position": [0, -2, 1], "$target": [0, 0, 1]}]},
"$objects": {"o": [{"$type": "patch", "$material": "a", "$corners": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "$divide": [2, 2]}]},
"$materials": {
  "a": {"$kind": "diffuse", "$diffuse": [0.5, 0.5, 0.5]},
  "b": {"$kind": "glossy", "$diffuse": [0.5, 0.5, 0.5], "$specular": [0.1, 0.1, 0.1], "$exponent": 20},
  "c": {"$kind": "mirror", "$specular": [0.9, 0.9, 0.9]},
  "d": {"$kind": "dielectric", "$index_of_refraction": 1.5}},
"$shapes": [
  {"$type": "quad", "$material": "a", "$corner": [0, 0, 0], "$edge_u": [1, 0, 0], "$edge_v": [0, 1, 0], "$divide": [2, 2]},
  {"$type": "box", "$material": "b", "$min": [0, 0, 0], "$max": [1, 1, 1], "$rotate_z_degrees": 10, "$divide": [1, 2, 3]},
  {"$type": "sphere", "$material": "c", "$center": [0, 0, 0], "$radius": 1, "$segments": 8},
  {"$type": "cylinder", "$material": "a", "$from": [0, 0, 0], "$to": [0, 0, 1], "$radius": 1, "$radius_to": 2, "$segments": 9, "$smooth": true},
  {"$type": "lathe", "$material": "a", "$center": [0, 0, 0], "$profile": [[0, 0], [1, 0], [0, 1]], "$segments": 9, "$smooth": false},
  {"$type": "torus", "$material": "a", "$center": [0, 0, 0], "$axis": [0, 1, 0], "$radius": 2, "$tube": 1, "$segments": 9, "$tube_segments": 8},
  {"$type": "ripple", "$material": "d", "$center": [0, 0, 0], "$size": 2, "$amplitude": 0.1, "$wavelength": 1, "$phase_degrees": 90, "$depth": 1, "$cells": 4},
  {"$type": "terrain", "$material": "a", "$corner": [0, 0, 0], "$size": [2, 3], "$amplitude": 0.1, "$wavelength": 1, "$seed": 1, "$cells": [4, 5],
   "$growth": [{"$objects": ["o"], "$count": 2, "$seed": 1, "$margin": 0.1, "$sink": 0.1, "$scale": [1, 2], "$clear": [[1, 1, 0.2]]}]},
  {"$type": "tuft", "$material": "a", "$center": [0, 0, 0], "$radius": 0.1, "$blades": 2, "$height": 0.2, "$width": 0.01, "$reach": 0.1, "$segments": 3, "$seed": 1},
  {"$type": "instances", "$object": "o", "$at": [[0, 0, 5, 90]]},
  {"$type": "mesh", "materials": {}, "$file": "t.obj"},
  {"$type": "mesh", "$material": "d", "$file": "t.obj", "$up_axis": "y", "$scale": 2, "$rotate_z_degrees": 10, "$translate": [1, 0, 0]}],
"$lights": [
  {"$corner": [0, 0, 3], "$edge_u": [0, 1, 0], "$edge_v": [1, 0, 0], "$power": [1, 1, 1], "$material": "a"},
  {"$type": "rectangle", "$corner": [0, 0, 3], "$edge_u": [0, 1, 0], "$edge_v": [1, 0, 0], "$radiance": [1, 1, 1]},
  {"$type": "sphere", "$center": [0, 0, 3], "$radius": 1, "$segments": 8, "$power": [1, 1, 1]},
  {"$type": "mesh", "$file": "t.obj", "$power": [1, 1, 1]},
  {"$corner": [0, 0, 3], "$edge_u": [0, 1, 0], "$edge_v": [1, 0, 0], "$radiance": [1, 1, 1]}]})";

std::string without_marks(std::string text) {
    text.erase(std::remove(text.begin(), text.end(), '$'), text.end());
    return text;
}

class MisspeltKeys : public ::testing::Test {
protected:
    MisspeltKeys() {
        folder_.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        for (std::size_t at = every_key.find('$'); at != std::string::npos; at = every_key.find('$', at + 1))
            marks_.push_back(at);
    }
    // What the scene is refused with when the key at a mark is spelt otherwise.
    std::string refusal_of(std::size_t mark, const std::string& spelling) const {
        const std::size_t end = every_key.find('"', marks_[mark]);
        return refusal(without_marks(every_key.substr(0, marks_[mark]) + spelling + every_key.substr(end)),
                       folder_.path());
    }
    std::string key(std::size_t mark) const {
        return every_key.substr(marks_[mark] + 1, every_key.find('"', marks_[mark]) - marks_[mark] - 1);
    }

    ScratchFolder folder_;
    std::vector<std::size_t> marks_;
};

TEST_F(MisspeltKeys, TheSceneWithAllKeysIsAccepted) {
    EXPECT_EQ(refusal(without_marks(every_key), folder_.path()), "");
    EXPECT_EQ(marks_.size(), 144u);
}

TEST_F(MisspeltKeys, AnyDeletedCharacterIsRefusedAndTheValidKeyNamed) {
    for (std::size_t mark = 0; mark < marks_.size(); ++mark)
        for (std::size_t i = 0; i < key(mark).size(); ++i) {
            const std::string misspelt = std::string(key(mark)).erase(i, 1);
            const std::string message = refusal_of(mark, misspelt);
            EXPECT_NE(message.find("unknown key " + between('"', misspelt)), std::string::npos) << message;
            EXPECT_NE(message.find(between('"', key(mark))), std::string::npos)
                << misspelt << ": " << message;
        }
}

TEST_F(MisspeltKeys, AnyInsertedCharacterIsRefusedAndTheValidKeyNamed) {
    ASSERT_TRUE(rc::check([this] {
        const std::size_t mark = *rc::gen::inRange<std::size_t>(0, marks_.size());
        std::string misspelt = key(mark);
        misspelt.insert(*rc::gen::inRange<std::size_t>(0, misspelt.size() + 1), 1,
                        *rc::gen::elementOf(std::string("abcdefghijklmnopqrstuvwxyzABC_0123 .-")));
        RC_PRE(misspelt != "materials");  // Of a mesh shape, that is a key, too.
        const std::string message = refusal_of(mark, misspelt);
        RC_LOG() << misspelt << ": " << message;
        RC_ASSERT(message.find("unknown key " + between('"', misspelt)) != std::string::npos);
        RC_ASSERT(message.find(between('"', key(mark))) != std::string::npos);
        RC_ASSERT(message.find('\n') == std::string::npos);
    }));
}

}  // namespace
}  // namespace regather::scenes
