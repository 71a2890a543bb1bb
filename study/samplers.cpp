// Chi-squared tests of all samplers: counts in equal cells of the variables that a sampler should find
// evenly.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "capture/light/bsdf.h"
#include "capture/light/lights.h"
#include "study/case.h"
#include "study/chi_squared.h"
#include "study/half_vector.h"
#include "study/room.h"

namespace regather::study {
namespace {

using capture::Sampler, trace::Vec3;

constexpr int cells = 12;          // along each of two variables
constexpr double together = 0.01;  // chance that a right sampler fails one of all tests

/// A cell of the unit square, or the last: no sample.
using Find = std::function<int(Sampler&)>;
int cell_of(double u, double v) {
    const auto place = [](double x) { return std::min(cells - 1, std::max(0, static_cast<int>(x * cells))); };
    return place(u) * cells + place(v);
}
constexpr int none = cells * cells;

struct Test {
    std::string name;
    Find find;
    std::vector<double> chances;  ///< By cell; empty: all alike.
};

double p_of(const Test& test, std::uint64_t seed, Effort effort) {
    const std::size_t samples = effort == Effort::quick ? 40'000 : 2'000'000;
    constexpr std::size_t blocks = 64;
    std::vector<std::vector<double>> parts(blocks, std::vector<double>(none + 1));
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
        for (std::size_t i = b * samples / blocks; i < (b + 1) * samples / blocks; ++i) {
            Sampler sampler(seed, capture::Stream::gather, i);
            ++parts[b][static_cast<std::size_t>(test.find(sampler))];
        }
    });
    std::vector<double> observed(none + 1), expected(none + 1);
    for (const auto& part : parts)
        for (std::size_t c = 0; c <= none; ++c) observed[c] += part[c];
    for (std::size_t c = 0; c <= none; ++c)
        expected[c] = static_cast<double>(samples) *
                      (test.chances.empty() ? (c < none ? 1.0 / none : 0) : test.chances[c]);
    return chi_squared_p(observed, expected);
}

double turn_of(double x, double y) {
    const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
    return turn < 0 ? turn + 1 : turn;
}

/// cos^2 and azimuth of a cosine lobe are even. 1 - cos^2 by the sine: near the horizon nothing else has
/// digits.
int cosine_cell(const capture::Frame& frame, Vec3 direction) {
    const double x = dot(frame.tangent, direction), y = dot(frame.bitangent, direction);
    return dot(frame.normal, direction) > 0 ? cell_of(x * x + y * y, turn_of(x, y)) : none;
}

/// Cells must not end at right angles to the view: there, at grazing angles, directions begin to be below the
/// horizon, and rounding would put them into cells that expect none.
double shifted(double turn) {
    return turn + 0.5 / cells < 1 ? turn + 0.5 / cells : turn + 0.5 / cells - 1;
}

Test half_vectors(float exponent, double degrees) {
    const HalfVectorLobe lobe(exponent, degrees);
    // Chance of a cell: the share of it whose half vectors give a direction above the horizon.
    std::vector<double> chances(none + 1);
    constexpr int turns = cells * 500;
    for (int j = 0; j < turns; ++j) {
        const double v = (j + 0.5) / turns, least = lobe.least_u(v);
        for (int i = 0; i < cells; ++i) {
            const double low = static_cast<double>(i) / cells, high = static_cast<double>(i + 1) / cells;
            const double above = std::clamp((high - least) / (high - low), 0.0, 1.0) / cells / turns;
            chances[static_cast<std::size_t>(cell_of((low + high) / 2, shifted(v)))] += above;
            chances[none] += 1.0 / cells / turns - above;
        }
    }
    return {fmt::format("half vectors, exponent {:g}, {:g} degrees", exponent, degrees),
            [lobe](Sampler& sampler) {
                Vec3 direction;
                const double choice = sampler.fine_uniform();
                const float u = sampler.uniform(), v = sampler.uniform();
                if (!capture::sample_direction(lobe.material(), {0, 0, 1}, lobe.incoming(), choice, u, v,
                                               direction))
                    return none;
                const auto [place, turn] = lobe.place_of(direction);
                return cell_of(place, shifted(turn));
            },
            chances};
}

