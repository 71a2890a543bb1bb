// Any bytes as a scene file, but for numbers of four digits and exponents: they ask for millions of
// triangles.
#include "scenes/loader.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    int digits = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const bool digit = data[i] >= '0' && data[i] <= '9';
        if (digits > 0 && (data[i] == 'e' || data[i] == 'E')) return 0;
        digits = digit ? digits + 1 : 0;
        if (digits >= 4) return 0;
    }
    return regather::fuzz::read_or_refuse([&] {
        const regather::scenes::Scene scene =
            regather::scenes::parse_scene({reinterpret_cast<const char*>(data), size}, "scene", "/nowhere");
        for (const auto& triangle : scene.triangles)
            for (const std::uint32_t vertex : triangle)
                if (vertex >= scene.vertices.size()) std::abort();
    });
}
