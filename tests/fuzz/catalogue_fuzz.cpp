// Java properties files, of furniture catalogues.
#include "imports/furniture/furniture_catalogue.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return regather::fuzz::read_or_refuse([&] {
        regather::imports::read_properties({reinterpret_cast<const char*>(data), size}, "catalogue");
    });
}
