#include "imports/homes/vocabulary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "trace/text.h"

namespace regather::imports {

namespace {

/// Names between blanks: attributes, and elements in <>.
struct Words {
    std::string_view read;   ///< By imports/homes/home.cpp.
    std::string_view plain;  ///< Of the plan, the catalogue, the program: not seen in a picture.
};

// By the grammar in the comment of Sweet Home 3D's class HomeXMLHandler (version 6.4) and what 7.0 writes
// besides.
constexpr Words piece{
    "name catalogId model level visible modelMirrored x y elevation angle pitch roll width depth height "
    "modelRotation "
    "modelCenteredAtOrigin color shininess doorOrWindow <material>",
    "id movable description nameVisible nameAngle nameXOffset nameYOffset price dropOnTopElevation "
    "information license icon "
    "planIcon modelSize resizable deformable texturable horizontallyRotatable widthInPlan depthInPlan "
    "heightInPlan creator "
    "valueAddedTaxPercentage currency backFaceShown <property> <textStyle>"};
constexpr Words camera{"attribute name x y z yaw pitch fieldOfView lens",
                       "id time fixedSize renderer <property>"};
constexpr std::string_view pieces = "<pieceOfFurniture> <doorOrWindow> <light> <shelfUnit> <furnitureGroup>";

struct Entry {
    std::string_view element;
    Words own, shared;
};
constexpr std::array entries{
    Entry{"home",
          {"name wallHeight <property> <environment> <camera> <observerCamera> <level> <wall> <room>",
           "version camera selectedLevel basePlanLocked furnitureSortedProperty furnitureDescendingSorted "
           "<furnitureVisibleProperty> <print>"},
          {pieces, ""}},
    Entry{"property", {"name value", "type"}, {}},
    Entry{"environment",
          {"",
           "observerCameraElevationAdjusted allLevelsVisible drawingMode subpartSizeUnderLight photoWidth "
           "photoHeight "
           "photoAspectRatio photoQuality videoWidth videoAspectRatio videoQuality videoSpeed videoFrameRate "
           "<property>"},
          {}},
    Entry{"camera", {}, camera}, Entry{"observerCamera", {}, camera},
    Entry{"level", {"id elevation height viewable visible", "name elevationIndex <property>"}, {}},
    Entry{"wall",
          {"id level wallAtStart wallAtEnd xStart yStart xEnd yEnd height heightAtEnd thickness arcExtent "
           "topColor "
           "leftSideColor leftSideShininess rightSideColor rightSideShininess",
           "pattern <property>"},
          {}},
    Entry{"room",
          {"name level floorVisible floorColor floorShininess ceilingVisible ceilingColor ceilingShininess "
           "<point>",
           "id nameAngle nameXOffset nameYOffset areaVisible areaAngle areaXOffset areaYOffset <textStyle> "
           "<property>"},
          {}},
    Entry{"point", {"x y", ""}, {}}, Entry{"pieceOfFurniture", {}, piece}, Entry{"shelfUnit", {}, piece},
    Entry{"light", {"power <lightSource>", ""}, piece},
    Entry{"lightSource", {"x y z color diameter", ""}, {}},
    Entry{
        "doorOrWindow",
        {"wallThickness wallDistance wallWidth wallLeft wallHeight wallTop cutOutShape wallCutOutOnBothSides",
         "widthDepthDeformable boundToWall <sash>"},
        piece},
    Entry{"material", {"name color shininess", "key"}, {}},
    // Its pieces have places of their own in the plan; what it says of itself repeats them.
    Entry{"furnitureGroup",
          {"visible", "name catalogId level x y elevation angle width depth height modelMirrored"},
          {pieces, piece.plain}}};

const Entry* entry_of(std::string_view element) {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.element == element; });
    return found == entries.end() ? nullptr : &*found;
}

bool has_word(std::string_view words, std::string_view word) {
    for (std::size_t at = words.find(word); at != std::string_view::npos; at = words.find(word, at + 1))
        if ((at == 0 || words[at - 1] == ' ') &&
            (at + word.size() == words.size() || words[at + word.size()] == ' '))
            return true;
    return false;
}

class Counter {
public:
    Counter(const XmlDocument& home, LeftOut& left_out) : home_(home), left_out_(left_out) {}

    // In the document's order, without recursion: it may be nested as deeply as it likes.
    void count() {
        const pugi::xml_node root = home_.root().node();
        pugi::xml_node node = root;
        while (node) {
            if (enters(node, root) && node.first_child()) {
                node = node.first_child();
                continue;
            }
            while (node != root && !node.next_sibling()) node = node.parent();
            if (node == root) return;
            node = node.next_sibling();
        }
    }

private:
    bool enters(pugi::xml_node node, pugi::xml_node root) {
        if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata)
            left_out_.add(fmt::format("of {}", node.parent().name()), "text between elements");
        if (node.type() != pugi::node_element) return false;
        check_attributes(node);
        if (node != root &&
            !told(entry_of(node.parent().name()), node.parent().name(), fmt::format("<{}>", node.name())))
            return false;
        const Entry* entry = entry_of(node.name());
        if (entry == nullptr) return false;
        for (const pugi::xml_attribute attribute : node.attributes())
            told(entry, node.name(), attribute.name());
        return true;
    }

    // Whether it is read; what is not is counted.
    bool told(const Entry* entry, std::string_view element, std::string_view name) {
        if (has_word(entry->own.read, name) || has_word(entry->shared.read, name)) return true;
        if (has_word(entry->own.plain, name) || has_word(entry->shared.plain, name))
            left_out_.add("as not seen", name);
        else
            left_out_.add(fmt::format("of {}", element), name);
        return false;
    }

    void check_attributes(pugi::xml_node node) {
        names_.clear();
        for (const pugi::xml_attribute attribute : node.attributes()) names_.emplace_back(attribute.name());
        std::sort(names_.begin(), names_.end());
        const auto twice = std::adjacent_find(names_.begin(), names_.end());
        if (twice != names_.end())
            Element(node, trace::shown(node.name(), 40), home_)
                .fail(fmt::format("the attribute {} twice", trace::in_quotes(*twice)), "each attribute once");
    }

    const XmlDocument& home_;
    LeftOut& left_out_;
    std::vector<std::string_view> names_;
};

}  // namespace

void count_left_out(const XmlDocument& home, LeftOut& left_out) {
    Counter(home, left_out).count();
}

}  // namespace regather::imports
