#include "imports/homes/home.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <pugixml.hpp>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {

using trace::DataError;
using trace::in_quotes;

namespace {

constexpr double most_radians = 1000;

std::string plain_line(const char* text) {
    std::string line(text);
    if (line.size() > 200) line.resize(200);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 32) c = ' ';
    return line;
}

// An element of the XML, and where it stands ("wall[3]") for errors.
class Element {
public:
    Element(pugi::xml_node node, std::string place, const std::string& file)
        : node_(node), place_(std::move(place)), file_(&file) {}

    [[noreturn]] void fail(std::string_view field, std::string_view found, std::string_view expected) const {
        throw DataError(
            fmt::format("{}: {}.{}: found {}, expected {}", *file_, place_, field, found, expected));
    }

    bool has(const char* field) const { return !node_.attribute(field).empty(); }
    std::string text(const char* field) const { return plain_line(node_.attribute(field).value()); }
    bool truth(const char* field, bool otherwise) const {
        const std::string_view value = node_.attribute(field).value();
        return value.empty() ? otherwise : value == "true";
    }

    /// In [low, high]; `otherwise` when it is not there, which is an error when there is none.
    double number(const char* field, double low, double high, std::optional<double> otherwise = {}) const {
        if (!has(field)) {
            if (otherwise) return *otherwise;
            fail(field, "nothing", "a number");
        }
        return parsed(field, node_.attribute(field).value(), low, high);
    }
    double centimetres(const char* field, std::optional<double> otherwise = {}) const {
        return number(field, -most_home_centimetres, most_home_centimetres, otherwise);
    }
    double extent(const char* field, std::optional<double> otherwise = {}) const {
        return number(field, 0, most_home_centimetres, otherwise);
    }
    double radians(const char* field, std::optional<double> otherwise = {}) const {
        return number(field, -most_radians, most_radians, otherwise);
    }
    std::optional<double> share(const char* field) const {
        return has(field) ? std::optional(number(field, 0, 1)) : std::nullopt;
    }

    /// Eight hexadecimal digits: alpha, red, green, blue.
    std::optional<Rgb8> color(const char* field) const {
        if (!has(field)) return {};
        const std::string_view digits = node_.attribute(field).value();
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
        if (error != std::errc{} || end != digits.data() + digits.size())
            fail(field, in_quotes(digits), "a colour of eight hexadecimal digits");
        return Rgb8{static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
                    static_cast<std::uint8_t>(value)};
    }

    std::optional<std::array<double, 9>> rotation(const char* field) const {
        if (!has(field)) return {};
        std::string_view rest = node_.attribute(field).value();
        std::array<double, 9> rows{};
        for (double& value : rows) {
            const std::size_t start = std::min(rest.find_first_not_of(' '), rest.size());
            rest.remove_prefix(start);
            const std::size_t length = std::min(rest.find(' '), rest.size());
            value = parsed(field, rest.substr(0, length), -1.001, 1.001);
            rest.remove_prefix(length);
        }
        return rows;
    }

    pugi::xml_node node() const { return node_; }
    const std::string& place() const { return place_; }
    Element child(pugi::xml_node node, std::size_t index) const {
        return {node, fmt::format("{}.{}[{}]", place_, node.name(), index), *file_};
    }

private:
    double parsed(const char* field, std::string_view text, double low, double high) const {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || !(value >= low && value <= high))
            fail(field, in_quotes(text), fmt::format("a number from {} to {}", low, high));
        return value;
    }

    pugi::xml_node node_;
    std::string place_;
    const std::string* file_;
};

class Reader {
public:
    explicit Reader(const std::string& file) : file_(file) {}

    Home read(pugi::xml_node root) {
        const Element home(root, "home", file_);
        home_.name = home.text("name");
        home_.wall_height = home.extent("wallHeight", 250);
        for (const pugi::xml_node property : root.children("property")) {
            const std::string_view name = property.attribute("name").value();
            const std::string value = plain_line(property.attribute("value").value());
            if (name == "Author") home_.author = value;
            if (name == "Copyright") home_.copyright = value;
            if (name == "License") home_.licence = value;
        }
        read_children(root, 0);
        return std::move(home_);
    }

private:
    void read_children(pugi::xml_node parent, int depth) {
        for (const pugi::xml_node node : parent.children()) {
            const std::string_view tag = node.name();
            const Element element(node, fmt::format("{}[{}]", tag, index_of(tag)), file_);
            if (tag == "level") add(home_.levels, read_level(element), element);
            if (tag == "wall") add(home_.walls, read_wall(element), element);
            if (tag == "room") add(home_.rooms, read_room(element), element);
            if (tag == "observerCamera" || tag == "camera") add(home_.cameras, read_camera(element), element);
            if (tag == "pieceOfFurniture" || tag == "doorOrWindow" || tag == "light")
                add(home_.pieces, read_piece(element), element);
            if (tag == "furnitureGroup" && element.truth("visible", true)) {
                if (depth >= most_group_depth)
                    element.fail("furnitureGroup", fmt::format("a group {} deep", depth + 1),
                                 fmt::format("at most {}", most_group_depth));
                read_children(node, depth + 1);
            }
        }
    }

    // Of the next element with that tag, by what was read before it.
    std::size_t index_of(std::string_view tag) const {
        if (tag == "level") return home_.levels.size();
        if (tag == "wall") return home_.walls.size();
        if (tag == "room") return home_.rooms.size();
        if (tag == "observerCamera" || tag == "camera") return home_.cameras.size();
        return home_.pieces.size();
    }

