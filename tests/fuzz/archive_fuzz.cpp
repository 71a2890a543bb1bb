// Zip archives: every entry is read.
#include "imports/archive.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return regather::fuzz::read_or_refuse([&] {
        const auto zip = regather::imports::Zip::from_bytes({data, data + size}, "archive");
        for (const std::string& name : zip.names()) {
            regather::fuzz::read_or_refuse([&] { zip.read(name, 1 << 20); });
            regather::fuzz::read_or_refuse([&] { zip.read_start(name, 100); });
        }
    });
}
