// Material libraries of OBJ files.
#include "meshes/mtl.h"
#include "tests/fuzz/input.h"

using namespace regather;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        meshes::Notes notes;
        meshes::read_mtl({reinterpret_cast<const char*>(data), size}, "t.mtl", notes);
    });
}
