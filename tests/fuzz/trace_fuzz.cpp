// Any bytes as the trace.json of a folder with empty columns.
#include "tests/column.h"
#include "tests/fuzz/input.h"
#include "trace/folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace regather;
    const std::filesystem::path folder = fuzz::file_of(data, size, "trace.json").parent_path();
    static const bool written = [&] {
        write_column<trace::Photon>(folder / "photon.npy", {});
        write_column<trace::Vec3>(folder / "query_position.npy", {});
        write_column<std::uint32_t>(folder / "query_pixel.npy", {});
        write_column<std::uint32_t>(folder / "query_walk_bytes.npy", {});
        write_column<std::uint8_t>(folder / "walk.npy", {});
        return true;
    }();
    return fuzz::read_or_refuse([&] {
        trace::TraceReader reader(folder);
        const trace::TraceInfo& info = reader.info();
        if (info.image_width == 0 || info.image_height == 0 || !written) std::abort();
        if (info.k == 0 && reader.has("photon")) std::abort();
        reader.verify_all();
        reader.checksum();
    });
}
