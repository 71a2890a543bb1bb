// tests/column.h -- a small column of a trace, written at once.
#pragma once
#include <filesystem>
#include <span>

#include "trace/npy.h"

namespace regather {

template <class T>
trace::ColumnDigest write_column(const std::filesystem::path& path, std::span<const T> rows) {
    trace::ColumnWriter writer(path, trace::column_type<T>());
    writer.append(rows);
    return writer.finish();
}

}  // namespace regather
