#include "scenes/terrain.h"

#include <cmath>

#include "scenes/draws.h"
#include "scenes/tessellation.h"

namespace regather::scenes {

namespace {

constexpr int octaves = 3;

/// From -1 to 1.
double knot(std::uint32_t seed, int octave, double i, double j) {
    // Terrain lies at x, y >= 0: a knot has a number of 31 bits along each axis.
    const auto column = static_cast<std::uint64_t>(i), row = static_cast<std::uint64_t>(j);
    Draws draws(seed, Draws::Purpose::terrain,
                (row << 32 | column) * octaves + static_cast<unsigned>(octave));
    return draws.between(-1, 1);
}

/// One octave, in wavelengths: value and slopes.
Ground noise(std::uint32_t seed, int octave, double x, double y) {
    const double i = std::floor(x), j = std::floor(y), u = x - i, v = y - j;
    const auto smooth = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const auto steep = [](double t) { return 30 * t * t * (t * (t - 2) + 1); };
    const double a = knot(seed, octave, i, j), b = knot(seed, octave, i + 1, j),
                 c = knot(seed, octave, i, j + 1), d = knot(seed, octave, i + 1, j + 1);
    const double along_x = b - a, along_y = c - a, twist = a - b - c + d;
    return {a + along_x * smooth(u) + along_y * smooth(v) + twist * smooth(u) * smooth(v),
            (along_x + twist * smooth(v)) * steep(u), (along_y + twist * smooth(u)) * steep(v)};
}

double between(double size, std::uint32_t i, std::uint32_t n) {
    return i == n ? size : size * i / n;
}

}  // namespace

Ground ground_at(const Terrain& terrain, double x, double y) {
    Ground sum{0, 0, 0};
    double share = 1, all = 0, wavelength = terrain.wavelength;
    for (int octave = 0; octave < octaves; ++octave) {
        const Ground one = noise(terrain.seed, octave, x / wavelength, y / wavelength);
        sum.height += share * one.height;
        sum.slope_x += share * one.slope_x / wavelength;
        sum.slope_y += share * one.slope_y / wavelength;
        all += share;
        share /= 2;
        wavelength /= 2;
    }
    const double scale = terrain.amplitude / all;
    return {sum.height * scale, sum.slope_x * scale, sum.slope_y * scale};
}

std::uint64_t triangle_count(const Terrain& terrain) {
    return 2ull * terrain.cells[0] * terrain.cells[1];
}

Surface tessellate(const Terrain& terrain) {
    Surface surface;
    const auto [nx, ny] = terrain.cells;
    for (std::uint32_t j = 0; j <= ny; ++j)
        for (std::uint32_t i = 0; i <= nx; ++i) {
            const double x = between(terrain.size[0], i, nx), y = between(terrain.size[1], j, ny);
            const Ground ground = ground_at(terrain, x, y);
            surface.vertices.push_back({static_cast<float>(terrain.corner.x + x),
                                        static_cast<float>(terrain.corner.y + y),
                                        static_cast<float>(terrain.corner.z + ground.height)});
            surface.normals.push_back(trace::normalize(
                Vec3{static_cast<float>(-ground.slope_x), static_cast<float>(-ground.slope_y), 1}));
        }
    add_grid_triangles(surface, 0, nx, ny);
    return surface;
}

}  // namespace regather::scenes
