#include "meshes/affine.h"

namespace regather::meshes {

using trace::Vec3, trace::Vec3d;

Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return c;
}

Vec3d times(const Matrix3& m, Vec3d p) {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z, m[3] * p.x + m[4] * p.y + m[5] * p.z,
            m[6] * p.x + m[7] * p.y + m[8] * p.z};
}

Matrix3 cofactors(const Matrix3& m) {
    return {m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6],
            m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6], m[1] * m[6] - m[0] * m[7],
            m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3]};
}

Vec3d Affine::operator()(Vec3d p) const {
    return times(linear, p) + offset;
}

double Affine::determinant() const {
    const Matrix3 c = cofactors(linear);
    return linear[0] * c[0] + linear[1] * c[1] + linear[2] * c[2];
}

Vec3 Affine::normal(Vec3 n) const {
    const Vec3 turned = to_float(times(cofactors(linear), n) + Vec3d{});  // the sum makes -0 a 0
    const Vec3 unit = normalize(turned * (determinant() < 0 ? -1.0f : 1.0f));
    return is_finite(unit) ? unit : Vec3{};
}

Affine operator*(const Affine& a, const Affine& b) {
    Affine c{product(a.linear, b.linear), a.offset};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            c.offset[i] +=
                a.linear[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(k)] * b.offset[k];
    return c;
}

}  // namespace regather::meshes
