#include "imports/homes/home.h"

#include <fmt/format.h>

#include <set>

#include "imports/homes/element.h"
#include "imports/homes/vocabulary.h"
#include "trace/text.h"

namespace regather::imports {

using trace::in_quotes;

namespace {

constexpr double most_radians = 1000;
constexpr std::string_view rectangle = "M0,0 v1 h1 v-1 z";

double centimetres(const Element& e, const char* field, std::optional<double> otherwise = {}) {
    return e.number(field, -most_home_centimetres, most_home_centimetres, otherwise);
}
double extent(const Element& e, const char* field, std::optional<double> otherwise = {}) {
    return e.number(field, 0, most_home_centimetres, otherwise);
}
double radians(const Element& e, const char* field, std::optional<double> otherwise = {}) {
    return e.number(field, -most_radians, most_radians, otherwise);
}

class HomeReader {
public:
    explicit HomeReader(const XmlDocument& document) : document_(document) {}

    Home read() {
        const Element home = document_.root();
        home_.name = home.text("name");
        home_.wall_height = extent(home, "wallHeight", 250);
        std::size_t number = 0;
        for (const pugi::xml_node node : home.node().children("property")) {
            const Element property = home.child(node, number++);
            const std::string_view name = property.raw("name");
            if (name == "Author")
                home_.author = property.text("value");
            else if (name == "Copyright")
                home_.copyright = property.text("value");
            else if (name == "License")
                home_.licence = property.text("value");
            else
                home_.left_out.add("as not seen", "<property>");
        }
        for (const pugi::xml_node node : home.node().children("level")) {
            const Element level = home.child(node, home_.levels.size());
            add(home_.levels, read_level(level), level);
            if (!levels_.insert(home_.levels.back().id).second)
                level.fail("id", in_quotes(level.raw("id")), "another one than the levels before");
        }
        read_children(home.node(), 0);
        count_left_out(document_, home_.left_out);
        return std::move(home_);
    }

private:
    void read_children(pugi::xml_node parent, int depth) {
        for (const pugi::xml_node node : parent.children()) {
            const std::string_view tag = node.name();
            const Element element(node, fmt::format("{}[{}]", trace::shown(tag, 40), index_of(tag)),
                                  document_);
            if (tag == "wall") add(home_.walls, read_wall(element), element);
            if (tag == "room") add(home_.rooms, read_room(element), element);
            if (tag == "observerCamera" || tag == "camera") add(home_.cameras, read_camera(element), element);
            if (tag == "pieceOfFurniture" || tag == "doorOrWindow" || tag == "light" || tag == "shelfUnit")
                add(home_.pieces, read_piece(element), element);
            if (tag == "furnitureGroup" && element.truth("visible", true)) {
                if (depth >= most_group_depth)
                    element.fail(fmt::format("a group {} deep", depth + 1),
                                 fmt::format("at most {}", most_group_depth));
                read_children(node, depth + 1);
            }
        }
    }

    // Of the next element with that tag, by what was read before it.
    std::size_t index_of(std::string_view tag) const {
        if (tag == "wall") return home_.walls.size();
        if (tag == "room") return home_.rooms.size();
        if (tag == "observerCamera" || tag == "camera") return home_.cameras.size();
        return home_.pieces.size();
    }

    template <class T>
    static void add(std::vector<T>& list, T&& item, const Element& element) {
        if (list.size() >= most_home_items)
            element.fail(fmt::format("more than {} of them", most_home_items), "fewer");
        list.push_back(std::move(item));
    }

    HomeLevel read_level(const Element& e) {
        HomeLevel level;
        level.id = e.raw("id");
        level.elevation = centimetres(e, "elevation");
        level.height = extent(e, "height");
        level.viewable = e.truth("viewable", true);
        if (!e.truth("visible", true)) home_.left_out.add("of level", "visible='false' (taken all the same)");
        return level;
    }

    HomeWall read_wall(const Element& e) {
        HomeWall wall;
        wall.id = e.raw("id");
        wall.at_start = e.raw("wallAtStart");
        wall.at_end = e.raw("wallAtEnd");
        wall.level = level_of(e);
        wall.start = {centimetres(e, "xStart"), centimetres(e, "yStart")};
        wall.end = {centimetres(e, "xEnd"), centimetres(e, "yEnd")};
        wall.height = extent(e, "height", home_.wall_height);
        wall.height_at_end = extent(e, "heightAtEnd", wall.height);
        wall.thickness = extent(e, "thickness");
        wall.arc_extent = radians(e, "arcExtent", 0);
        wall.left = e.color("leftSideColor");
        wall.right = e.color("rightSideColor");
        wall.top = e.color("topColor");
        wall.left_shininess = e.share("leftSideShininess").value_or(0);
        wall.right_shininess = e.share("rightSideShininess").value_or(0);
        return wall;
    }

