#include "imports/maps/bsp.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <tuple>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {

using trace::in_quotes;

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t header_bytes = 8 + 17 * 8;
constexpr std::uint64_t most_face_elements = 10'000'000;
constexpr std::size_t most_entity_bytes = 16u << 20;
constexpr float largest_coordinate = 1e6f;

struct LumpKind {
    std::size_t index;
    const char* name;
    std::size_t record_bytes;
};
constexpr LumpKind entities_lump{0, "entities", 1}, textures_lump{1, "textures", 72},
    planes_lump{2, "planes", 16}, nodes_lump{3, "nodes", 36}, leaves_lump{4, "leaves", 48},
    leaf_brushes_lump{6, "leaf brushes", 4}, models_lump{7, "models", 40}, brushes_lump{8, "brushes", 12},
    sides_lump{9, "brush sides", 8}, vertices_lump{10, "vertices", 44}, indices_lump{11, "mesh vertices", 4},
    faces_lump{13, "faces", 104};
constexpr std::array unread_lumps{LumpKind{5, "leaf faces", 4}, LumpKind{12, "fogs", 72},
                                  LumpKind{14, "light maps", 128 * 128 * 3}, LumpKind{15, "light volumes", 8},
                                  LumpKind{16, "bytes of visibility", 1}};
constexpr std::array all_lumps{
    entities_lump,     textures_lump, planes_lump,     nodes_lump,      leaves_lump,    unread_lumps[0],
    leaf_brushes_lump, models_lump,   brushes_lump,    sides_lump,      vertices_lump,  indices_lump,
    unread_lumps[1],   faces_lump,    unread_lumps[2], unread_lumps[3], unread_lumps[4]};

// One record of a lump; knows where it stands for the sake of refusals.
class Record {
public:
    Record(const std::uint8_t* bytes, std::string_view file, const LumpKind& lump, std::size_t number)
        : bytes_(bytes), file_(file), lump_(lump), number_(number) {}

    [[noreturn]] void fail(std::string_view field, const std::string& found,
                           const std::string& expected) const {
        throw trace::DataError(fmt::format("{}: {}[{}].{}: found {}, expected {}", file_, lump_.name, number_,
                                           field, found, expected));
    }

    std::int32_t whole(std::size_t offset) const { return at<std::int32_t>(offset); }

    /// An index below `count`.
    std::uint32_t index(std::size_t offset, std::string_view field, std::size_t count) const {
        const std::int32_t value = whole(offset);
        if (value < 0 || static_cast<std::size_t>(value) >= count)
            fail(field, fmt::to_string(value), fmt::format("0 to {} below", count));
        return static_cast<std::uint32_t>(value);
    }

    /// first and count of a run among `available`; an empty run may begin anywhere.
    std::pair<std::uint32_t, std::uint32_t> run(std::size_t offset, std::string_view field,
                                                std::size_t available, std::size_t count_offset) const {
        const std::int64_t first = whole(offset), count = whole(count_offset);
        if (count == 0) return {0, 0};
        if (first < 0 || count < 0 || first + count > static_cast<std::int64_t>(available))
            fail(field, fmt::format("{} from {} on", count, first), fmt::format("a part of {}", available));
        return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)};
    }

    Vec3 triple(std::size_t offset, std::string_view field, float most) const {
        const Vec3 value{at<float>(offset), at<float>(offset + 4), at<float>(offset + 8)};
        for (int axis = 0; axis < 3; ++axis) check(value[axis], field, most);
        return value;
    }

    float number(std::size_t offset, std::string_view field, float most) const {
        const auto value = at<float>(offset);
        check(value, field, most);
        return value;
    }

    template <class Value>
    Value at(std::size_t offset) const {
        Value value;
        std::memcpy(&value, bytes_ + offset, sizeof value);
        return value;
    }

    const char* text(std::size_t offset) const { return reinterpret_cast<const char*>(bytes_ + offset); }

