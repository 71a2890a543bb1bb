// Shader scripts of Quake III Arena and OpenArena.
#include "imports/maps/shader_script.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return regather::fuzz::read_or_refuse([&] {
        regather::imports::read_shader_scripts({reinterpret_cast<const char*>(data), size}, "script");
    });
}
