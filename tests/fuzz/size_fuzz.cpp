// Sizes as people write them.
#include "trace/size.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return regather::fuzz::read_or_refuse([&] {
        regather::trace::parse_size({reinterpret_cast<const char*>(data), size});
    });
}
