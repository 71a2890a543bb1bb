// Any bytes as the reference.json of a folder with the moments of one black pixel.
#include "capture/reference/reference.h"

#include "tests/fuzz/input.h"
#include "trace/npy.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace regather;
    const std::filesystem::path folder = fuzz::file_of(data, size, "reference.json").parent_path();
    static const bool written = [&] {
        const trace::ColumnType type{"'<f8'", "6", 48, "float64 x 6"};
        trace::ColumnWriter writer(folder / "moments-2.npy", type);
        const double black[6]{};
        writer.append(std::span<const double>(black));
        writer.finish();
        return true;
    }();
    return fuzz::read_or_refuse([&] {
        const capture::Reference reference = capture::load_reference(folder);
        if (reference.samples != 2 || reference.pixels.size() != 1 || !written) std::abort();
    });
}
