// Any bytes as a machine file: a machine that is read can be built.
#include "cachesim/machines/machine.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace regather;
    return fuzz::read_or_refuse([&] {
        const cachesim::Machine machine =
            cachesim::parse_machine({reinterpret_cast<const char*>(data), size}, "machine");
        std::uint64_t bytes = 0;
        for (const cachesim::LevelConfig& level : machine.levels) bytes += level.cache.geometry.size_bytes;
        if (bytes <= 1 << 24) machine.hierarchy();
    });
}
