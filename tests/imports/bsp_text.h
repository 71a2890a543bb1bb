// tests/imports/bsp_text.h -- IBSP 46 files made by hand.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "trace/vec.h"

namespace regather::imports {

/// Bytes of a map, lump by lump; records are appended as the file has them.
class BspText {
public:
    enum Lump {
        entities,
        textures,
        planes,
        nodes,
        leaves,
        leaf_faces,
        leaf_brushes,
        models,
        brushes,
        sides,
        vertices,
        indices,
        effects,
        faces,
        light_maps,
        light_volumes,
        visibility
    };

    template <class... Values>
    BspText& put(Lump lump, Values... values) {
        (append(lumps_[lump], &values, sizeof values), ...);
        return *this;
    }
    BspText& text(std::string_view words) {
        append(lumps_[entities], words.data(), words.size());
        return *this;
    }
    BspText& texture(std::string_view name, std::int32_t flags = 0, std::int32_t contents = 1) {
        std::array<char, 64> field{};
        std::memcpy(field.data(), name.data(), name.size());
        return put(textures, field, flags, contents);
    }
    BspText& vertex(trace::Vec3 p, trace::Vec3 normal) {
        return put(vertices, p, std::array<float, 4>{}, normal, std::uint32_t{0});
    }
    BspText& face(std::int32_t texture, std::int32_t kind, std::int32_t first_vertex,
                  std::int32_t vertex_count, std::int32_t first_index, std::int32_t index_count,
                  std::int32_t width = 0, std::int32_t height = 0) {
        return put(faces, texture, std::int32_t{-1}, kind, first_vertex, vertex_count, first_index,
                   index_count, std::array<std::int32_t, 5>{}, std::array<float, 12>{}, width, height);
    }
    BspText& model(std::int32_t first_face, std::int32_t face_count) {
        return put(models, std::array<float, 6>{}, first_face, face_count, std::int32_t{0}, std::int32_t{0});
    }

    std::vector<std::uint8_t> bytes() const {
        std::vector<std::uint8_t> head, body;
        append(head, "IBSP", 4);
        const std::int32_t version = 46;
        append(head, &version, 4);
        for (const auto& lump : lumps_) {
            const std::array<std::int32_t, 2> place{
                static_cast<std::int32_t>(8 + 8 * lumps_.size() + body.size()),
                static_cast<std::int32_t>(lump.size())};
            append(head, place.data(), 8);
            body.insert(body.end(), lump.begin(), lump.end());
        }
        head.insert(head.end(), body.begin(), body.end());
        return head;
    }

private:
    static void append(std::vector<std::uint8_t>& to, const void* from, std::size_t count) {
        const auto* first = static_cast<const std::uint8_t*>(from);
        to.insert(to.end(), first, first + count);
    }
    std::array<std::vector<std::uint8_t>, 17> lumps_;
};

/// A floor of 512 x 512 units at height 0 that faces up, a lamp of 64 x 64 at height 128 that faces down, a
/// quarter cylinder of radius 64 about (128, 0..64, 0), a solid brush below 0, a spawn point at the centre of
/// the floor.
inline BspText hand_made_map() {
    const trace::Vec3 up{0, 0, 1}, down{0, 0, -1};
    BspText map;
    map.text(
        "{\n\"classname\" \"worldspawn\"\n\"message\" \"By hand\"\n}\n"
        "{\n\"classname\" \"info_player_deathmatch\"\n\"origin\" \"0 0 24\"\n\"angle\" \"90\"\n}\n");
    map.texture("textures/x/stone_floor").texture("textures/x/lamp_2k").texture("textures/x/metal");
    map.put(BspText::planes, up, 0.0f).put(BspText::planes, down, 1024.0f);
    for (const float side : {1.0f, -1.0f}) {
        map.put(BspText::planes, trace::Vec3{side, 0, 0}, 256.0f)
            .put(BspText::planes, trace::Vec3{0, side, 0}, 256.0f);
    }
    map.put(BspText::nodes, 0, -1, -2, std::array<std::int32_t, 6>{});
    map.put(BspText::leaves, 0, 0, std::array<std::int32_t, 6>{}, 0, 0, 0, 0);
    map.put(BspText::leaves, 0, 0, std::array<std::int32_t, 6>{}, 0, 0, 0, 1);
    map.put(BspText::leaf_brushes, 0).put(BspText::brushes, 0, 6, 0);
    for (int plane = 0; plane < 6; ++plane) map.put(BspText::sides, plane, 0);
    for (const auto& [x, y] :
         {std::array{-256.0f, -256.0f}, {256.0f, -256.0f}, {256.0f, 256.0f}, {-256.0f, 256.0f}})
        map.vertex({x, y, 0}, up);
    for (const auto& [x, y] : {std::array{-32.0f, -32.0f}, {32.0f, -32.0f}, {32.0f, 32.0f}, {-32.0f, 32.0f}})
        map.vertex({x, y, 128}, down);
    for (int row = 0; row < 3; ++row)
        for (const trace::Vec3 p : {trace::Vec3{192, 0, 0}, {192, 0, 64}, {128, 0, 64}})
            map.vertex({p.x, 32.0f * static_cast<float>(row), p.z}, {1, 0, 1});
    map.put(BspText::indices, 0, 2, 1, 0, 3, 2);  // Clockwise from above: the reader turns them.
    map.face(0, 1, 0, 4, 0, 6).face(1, 1, 4, 4, 0, 6).face(2, 2, 8, 9, 0, 0, 3, 3).face(0, 4, 0, 0, 0, 0);
    map.model(0, 4);
    return map;
}

}  // namespace regather::imports