private:
    void check(float value, std::string_view field, float most) const {
        if (!(std::abs(value) <= most))
            fail(field, fmt::to_string(value), fmt::format("a number from {} to {}", -most, most));
    }

    const std::uint8_t* bytes_;
    std::string_view file_;
    const LumpKind& lump_;
    std::size_t number_;
};

class BspReader {
public:
    BspReader(std::span<const std::uint8_t> bytes, std::string_view file) : bytes_(bytes), file_(file) {
        if (bytes.size() < header_bytes)
            refuse("header", fmt::format("{} bytes", bytes.size()), fmt::format("{} or more", header_bytes));
        if (std::memcmp(bytes.data(), "IBSP", 4) != 0)
            refuse("magic", in_quotes({reinterpret_cast<const char*>(bytes.data()), 4}), "\"IBSP\"");
        std::int32_t version;
        std::memcpy(&version, bytes.data() + 4, 4);
        if (version != 46) refuse("version", fmt::to_string(version), "46");
        refuse_shared_bytes();
    }

    std::span<const std::uint8_t> lump(const LumpKind& kind) const {
        std::array<std::int32_t, 2> place;
        std::memcpy(place.data(), bytes_.data() + 8 + 8 * kind.index, 8);
        const std::int64_t offset = place[0], length = place[1];
        if (offset < 0 || length < 0 || offset + length > static_cast<std::int64_t>(bytes_.size()))
            refuse(fmt::format("lump of {}", kind.name), fmt::format("{} bytes at {}", length, offset),
                   fmt::format("a part of the file's {} bytes", bytes_.size()));
        if (static_cast<std::size_t>(length) % kind.record_bytes != 0)
            refuse(fmt::format("lump of {}", kind.name), fmt::format("{} bytes", length),
                   fmt::format("a multiple of {}", kind.record_bytes));
        return bytes_.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
    }

    std::size_t count(const LumpKind& kind) const { return lump(kind).size() / kind.record_bytes; }

    template <class Value, class Read>
    std::vector<Value> records(const LumpKind& kind, Read read) const {
        const auto part = lump(kind);
        std::vector<Value> values;
        values.reserve(part.size() / kind.record_bytes);
        for (std::size_t i = 0; i * kind.record_bytes < part.size(); ++i)
            values.push_back(read(Record(part.data() + i * kind.record_bytes, file_, kind, i)));
        return values;
    }

    [[noreturn]] void refuse(std::string_view field, std::string_view found,
                             std::string_view expected) const {
        throw trace::DataError(fmt::format("{}: {}: found {}, expected {}", file_, field, found, expected));
    }

private:
    void refuse_shared_bytes() const {
        std::vector<std::pair<std::span<const std::uint8_t>, const char*>> lumps;
        for (const LumpKind& kind : all_lumps)
            if (const auto part = lump(kind); !part.empty()) lumps.emplace_back(part, kind.name);
        std::sort(lumps.begin(), lumps.end(),
                  [](const auto& a, const auto& b) { return a.first.data() < b.first.data(); });
        for (std::size_t i = 1; i < lumps.size(); ++i) {
            const auto& [before, before_name] = lumps[i - 1];
            const auto& [part, name] = lumps[i];
            if (before.data() + before.size() > part.data())
                refuse(fmt::format("lump of {}", name),
                       fmt::format("it from byte {} on", part.data() - bytes_.data()),
                       fmt::format("it behind the lump of {}, which ends at {}", before_name,
                                   before.data() + before.size() - bytes_.data()));
        }
    }

    std::span<const std::uint8_t> bytes_;
    std::string_view file_;
};

BspTexture texture(const Record& record) {
    const char* name = record.text(0);
    return {{name, strnlen(name, 64)}, record.at<std::uint32_t>(64), record.at<std::uint32_t>(68)};
}

