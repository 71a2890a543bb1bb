// Peaked lobes, grazing angles and extreme indices of refraction, against double and long double.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "capture/light/bsdf.h"
#include "capture/reference/moments.h"
#include "study/case.h"
#include "study/half_vector.h"

namespace regather::study {
namespace {

using capture::Material, capture::Sampler, trace::Vec3;

constexpr double degree = std::numbers::pi / 180;

/// Integral over the half vectors of `integrand`(direction, direction as floats) x solid angle; of
/// `chance_of_none` the share without a direction.
template <class Integrand>
double over_lobe(const HalfVectorLobe& lobe, float exponent, Effort effort, const Integrand& integrand,
                 double& chance_of_none) {
    const int rows = effort == Effort::quick ? 600 : 1500;
    constexpr int columns = 256;
    std::vector<double> sums(static_cast<std::size_t>(rows)), misses(static_cast<std::size_t>(rows));
    tbb::parallel_for(0, rows, [&](int i) {
        for (int j = 0; j < columns; ++j) {
            // Rising u from the horizon to the peak; squared cells near 0, where the cosine of a blunt lobe
            // changes fast.
            const double s = (i + 0.5) / rows, u = s * s, width = 2 * s / rows / columns;
            const auto sample = lobe.at(u, (j + 0.5) / columns);
            if (!(sample.along > 0) || !(sample.direction.z > 0)) {
                misses[static_cast<std::size_t>(i)] += width;
                continue;
            }
            // dw = 4 (incoming . half) dh, and dh = 2 pi du dv / ((e + 1) cos^e)
            const double solid_angle =
                4 * sample.along * 2 * std::numbers::pi / ((double{exponent} + 1) * sample.power);
            sums[static_cast<std::size_t>(i)] +=
                integrand(sample.direction, to_float(sample.direction)) * solid_angle * width;
        }
    });
    double sum = 0;
    chance_of_none = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sum += sums[i];
        chance_of_none += misses[i];
    }
    return sum;
}

/// The density's integral and the chance of no direction are 1 together.
Case density_integral(float exponent, double degrees) {
    return {fmt::format("density of exponent {:g} at {:g} degrees", exponent, degrees),
            "integral and chance of none, less 1",
            "a quadrature of 384,000 points; directions rounded to float times the lobe's steepness",
            [=](Effort effort) {
                const HalfVectorLobe lobe(exponent, degrees);
                double none = 0;
                const double integral = over_lobe(
                    lobe, exponent, effort,
                    [&](const auto&, Vec3 direction) {
                        return double{
                            capture::scatter_pdf(lobe.material(), {0, 0, 1}, lobe.incoming(), direction)};
                    },
                    none);
                return Reading{std::fabs(integral + none - 1), 1e-3};
            }};
}

/// Mean weight of scatter() against the lobe's directional albedo by quadrature in double.
Case weight_mean(float exponent, double degrees) {
    return {fmt::format("scattered power, exponent {:g} at {:g} degrees", exponent, degrees),
            "relative error of the albedo", "4.5 sigma of the samples, and 1e-3 of the quadrature",
            [=](Effort effort) {
                const HalfVectorLobe lobe(exponent, degrees);
                double none = 0;
                const double norm = (exponent + 2.0) * (exponent + 4.0) /
                                    (8 * std::numbers::pi * (std::exp2(-0.5 * exponent) + exponent));
                const double albedo = over_lobe(
                    lobe, exponent, effort,
                    [&](trace::Vec3d direction, Vec3) {
                        const double x = double{lobe.incoming().x} + direction.x, y = direction.y,
                                     z = double{lobe.incoming().z} + direction.z;
                        const double sine2 = (x * x + y * y) / (x * x + y * y + z * z);
                        return norm * std::exp(0.5 * exponent * std::log1p(-std::min(sine2, 1.0))) *
                               direction.z;
                    },
                    none);
                const int samples = effort == Effort::quick ? 40'000 : 1'000'000;
                capture::MomentsOf<1> reflected;
                for (int i = 0; i < samples; ++i) {
                    Sampler sampler(43, capture::Stream::photon, static_cast<std::uint64_t>(i));
                    const capture::Scatter next =
                        capture::scatter(lobe.material(), {0, 0, 1}, lobe.incoming(), sampler);
                    const double weight = next.absorbed ? 0 : double{next.weight.x};
                    reflected.add({weight}, static_cast<std::uint64_t>(i) + 1);
                }
                const double error = std::sqrt(reflected.variance(0, samples));
                return sampled(std::fabs(reflected.mean[0] - albedo) / albedo, 1e-3, error / albedo, 0.06);
            }};
}

const std::vector<double> angles{0, 1e-3, 0.1, 10, 41.8, 45, 60, 80, 89, 89.9, 89.99, 89.999};

/// Fresnel's equations in long double for the very float inputs; 1 where nothing is refracted.
long double exact_fresnel(float cosine, float eta) {
    const long double c = cosine, e = eta, sine2 = (1 - c) * (1 + c), t2 = e * e - sine2;
    if (t2 <= 0) return 1;
    const long double t = std::sqrt(t2), parallel = (e * e * c - t) / (e * e * c + t),
                      perpendicular = (c - t) / (c + t);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

/// From straight on to 89.999 degrees, and up to a few floats around the critical angle.
std::vector<float> cosines(float eta) {
    std::vector<float> all;
    for (const double angle : angles) all.push_back(static_cast<float>(std::cos(angle * degree)));
    if (eta < 1) {
        float critical = static_cast<float>(std::sqrt((1.0 - eta) * (1.0 + eta)));
        for (int i = 0; i < 4; ++i) critical = std::nextafter(critical, 0.0f);
        for (int i = 0; i < 9; ++i, critical = std::nextafter(critical, 1.0f)) all.push_back(critical);
    }
    return all;
}

Case fresnel_share(float eta, const char* name) {
    return {fmt::format("Fresnel, index {}", name), "worst error of the reflectance",
            "2^-24 of the result, and at the critical angle the root of 2^-53 of the index", [=](Effort) {
                double worst = 0;
                for (const float cosine : cosines(eta))
                    worst = std::max(worst, static_cast<double>(std::fabs(exact_fresnel(cosine, eta) -
                                                                          capture::fresnel(cosine, eta))));
                return Reading{worst, 1e-6};
            }};
}

/// Snell's law for the very float inputs: sine of the refracted angle x eta against the incident one, and
/// unit length.
Case snell(float eta, const char* name) {
    return {
        fmt::format("refraction, index {}", name),
        "worst error of the direction (0.1: wrong side of the critical angle)", "three roundings to float",
        [=](Effort) {
            double worst = 0;
            for (const float cosine : cosines(eta)) {
                const double sine = std::sqrt((1 - double{cosine}) * (1 + double{cosine}));
                const Vec3 out{static_cast<float>(sine), 0, cosine};
                const long double length = std::sqrt(static_cast<long double>(out.x) * out.x +
                                                     static_cast<long double>(cosine) * cosine);
                const long double exact_sine = out.x / length / eta;
                Vec3 through;
                const bool refracts = capture::refract(out, {0, 0, 1}, eta, through);
                if (std::fabs(exact_sine - 1) < 1e-6)
                    continue;  // which side it is on depends on the last float
                if (refracts != (exact_sine < 1)) {
                    worst = std::max(worst, 0.1);
                } else if (refracts) {
                    worst = std::max(worst, static_cast<double>(std::fabs(-through.x - exact_sine)));
                    worst = std::max(
                        worst,
                        std::fabs(std::hypot(double{through.x}, double{through.y}, double{through.z}) - 1));
                }
            }
            return Reading{worst, 4e-7};
        }};
}

/// At grazing angles a mirror direction must stay on its side, and its angle must be the incident one.
Reading grazing_mirror(Effort) {
    double worst = 0;
    for (const double angle : angles)
        for (const Vec3 normal :
             {Vec3{0, 0, 1}, normalize(Vec3{1, 2, 3}), normalize(Vec3{-1, 1e-4f, 1e-3f})}) {
            const capture::Frame frame(normal);
            const Vec3 out = normalize(frame.to_world({static_cast<float>(std::sin(angle * degree)), 0,
                                                       static_cast<float>(std::cos(angle * degree))}));
            const Vec3 back = capture::reflect(out, normal);
            worst = std::max(worst, std::fabs(double{dot(back, normal)} - dot(out, normal)));
        }
    return {worst, 4e-7};
}

}  // namespace

std::vector<Case> peaked_lobe_cases() {
    std::vector<Case> cases;
    for (const float exponent : {1.0f, 10.0f, 100.0f, 1e3f, 1e4f, 1e5f, 1e6f})
        for (const double degrees : {0.0, 60.0, 89.999}) cases.push_back(density_integral(exponent, degrees));
    for (const float exponent : {1.0f, 100.0f, 1e4f, 1e6f})
        for (const double degrees : {0.0, 60.0, 89.0, 89.999})
            cases.push_back(weight_mean(exponent, degrees));
    for (const auto& [eta, name] : {std::pair{1.0001f, "1.0001"},
                                    {1 / 1.0001f, "1 / 1.0001"},
                                    {1.5f, "1.5"},
                                    {1 / 1.5f, "1 / 1.5"},
                                    {5.0f, "5"},
                                    {0.2f, "1 / 5"}}) {
        cases.push_back(fresnel_share(eta, name));
        cases.push_back(snell(eta, name));
    }
    cases.push_back({"mirror directions to 89.999 degrees", "worst error of the cosine",
                     "three roundings to float", grazing_mirror});
    return cases;
}

}  // namespace regather::study
