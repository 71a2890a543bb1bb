// meshes/affine.h -- where a node of a glTF file stands: an affine map in doubles.
#pragma once
#include <array>

#include "trace/vec.h"

namespace regather::meshes {

/// By rows: p goes to (row . p + row[3]).
struct Affine {
    std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

    double determinant() const;  ///< Of its linear part: below 0 when it mirrors.
    trace::Vec3 point(trace::Vec3 p) const;
    /// Of a surface's normal n, by the transposed inverse; of length 1, or zero when there is none.
    trace::Vec3 normal(trace::Vec3 n) const;
    friend Affine operator*(const Affine& a, const Affine& b);  ///< b first.
};

}  // namespace regather::meshes
