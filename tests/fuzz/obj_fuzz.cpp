// OBJ files. Every library that one names is there, and describes one material.
#include "meshes/mesh.h"
#include "tests/fuzz/input.h"

using namespace regather;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        meshes::parse_mesh(meshes::Format::obj,
                           {.bytes = {reinterpret_cast<const char*>(data), size},
                            .file = "t.obj",
                            .stem = "t",
                            .has_beside = [](const std::string& name) { return name.size() % 2 == 1; },
                            .read_beside = [](const std::string&) -> meshes::Neighbour {
                                return {"m.mtl", "newmtl red\nKd 1 0 0\n"};
                            }});
    });
}
