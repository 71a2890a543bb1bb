// Homes of Sweet Home 3D: the XML, and the walls and rooms that are made of it.
#include <vector>

#include "imports/homes/home.h"
#include "imports/homes/wall.h"
#include "meshes/polygon.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace imports = regather::imports;
    return regather::fuzz::read_or_refuse([&] {
        const imports::Home home = imports::read_home({data, size}, "home");
        home.left_out.lines();
        for (const imports::HomeRoom& room : home.rooms) regather::meshes::triangulate(room.points);
        const std::vector<imports::WallOutline> outlines = imports::wall_outlines(home.walls);
        for (std::size_t w = 0; w < outlines.size(); ++w) {
            const imports::WallHole hole{{{{0, -20}, {90, -20}, {90, 20}, {0, 20}}}, 10, 210, {}};
            imports::extrude(home.walls[w], outlines[w], 0, {&hole, 1});
        }
    });
}