BspFace face(const Record& record, const Bsp& bsp) {
    BspFace result;
    result.texture = record.index(0, "texture", bsp.textures.size());
    const std::int32_t kind = record.whole(8);
    if (kind < 1 || kind > 4)
        record.fail("type", fmt::to_string(kind), "1 polygon, 2 patch, 3 mesh or 4 billboard");
    result.kind = static_cast<BspFace::Kind>(kind);
    std::tie(result.first_vertex, result.vertex_count) = record.run(12, "vertices", bsp.vertices.size(), 16);
    if (result.kind == BspFace::Kind::patch) {
        const std::int32_t width = record.whole(96), height = record.whole(100);
        const auto sound = [](std::int32_t size) { return size >= 3 && size <= 129 && size % 2 == 1; };
        if (!sound(width) || !sound(height))
            record.fail("size", fmt::format("{} x {}", width, height), "odd numbers from 3 to 129");
        if (static_cast<std::uint32_t>(width * height) != result.vertex_count)
            record.fail("vertices", fmt::to_string(result.vertex_count),
                        fmt::format("{} x {}", width, height));
        result.patch_width = static_cast<std::uint32_t>(width);
        result.patch_height = static_cast<std::uint32_t>(height);
    } else if (result.kind != BspFace::Kind::billboard) {
        std::tie(result.first_index, result.index_count) =
            record.run(20, "mesh vertices", bsp.indices.size(), 24);
        if (result.index_count % 3 != 0)
            record.fail("mesh vertices", fmt::to_string(result.index_count), "three a triangle");
        for (std::uint32_t i = 0; i < result.index_count; ++i)
            if (bsp.indices[result.first_index + i] >= result.vertex_count)
                record.fail("mesh vertices", fmt::to_string(bsp.indices[result.first_index + i]),
                            fmt::format("below the face's {} vertices", result.vertex_count));
    }
    return result;
}

std::vector<BspNode> nodes(const BspReader& reader, const Bsp& bsp) {
    const std::size_t count = reader.count(nodes_lump);
    std::vector<bool> has_parent(count, false);
    std::size_t number = 0;
    return reader.records<BspNode>(nodes_lump, [&](const Record& record) {
        BspNode node{record.index(0, "plane", bsp.planes.size()), {record.whole(4), record.whole(8)}};
        for (const std::int32_t child : node.children) {
            if (child >= 0) {
                const auto index = static_cast<std::size_t>(child);
                if (index <= number || index >= count || has_parent[index])
                    record.fail(
                        "children", fmt::to_string(child),
                        fmt::format("a node from {} to {} below that has no parent yet", number + 1, count));
                has_parent[index] = true;
            } else if (static_cast<std::size_t>(-(child + 1)) >= bsp.leaves.size()) {
                record.fail("children", fmt::to_string(child),
                            fmt::format("one of {} leaves", bsp.leaves.size()));
            }
        }
        ++number;
        return node;
    });
}

}  // namespace

std::string_view BspEntity::value(std::string_view key) const {
    for (const auto& [name, value] : pairs)
        if (name == key) return value;
    return {};
}

