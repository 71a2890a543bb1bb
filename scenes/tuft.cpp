#include "scenes/tuft.h"

#include <array>
#include <cmath>

#include "scenes/draws.h"

namespace regather::scenes {

namespace {

// The middle of a blade is the parabola root + reach t^2 out + height t up, t from 0 to 1.
void add_blade(Surface& surface, const Tuft& tuft, std::uint32_t number) {
    Draws draws(tuft.seed, Draws::Purpose::tuft, number);
    const auto [x, y] = draws.in_disc();
    const auto [away_x, away_y] = draws.on_circle();
    // Half outward from the disc's middle, half any way.
    double out_x = x + away_x, out_y = y + away_y;
    const double length = std::sqrt(out_x * out_x + out_y * out_y);
    if (length > 1e-3) {
        out_x /= length;
        out_y /= length;
    } else {
        out_x = away_x;
        out_y = away_y;
    }
    const double height = tuft.height * draws.between(0.6, 1), half = tuft.width * draws.between(0.3, 0.5),
                 reach = tuft.reach * draws.between(0.1, 1);
    const double root_x = tuft.center.x + tuft.radius * x, root_y = tuft.center.y + tuft.radius * y;

    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    const std::uint32_t n = tuft.segments;
    for (std::uint32_t i = 0; i <= n; ++i) {
        const double t = static_cast<double>(i) / n, along = reach * t * t;
        const double middle_x = root_x + along * out_x, middle_y = root_y + along * out_y;
        const float z = static_cast<float>(tuft.center.z + height * t);
        // Across the ribbon lies (-out_y, out_x, 0), its course is (2 t reach out, height): the normal is
        // square to both and points up and back.
        const double rise = 2 * t * reach;
        const Vec3 normal =
            trace::normalize(Vec3{static_cast<float>(-height * out_x), static_cast<float>(-height * out_y),
                                  static_cast<float>(rise)});
        const auto add = [&](double aside) {
            surface.vertices.push_back({static_cast<float>(middle_x - aside * out_y),
                                        static_cast<float>(middle_y + aside * out_x), z});
            surface.normals.push_back(normal);
        };
        if (i == n) {
            add(0);
        } else {
            const double wide = half * (1 - t * t);
            add(wide);
            add(-wide);
        }
    }
    // From the side of the normal, the vertex of even number lies on the left.
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
        const std::uint32_t a = first + 2 * i;
        surface.triangles.push_back({a, a + 1, a + 2});
        surface.triangles.push_back({a + 1, a + 3, a + 2});
    }
    const std::uint32_t last = first + 2 * (n - 1);
    surface.triangles.push_back({last, last + 1, last + 2});
}

}  // namespace

std::uint64_t triangle_count(const Tuft& tuft) {
    return std::uint64_t{tuft.blades} * (2 * tuft.segments - 1);
}

Surface tessellate(const Tuft& tuft) {
    Surface surface;
    for (std::uint32_t blade = 0; blade < tuft.blades; ++blade) add_blade(surface, tuft, blade);
    return surface;
}

}  // namespace regather::scenes
