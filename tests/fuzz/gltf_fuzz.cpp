// glTF and GLB files. The buffer that one names is there: 96 bytes of a box's corners and some small numbers.
#include "meshes/mesh.h"
#include "tests/fuzz/input.h"

using namespace regather;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        meshes::parse_mesh(meshes::Format::gltf,
                           {.bytes = {reinterpret_cast<const char*>(data), size},
                            .file = "t.gltf",
                            .stem = "t",
                            .has_beside = [](const std::string& name) { return name == "b.bin"; },
                            .read_beside = [](const std::string&) -> meshes::Neighbour {
                                std::string bytes(168, '\0');
                                for (std::size_t i = 3; i < 96; i += 8) bytes[i] = '\x40';
                                for (std::size_t i = 96; i < 168; i += 2) bytes[i] = static_cast<char>(i % 8);
                                return {"b.bin", bytes};
                            }});
    });
}