Bsp read_bsp(std::span<const std::uint8_t> bytes, std::string_view name) {
    const BspReader reader(bytes, name);
    Bsp bsp;
    const auto text = reader.lump(entities_lump);
    if (text.size() > most_entity_bytes)
        reader.refuse("lump of entities", fmt::format("{} bytes", text.size()),
                      fmt::format("at most {}", most_entity_bytes));
    for (const LumpKind& kind : unread_lumps)
        if (const std::size_t count = reader.count(kind); count > 0)
            bsp.left_out.add("of the map", kind.name, count);
    bsp.entities = read_entities({reinterpret_cast<const char*>(text.data()), text.size()}, name);
    bsp.textures = reader.records<BspTexture>(textures_lump, texture);
    bsp.planes = reader.records<BspPlane>(planes_lump, [](const Record& record) {
        return BspPlane{record.triple(0, "normal", 2), record.number(12, "distance", largest_coordinate)};
    });
    const auto index_below = [](std::size_t count, std::string_view field) {
        return [=](const Record& record) { return record.index(0, field, count); };
    };
    bsp.leaf_brushes =
        reader.records<std::uint32_t>(leaf_brushes_lump, index_below(reader.count(brushes_lump), "brush"));
    bsp.leaves = reader.records<BspLeaf>(leaves_lump, [&](const Record& record) {
        const auto [first, count] = record.run(40, "brushes", bsp.leaf_brushes.size(), 44);
        return BspLeaf{record.whole(0), first, count};
    });
    bsp.nodes = nodes(reader, bsp);
    bsp.side_planes = reader.records<std::uint32_t>(sides_lump, index_below(bsp.planes.size(), "plane"));
    bsp.brushes = reader.records<BspBrush>(brushes_lump, [&](const Record& record) {
        const auto [first, count] = record.run(0, "sides", bsp.side_planes.size(), 4);
        return BspBrush{first, count, record.index(8, "texture", bsp.textures.size())};
    });
    bsp.vertices = reader.records<BspVertex>(vertices_lump, [](const Record& record) {
        return BspVertex{record.triple(0, "position", largest_coordinate), record.triple(28, "normal", 2),
                         record.at<std::array<std::uint8_t, 4>>(40)};
    });
    bsp.indices = reader.records<std::uint32_t>(
        indices_lump, [](const Record& record) { return record.at<std::uint32_t>(0); });
    std::uint64_t elements = 0;
    bsp.faces = reader.records<BspFace>(faces_lump, [&](const Record& record) {
        const BspFace result = face(record, bsp);
        elements += std::max(result.index_count, result.vertex_count);
        if (elements > most_face_elements)
            record.fail("mesh vertices", fmt::format("{} with the faces before", elements),
                        fmt::format("{} at most", most_face_elements));
        return result;
    });
    std::uint64_t model_faces = 0;
    bsp.models = reader.records<BspModel>(models_lump, [&](const Record& record) {
        const auto [first, count] = record.run(24, "faces", bsp.faces.size(), 28);
        model_faces += count;
        if (model_faces > bsp.faces.size())
            record.fail("faces", fmt::format("{} with the models before", model_faces),
                        fmt::format("each of {} in one model", bsp.faces.size()));
        return BspModel{first, count};
    });
    if (bsp.models.empty()) reader.refuse("lump of models", "none", "the world at least");
    return bsp;
}

std::vector<BspEntity> read_entities(std::string_view text, std::string_view name) {
    std::vector<BspEntity> entities;
    bool open = false;
    std::size_t line = 1, i = 0;
    const auto refuse = [&](std::string_view found, std::string_view expected) {
        throw trace::DataError(
            fmt::format("{}: entities, line {}: found {}, expected {}", name, line, found, expected));
    };
    std::vector<std::string> key;  // None or one: the key whose value comes next.
    for (; i < text.size() && text[i] != '\0'; ++i) {
        const char c = text[i];
        if (c == '\n') ++line;
        if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
        if (c == '{' && !open) {
            open = true;
            entities.emplace_back();
        } else if (c == '}' && open && key.empty()) {
            open = false;
        } else if (c == '"' && open) {
            const std::size_t end = text.find_first_of(std::string_view("\"\n\0", 3), i + 1);
            if (end == std::string_view::npos || text[end] != '"')
                refuse("a text without end", "a closing quote");
            std::string word(text.substr(i + 1, end - i - 1));
            i = end;
            if (key.empty()) {
                key.push_back(std::move(word));
            } else {
                entities.back().pairs.emplace_back(std::move(key.back()), std::move(word));
                key.clear();
            }
        } else {
            refuse(in_quotes(text.substr(i, 1)), open ? "\"key\" \"value\" pairs, or }" : "{");
        }
    }
    if (open) refuse("the end", "}");
    return entities;
}

}  // namespace regather::imports
