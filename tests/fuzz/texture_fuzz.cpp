// JPEG, PNG and Targa, told apart by their first bytes.
#include "imports/texture.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return regather::fuzz::read_or_refuse([&] {
        regather::imports::read_texture({data, size}, "texture.tga");
    });
}