struct Lit {
    explicit Lit(const scenes::Scene& with) : scene(with), lights(scene) {}
    scenes::Scene scene;
    capture::LightSampler lights;
};

Test light_points() {
    Room room;
    room.light({0.2, 0.1, 1}, {0, 0.3, 0}, {0.7, 0.1, 0}, 1, room.diffuse(0));
    return {"points on a light",
            [lit = std::make_shared<const Lit>(room.scene)](Sampler& sampler) {
                const double s = sampler.fine_uniform(), t = sampler.fine_uniform();
                const Vec3 p = lit->lights.sample_light(0, s, t).position - lit->scene.lights[0].corner;
                const double v = p.x / 0.7, u = (p.y - 0.1 * v) / 0.3;
                return cell_of(u, v);
            },
            {}};
}

Test emissions(bool directions) {
    Room room;
    room.light({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 1, room.diffuse(0));
    return {directions ? "directions of photons that leave a light" : "points where photons leave a light",
            [lit = std::make_shared<const Lit>(room.scene), directions](Sampler& sampler) {
                const capture::Emission photon = lit->lights.emit(sampler);
                if (!directions) return cell_of(photon.position.x, photon.position.y);
                static const capture::Frame frame({0, 0, -1});
                return cosine_cell(frame, photon.direction);
            },
            {}};
}

std::vector<Test> tests() {
    std::vector<Test> all;
    all.push_back({"uniform()",
                   [](Sampler& s) {
                       const float u = s.uniform();
                       return cell_of(u, s.uniform());
                   },
                   {}});
    all.push_back({"fine_uniform()",
                   [](Sampler& s) {
                       const double u = s.fine_uniform();
                       return cell_of(u, s.fine_uniform());
                   },
                   {}});
    all.push_back({"fine_uniform(), lowest bits",
                   [](Sampler& s) {
                       const double u = std::fmod(s.fine_uniform() * 0x1p40, 1.0);
                       return cell_of(u, std::fmod(s.fine_uniform() * 0x1p40, 1.0));
                   },
                   {}});
    all.push_back({"below(144)", [](Sampler& s) { return static_cast<int>(s.below(none)); }, {}});
    all.push_back({"cosine_hemisphere()",
                   [](Sampler& s) {
                       const float u = s.uniform();
                       const Vec3 d = capture::cosine_hemisphere(u, s.uniform());
                       static const capture::Frame up({0, 0, 1});
                       return cosine_cell(up, up.to_world(d));
                   },
                   {}});
    for (const Vec3 normal :
         {Vec3{0, 0, -1}, normalize(Vec3{1e-4f, -1, 1e-4f}), normalize(Vec3{1, 2, -0.001f})})
        all.push_back({fmt::format("Lambert about ({:.2g}, {:.2g}, {:.2g})", normal.x, normal.y, normal.z),
                       [normal](Sampler& s) {
                           capture::Material material;
                           const capture::Frame frame(normal);
                           Vec3 d;
                           const double choice = s.fine_uniform();
                           const float u = s.uniform(), v = s.uniform();
                           if (!capture::sample_direction(material, normal, normal, choice, u, v, d))
                               return none;
                           return cosine_cell(frame, d);
                       },
                       {}});
    for (const float exponent : {1.0f, 10.0f, 100.0f, 1e3f, 1e4f, 1e5f, 1e6f})
        all.push_back(half_vectors(exponent, 20));
    for (const float exponent : {1.0f, 100.0f, 1e6f})
        for (const double degrees : {89.0, 89.999}) all.push_back(half_vectors(exponent, degrees));
    all.push_back(light_points());
    all.push_back(emissions(false));
    all.push_back(emissions(true));
    return all;
}

}  // namespace

std::vector<Case> sampler_cases() {
    const std::vector<Test> all = tests();
    const double allowed = -std::log10(sidak(together, static_cast<int>(all.size())));
    std::vector<Case> cases;
    std::uint64_t seed = 0;
    for (const Test& test : all) {
        ++seed;
        cases.push_back({test.name, "-log10 p of chi-squared",
                         fmt::format("1 % for all {} tests together (Sidak)", all.size()),
                         [=](Effort effort) {
                             return Reading{-std::log10(std::max(p_of(test, seed, effort), 1e-300)), allowed};
                         }});
    }
    return cases;
}

}  // namespace regather::study
