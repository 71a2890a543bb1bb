// Any bytes as the CSV of a ladder of settings.
#include "study/ladder.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return regather::fuzz::read_or_refuse([&] {
        regather::study::parse_ladder({reinterpret_cast<const char*>(data), size}, "input");
    });
}
