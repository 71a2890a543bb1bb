#include "scenes/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scenes/draws.h"

namespace regather::scenes {

namespace {

constexpr std::uint32_t most_places = 1'000'000, most_tries = 1000;
constexpr double least_scale = 1e-6;

bool is_clear(const Growth& growth, double x, double y) {
    return std::none_of(growth.clear.begin(), growth.clear.end(), [&](const Clearing& c) {
        return (x - c.x) * (x - c.x) + (y - c.y) * (y - c.y) < c.radius * c.radius;
    });
}

}  // namespace

Growth read_growth(const Field& node, const Terrain& terrain, const Coordinates& coordinates) {
    const Kind& kind = growth_kind();
    node.check(kind);
    Growth growth;
    for (const Field& object : node["objects"].elements(expected(kind, "objects")))
        growth.objects.push_back(object.text(expected(kind, "objects")));
    if (growth.objects.empty()) node["objects"].fail("an empty list", expected(kind, "objects"));
    growth.count = node["count"].whole(1, most_places, expected(kind, "count"));
    growth.seed = node["seed"].whole(0, std::numeric_limits<std::uint32_t>::max(), expected(kind, "seed"));
    if (node.has("margin")) {
        const double most = std::min(terrain.size[0], terrain.size[1]) / 2;
        growth.margin = node["margin"].number(0, most_metres, expected(kind, "margin"));
        if (!(growth.margin < most))
            node["margin"].fail(fmt::format("{:.6g}", growth.margin),
                                fmt::format("less than half of the terrain's edge, {:.6g}", most));
    }
    if (node.has("sink")) growth.sink = node["sink"].number(0, most_metres, expected(kind, "sink"));
    if (node.has("scale")) {
        const std::string_view wanted = expected(kind, "scale");
        const std::vector<Field> two = node["scale"].elements(wanted);
        if (two.size() != 2) node["scale"].fail(fmt::format("a list of {}", two.size()), wanted);
        growth.scale[0] = two[0].number(least_scale, most_metres, wanted);
        growth.scale[1] = two[1].number(growth.scale[0], most_metres, wanted);
    }
    if (node.has("clear")) {
        const std::string_view wanted = expected(kind, "clear");
        for (const Field& disc : node["clear"].elements(wanted)) {
            const std::vector<Field> three = disc.elements(wanted);
            if (three.size() != 3) disc.fail(fmt::format("a list of {}", three.size()), wanted);
            const auto from_corner = [&](std::size_t axis) {
                return three[axis].number(-most_coordinate, most_coordinate, wanted) -
                       coordinates.origin()[axis] - terrain.corner[static_cast<int>(axis)];
            };
            growth.clear.push_back({from_corner(0), from_corner(1),
                                    three[2].number(0, most_metres, wanted, Field::Ends::open_low)});
        }
    }
    return growth;
}

Place place_of(const Growth& growth, const Terrain& terrain, std::uint32_t number, const Field& node) {
    Draws draws(growth.seed, Draws::Purpose::growth, number);
    for (std::uint32_t tries = 0; tries < most_tries; ++tries) {
        const double x = draws.between(growth.margin, terrain.size[0] - growth.margin),
                     y = draws.between(growth.margin, terrain.size[1] - growth.margin);
        if (!is_clear(growth, x, y)) continue;
        Place place;
        const auto kinds = static_cast<double>(growth.objects.size());
        place.object = static_cast<std::size_t>(draws.between(0, kinds));
        const auto [cosine, sine] = draws.on_circle();
        place.placement.cosine = cosine;
        place.placement.sine = sine;
        place.placement.scale = draws.between(growth.scale[0], growth.scale[1]);
        place.placement.translate = {terrain.corner.x + x, terrain.corner.y + y,
                                     terrain.corner.z + ground_at(terrain, x, y).height - growth.sink};
        return place;
    }
    node.fail(fmt::format("no room for place {} in {} tries", number, most_tries),
              "clearings that leave more of the terrain");
}

}  // namespace regather::scenes
