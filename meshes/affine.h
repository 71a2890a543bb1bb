// meshes/affine.h -- where an object stands: an affine map in doubles.
#pragma once
#include <array>

#include "trace/vec.h"

namespace regather::meshes {

/// A 3 x 3 matrix by rows.
using Matrix3 = std::array<double, 9>;
Matrix3 product(const Matrix3& a, const Matrix3& b);
trace::Vec3d times(const Matrix3& m, trace::Vec3d p);
/// The inverse, transposed, times the determinant: what normals go by.
Matrix3 cofactors(const Matrix3& m);

/// p -> linear p + offset.
struct Affine {
    Matrix3 linear{1, 0, 0, 0, 1, 0, 0, 0, 1};
    trace::Vec3d offset;

    trace::Vec3d operator()(trace::Vec3d p) const;
    double determinant() const;  ///< Of its linear part: below 0 when it mirrors.
    /// Of a surface's normal n, by the transposed inverse; of length 1, or zero when there is none.
    trace::Vec3 normal(trace::Vec3 n) const;
    friend Affine operator*(const Affine& a, const Affine& b);  ///< b first.
};

}  // namespace regather::meshes
