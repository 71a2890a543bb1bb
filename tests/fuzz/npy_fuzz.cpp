// Any bytes as a column of each type: its rows are read to the last byte.
#include "trace/npy.h"

#include "tests/fuzz/input.h"

namespace {

template <class T>
void read(const std::filesystem::path& path) {
    regather::fuzz::read_or_refuse([&] {
        const regather::trace::MappedColumn column(path, regather::trace::column_type<T>());
        const std::span<const T> rows = column.rows<T>();
        if (reinterpret_cast<std::uintptr_t>(rows.data()) % alignof(T) != 0) std::abort();
        if (rows.size() != column.size() || column.checksum() != column.checksum()) std::abort();
    });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::filesystem::path path = regather::fuzz::file_of(data, size, "column.npy");
    read<std::uint8_t>(path);
    read<std::uint32_t>(path);
    read<std::uint64_t>(path);
    read<float>(path);
    read<regather::trace::Vec3>(path);
    read<regather::trace::Photon>(path);
    return 0;
}