    HomeRoom read_room(const Element& e) {
        HomeRoom room;
        room.name = e.text("name");
        room.level = level_of(e);
        room.floor = e.color("floorColor");
        room.ceiling = e.color("ceilingColor");
        room.floor_shininess = e.share("floorShininess").value_or(0);
        room.ceiling_shininess = e.share("ceilingShininess").value_or(0);
        room.floor_visible = e.truth("floorVisible", true);
        room.ceiling_visible = e.truth("ceilingVisible", true);
        for (const pugi::xml_node point : e.node().children("point")) {
            const Element p = e.child(point, room.points.size());
            if (room.points.size() == most_room_points)
                e.fail(fmt::format("more than {} points", most_room_points), "fewer");
            room.points.push_back({centimetres(p, "x"), centimetres(p, "y")});
        }
        if (room.points.size() < 3) e.fail(fmt::format("{} points", room.points.size()), "at least 3");
        return room;
    }

    HomePiece read_piece(const Element& e) {
        HomePiece piece;
        piece.name = e.text("name");
        piece.catalogue_id = e.text("catalogId");
        piece.model = e.raw("model");
        piece.level = level_of(e);
        piece.visible = e.truth("visible", true);
        piece.mirrored = e.truth("modelMirrored", false);
        piece.x = centimetres(e, "x");
        piece.y = centimetres(e, "y");
        piece.elevation = centimetres(e, "elevation", 0);
        piece.angle = radians(e, "angle", 0);
        piece.pitch = radians(e, "pitch", 0);
        piece.roll = radians(e, "roll", 0);
        piece.width = extent(e, "width");
        piece.depth = extent(e, "depth");
        piece.height = extent(e, "height");
        piece.model_rotation = e.rotation("modelRotation");
        piece.model_centred = e.truth("modelCenteredAtOrigin", true);
        piece.color = e.color("color");
        piece.shininess = e.share("shininess");
        if (piece.model.empty()) e.fail("model", "nothing", "the name of a model in the archive");
        for (const pugi::xml_node node : e.node().children("material")) {
            const Element m = e.child(node, piece.materials.size());
            add(piece.materials,
                HomeMaterial{std::string(m.raw("name")), m.color("color"), m.share("shininess")}, m);
        }
        if (e.name() == "doorOrWindow")
            piece.opening = read_opening(e);
        else if (e.truth("doorOrWindow", false))
            piece.opening = HomeOpening{};
        if (e.name() == "light") {
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

    HomeOpening read_opening(const Element& e) {
        HomeOpening opening;
        opening.wall_thickness = e.number("wallThickness", 0, 100, 1);
        opening.wall_distance = e.number("wallDistance", -100, 100, 0);
        opening.wall_width = e.number("wallWidth", 0, 100, 1);
        opening.wall_left = e.number("wallLeft", -100, 100, 0);
        opening.wall_height = e.number("wallHeight", 0, 100, 1);
        opening.wall_top = e.number("wallTop", -100, 100, 0);
        opening.on_both_sides = e.truth("wallCutOutOnBothSides", false);
        if (e.has("cutOutShape") && e.raw("cutOutShape") != rectangle)
            home_.left_out.add("of doorOrWindow", "cutOutShape (its rectangle is cut)");
        return opening;
    }

    // "" for none.
    std::string level_of(const Element& e) const {
        const std::string level(e.raw("level"));
        if (!level.empty() && !levels_.contains(level))
            e.fail("level", in_quotes(e.raw("level")), "the id of a level of the home");
        return level;
    }

    HomeCamera read_camera(const Element& e) {
        HomeCamera camera;
        camera.attribute = e.text("attribute");
        camera.name = e.text("name");
        camera.x = centimetres(e, "x");
        camera.y = centimetres(e, "y");
        camera.z = centimetres(e, "z");
        camera.yaw = radians(e, "yaw");
        camera.pitch = radians(e, "pitch");
        camera.field_of_view = e.number("fieldOfView", 0.01, 3.1);
        if (e.has("lens") && e.raw("lens") != "PINHOLE")
            home_.left_out.add(fmt::format("of {}", e.name()), "lens (taken as PINHOLE)");
        if (camera.attribute != "observerCamera" && camera.attribute != "storedCamera")
            home_.left_out.add("of home", fmt::format("<{} attribute='{}'>", e.name(), camera.attribute));
        return camera;
    }

    const XmlDocument& document_;
    std::set<std::string> levels_;
    Home home_;
};

}  // namespace

Home read_home(std::span<const std::uint8_t> xml, const std::string& file) {
    const XmlDocument document(xml, file, "home");
    return HomeReader(document).read();
}

}  // namespace regather::imports
