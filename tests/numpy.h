// tests/numpy.h -- files as numpy.save writes them.
#pragma once
#include <string>
#include <vector>

namespace regather {

/// `descr` as "<i4", `shape` as "(3,)".
inline std::string numpy_file(const std::string& descr, const std::string& shape, const std::string& rows) {
    std::string file("\x93NUMPY\x01\x00\x76\x00", 10);
    file += "{'descr': '" + descr + "', 'fortran_order': False, 'shape': " + shape + ", }";
    file.resize(127, ' ');
    return file + '\n' + rows;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace regather
