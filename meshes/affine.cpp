#include "meshes/affine.h"

namespace regather::meshes {

using trace::Vec3;

namespace {

Vec3 times(const std::array<std::array<double, 4>, 3>& rows, Vec3 p, double w) {
    Vec3 q;
    for (int i = 0; i < 3; ++i) {
        const auto& row = rows[static_cast<std::size_t>(i)];
        q[i] = static_cast<float>(row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3] * w);
    }
    return q;
}

// The inverse, transposed, but for its length: what normals go by.
std::array<std::array<double, 4>, 3> cofactors(const std::array<std::array<double, 4>, 3>& a) {
    std::array<std::array<double, 4>, 3> c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
        }
    return c;
}

}  // namespace

double Affine::determinant() const {
    const auto c = cofactors(rows);
    return rows[0][0] * c[0][0] + rows[0][1] * c[0][1] + rows[0][2] * c[0][2];
}

Vec3 Affine::point(Vec3 p) const {
    return times(rows, p, 1);
}

Vec3 Affine::normal(Vec3 n) const {
    const Vec3 turned = trace::normalize(times(cofactors(rows), n, 0) * (determinant() < 0 ? -1.0f : 1.0f));
    return trace::is_finite(turned) ? turned : Vec3{};
}

Affine operator*(const Affine& a, const Affine& b) {
    Affine c;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            c.rows[i][j] = j == 3 ? a.rows[i][3] : 0;
            for (std::size_t k = 0; k < 3; ++k) c.rows[i][j] += a.rows[i][k] * b.rows[k][j];
        }
    return c;
}

}  // namespace regather::meshes
