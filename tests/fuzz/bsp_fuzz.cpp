// Maps of Quake III Arena and OpenArena, with the entities of their text.
#include "imports/maps/bsp.h"

#include "imports/maps/entity_keys.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace imports = regather::imports;
    const auto count = [](std::span<const imports::BspEntity> entities, imports::LeftOut left_out) {
        imports::count_left_out(entities, left_out);
        left_out.lines();
    };
    regather::fuzz::read_or_refuse([&] {
        const imports::Bsp bsp = imports::read_bsp({data, size}, "map");
        count(bsp.entities, bsp.left_out);
    });
    return regather::fuzz::read_or_refuse([&] {
        count(imports::read_entities({reinterpret_cast<const char*>(data), size}, "map"), {});
    });
}