    template <class T>
    static void add(std::vector<T>& list, T&& item, const Element& element) {
        if (list.size() >= most_home_items)
            element.fail("count", fmt::format("more than {}", most_home_items), "fewer");
        list.push_back(std::move(item));
    }

    static HomeLevel read_level(const Element& e) {
        HomeLevel level;
        level.id = e.text("id");
        level.elevation = e.centimetres("elevation");
        level.height = e.extent("height");
        level.viewable = e.truth("viewable", true);
        return level;
    }

    HomeWall read_wall(const Element& e) const {
        HomeWall wall;
        wall.id = e.text("id");
        wall.at_start = e.text("wallAtStart");
        wall.at_end = e.text("wallAtEnd");
        wall.level = e.text("level");
        wall.start = {e.centimetres("xStart"), e.centimetres("yStart")};
        wall.end = {e.centimetres("xEnd"), e.centimetres("yEnd")};
        wall.height = e.extent("height", home_.wall_height);
        wall.height_at_end = e.extent("heightAtEnd", wall.height);
        wall.thickness = e.extent("thickness");
        wall.arc_extent = e.radians("arcExtent", 0);
        wall.left = e.color("leftSideColor");
        wall.right = e.color("rightSideColor");
        wall.top = e.color("topColor");
        wall.left_shininess = e.share("leftSideShininess").value_or(0);
        wall.right_shininess = e.share("rightSideShininess").value_or(0);
        return wall;
    }

    static HomeRoom read_room(const Element& e) {
        HomeRoom room;
        room.name = e.text("name");
        room.level = e.text("level");
        room.floor = e.color("floorColor");
        room.ceiling = e.color("ceilingColor");
        room.floor_shininess = e.share("floorShininess").value_or(0);
        room.ceiling_shininess = e.share("ceilingShininess").value_or(0);
        room.floor_visible = e.truth("floorVisible", true);
        room.ceiling_visible = e.truth("ceilingVisible", true);
        for (const pugi::xml_node point : e.node().children("point")) {
            const Element p = e.child(point, room.points.size());
            add(room.points, PlanPoint{p.centimetres("x"), p.centimetres("y")}, p);
        }
        if (room.points.size() < 3)
            e.fail("point", fmt::format("{} points", room.points.size()), "at least 3");
        return room;
    }

    static HomePiece read_piece(const Element& e) {
        HomePiece piece;
        piece.name = e.text("name");
        piece.catalogue_id = e.text("catalogId");
        piece.model = e.node().attribute("model").value();
        piece.level = e.text("level");
        piece.visible = e.truth("visible", true);
        piece.mirrored = e.truth("modelMirrored", false);
        piece.x = e.centimetres("x");
        piece.y = e.centimetres("y");
        piece.elevation = e.centimetres("elevation", 0);
        piece.angle = e.radians("angle", 0);
        piece.pitch = e.radians("pitch", 0);
        piece.roll = e.radians("roll", 0);
        piece.width = e.extent("width");
        piece.depth = e.extent("depth");
        piece.height = e.extent("height");
        piece.model_rotation = e.rotation("modelRotation");
        piece.color = e.color("color");
        piece.shininess = e.share("shininess");
        if (piece.model.empty()) e.fail("model", "nothing", "the name of a model in the archive");
        for (const pugi::xml_node node : e.node().children("material")) {
            const Element m = e.child(node, piece.materials.size());
            add(piece.materials, HomeMaterial{m.text("name"), m.color("color"), m.share("shininess")}, m);
        }
        if (std::string_view(e.node().name()) == "doorOrWindow")
            piece.opening =
                HomeOpening{e.share("wallThickness").value_or(1), e.number("wallDistance", -1, 1, 0)};
        if (std::string_view(e.node().name()) == "light") {
            piece.power = e.number("power", 0, 1, 0.5);
            for (const pugi::xml_node node : e.node().children("lightSource")) {
                const Element s = e.child(node, piece.light_sources.size());
                HomeLightSource source;
                source.x = s.number("x", -10, 10);
                source.y = s.number("y", -10, 10);
                source.z = s.number("z", -10, 10);
                source.diameter = s.number("diameter", 0, 10, 0);
                source.color = s.color("color").value_or(source.color);
                add(piece.light_sources, std::move(source), s);
            }
        }
        return piece;
    }

    static HomeCamera read_camera(const Element& e) {
        HomeCamera camera;
        camera.attribute = e.text("attribute");
        camera.name = e.text("name");
        camera.x = e.centimetres("x");
        camera.y = e.centimetres("y");
        camera.z = e.centimetres("z");
        camera.yaw = e.radians("yaw");
        camera.pitch = e.radians("pitch");
        camera.field_of_view = e.number("fieldOfView", 0.01, 3.1);
        return camera;
    }

    const std::string& file_;
    Home home_;
};

}  // namespace

Home read_home(std::span<const std::uint8_t> xml, const std::string& file) {
    pugi::xml_document document;
    // pugixml knows the five entities of XML only: a document cannot make itself larger than it is.
    const pugi::xml_parse_result result = document.load_buffer(xml.data(), xml.size());
    if (!result)
        throw DataError(fmt::format("{}: byte {}: found damaged XML ({}), expected a home", file,
                                    result.offset, result.description()));
    const pugi::xml_node root = document.child("home");
    if (!root)
        throw DataError(fmt::format("{}: found the root element {}, expected home", file,
                                    in_quotes(document.document_element().name())));
    return Reader(file).read(root);
}

}  // namespace regather::imports
