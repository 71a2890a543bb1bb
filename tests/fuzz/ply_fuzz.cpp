// PLY files.
#include "meshes/mesh.h"
#include "tests/fuzz/input.h"

using namespace regather;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        meshes::parse_mesh(
            meshes::Format::ply,
            {.bytes = {reinterpret_cast<const char*>(data), size}, .file = "t.ply", .stem = "t"});
    });
}
