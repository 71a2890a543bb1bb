#include "capture/images/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "capture/images/image_error.h"
#include "trace/median.h"

namespace regather::capture {
namespace {

using std::numbers::pi;
constexpr double colour_exponent = 0.7, feature_exponent = 0.5, p_c = 0.4, p_t = 0.95, detector_width = 0.082;

using Colour = std::array<double, 3>;
using Matrix = std::array<Colour, 3>;
using Plane = std::vector<double>;

// sRGB primaries with the white point D65, as in the authors' supplement.
constexpr Matrix xyz_of_rgb{{{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                             {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                             {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};

constexpr Matrix inverse(const Matrix& m) {
    const auto minor = [&](std::size_t r, std::size_t c) {  // cyclic indices give the sign
        return m[(r + 1) % 3][(c + 1) % 3] * m[(r + 2) % 3][(c + 2) % 3] -
               m[(r + 1) % 3][(c + 2) % 3] * m[(r + 2) % 3][(c + 1) % 3];
    };
    const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    Matrix out{};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) out[c][r] = minor(r, c) / determinant;
    return out;
}
constexpr Matrix rgb_of_xyz = inverse(xyz_of_rgb);

constexpr Colour times(const Matrix& m, const Colour& v) {
    return {m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
            m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
            m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2]};
}
constexpr Colour white = times(xyz_of_rgb, {1, 1, 1});

/// XYZ over the white's.
Colour relative_xyz(const Colour& rgb) {
    const Colour xyz = times(xyz_of_rgb, rgb);
    return {xyz[0] / white[0], xyz[1] / white[1], xyz[2] / white[2]};
}

Colour opponent(double x, double y, double z) {
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Colour ycxcz(const Colour& rgb) {
    const Colour xyz = relative_xyz(rgb);
    return opponent(xyz[0], xyz[1], xyz[2]);
}

Colour rgb_of_ycxcz(const Colour& in) {
    const double y = (in[0] + 16) / 116, x = y + in[1] / 500, z = y - in[2] / 200;
    return times(rgb_of_xyz, {x * white[0], y * white[1], z * white[2]});
}

/// L*a*b* with a* and b* scaled by the luminance (Hunt effect).
Colour hunt_lab(const Colour& rgb) {
    constexpr double delta = 6.0 / 29;
    const auto f = [](double t) {
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
    };
    const Colour xyz = relative_xyz(rgb);
    Colour lab = opponent(f(xyz[0]), f(xyz[1]), f(xyz[2]));
    lab[1] *= 0.01 * lab[0];
    lab[2] *= 0.01 * lab[0];
    return lab;
}

double hyab(const Colour& a, const Colour& b) {
    const double da = a[1] - b[1], db = a[2] - b[2];
    return std::abs(a[0] - b[0]) + std::sqrt(da * da + db * db);
}

/// Largest powered distance in the gamut, between green and blue.
double largest_distance() {
    return std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), colour_exponent);
}

/// To [0, 1]: the range of common differences gets most of it.
double redistributed(double powered, double most) {
    const double knee = p_c * most;
    return powered < knee ? p_t / knee * powered : p_t + (powered - knee) / (most - knee) * (1 - p_t);
}

/// Weights at -radius ... radius.
struct Kernel {
    int radius = 0;
    std::vector<double> weights;

    template <class Weight>
    Kernel(int r, Weight weight) : radius(r) {
        for (int x = -r; x <= r; ++x) weights.push_back(weight(static_cast<double>(x)));
    }
    double sum() const {
        double total = 0;
        for (const double w : weights) total += w;
        return total;
    }
    Kernel& scale(double factor) {
        for (double& w : weights) w *= factor;
        return *this;
    }
    /// Positive weights sum to 1 and negative ones to -1.
    void balance() {
        double positive = 0, negative = 0;
        for (const double w : weights) (w > 0 ? positive : negative) += w;
        for (double& w : weights) w /= w > 0 ? positive : -negative;
    }
};

struct Size {
    int width, height;
};

/// Correlation with `across` along rows and `down` along columns: all of FLIP's filters are such products.
Plane filtered(const Plane& in, Size size, const Kernel& across, const Kernel& down) {
    const auto w = static_cast<std::size_t>(size.width);
    Plane rows(in.size()), out(in.size());
    std::vector<double> padded(w + across.weights.size());
    for (int y = 0; y < size.height; ++y) {
        const double* row = &in[static_cast<std::size_t>(y) * w];
        for (int x = -across.radius; x < size.width + across.radius; ++x)
            padded[static_cast<std::size_t>(x + across.radius)] = row[std::clamp(x, 0, size.width - 1)];
        double* to = &rows[static_cast<std::size_t>(y) * w];
        for (std::size_t t = 0; t < across.weights.size(); ++t)
            for (std::size_t x = 0; x < w; ++x) to[x] += across.weights[t] * padded[x + t];
    }
    for (int y = 0; y < size.height; ++y) {
        double* to = &out[static_cast<std::size_t>(y) * w];
        for (int t = -down.radius; t <= down.radius; ++t) {
            const double weight = down.weights[static_cast<std::size_t>(t + down.radius)];
            const double* row = &rows[static_cast<std::size_t>(std::clamp(y + t, 0, size.height - 1)) * w];
            for (std::size_t x = 0; x < w; ++x) to[x] += weight * row[x];
        }
    }
    return out;
}

/// All that does not depend on the images.
class Observer {
public:
    explicit Observer(double pixels_per_degree)
        : deviation_(0.5 * detector_width * pixels_per_degree),
          blur_(detector([](double, double g) { return g; })),
          edge_(detector([](double x, double g) { return -x * g; })),
          point_(
              detector([this](double x, double g) { return (x * x / (deviation_ * deviation_) - 1) * g; })),
          most_(largest_distance()) {
        blur_.scale(1 / blur_.sum());
        edge_.balance();
        point_.balance();
        // Contrast sensitivity: achromatic, red-green, and blue-yellow as a sum of two Gaussians.
        constexpr double widest = 0.04;
        const int radius =
            static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
        const auto gaussian = [&](double b) {
            return Kernel(radius, [&](double x) {
                const double degrees = x / pixels_per_degree;
                return std::exp(-pi * pi * degrees * degrees / b);
            });
        };
        const auto add = [&](std::size_t channel, double a, double b) {
            Kernel kernel = gaussian(b);
            const double share = a * std::sqrt(pi / b) * kernel.sum() * kernel.sum();
            kernel.scale(1 / kernel.sum());
            sensitivity_[channel].push_back({share, std::move(kernel)});
        };
        add(0, 1, 0.0047);
        add(1, 1, 0.0053);
        add(2, 34.1, widest);
        add(2, 13.5, 0.025);
        for (auto& channel : sensitivity_) {
            double total = 0;
            for (const Term& term : channel) total += term.share;
            for (Term& term : channel) term.share /= total;
        }
    }

    /// An image as it is seen: filtered colours, and the strength of edges and points.
    struct Seen {
        std::vector<Colour> lab;
        Plane edges, points;
    };
    Seen see(const std::vector<Colour>& rgb, Size size) const {
        const std::size_t pixels = rgb.size();
        std::array<Plane, 3> planes;
        for (Plane& plane : planes) plane.resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            const Colour colour = ycxcz(rgb[i]);
            for (std::size_t c = 0; c < 3; ++c) planes[c][i] = colour[c];
        }
        Plane grey(pixels);
        for (std::size_t i = 0; i < pixels; ++i) grey[i] = (planes[0][i] + 16) / 116;
        Seen out{std::vector<Colour>(pixels), strength(grey, size, edge_), strength(grey, size, point_)};
        for (std::size_t c = 0; c < 3; ++c) planes[c] = smoothed(planes[c], size, sensitivity_[c]);
        for (std::size_t i = 0; i < pixels; ++i) {
            Colour linear = rgb_of_ycxcz({planes[0][i], planes[1][i], planes[2][i]});
            for (double& v : linear) v = std::clamp(v, 0.0, 1.0);
            out.lab[i] = hunt_lab(linear);
        }
        return out;
    }

    std::vector<float> compare(const Seen& a, const Seen& b) const {
        std::vector<float> out(a.lab.size());
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double colour = redistributed(std::pow(hyab(a.lab[i], b.lab[i]), colour_exponent), most_);
            const double feature =
                std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
            const double power = 1 - std::pow(feature / std::sqrt(2.0), feature_exponent);
            out[i] = static_cast<float>(std::clamp(std::pow(colour, power), 0.0, 1.0));
        }
        return out;
    }

private:
    struct Term {
        double share;
        Kernel kernel;  // along each axis; sums to 1
    };

    template <class Shape>
    Kernel detector(Shape shape) const {
        return Kernel(static_cast<int>(std::ceil(3 * deviation_)),
                      [&](double x) { return shape(x, std::exp(-x * x / (2 * deviation_ * deviation_))); });
    }
    static Plane smoothed(const Plane& in, Size size, const std::vector<Term>& terms) {
        Plane out(in.size());
        for (const Term& term : terms) {
            const Plane part = filtered(in, size, term.kernel, term.kernel);
            for (std::size_t i = 0; i < out.size(); ++i) out[i] += term.share * part[i];
        }
        return out;
    }
    Plane strength(const Plane& grey, Size size, const Kernel& derivative) const {
        Plane out = filtered(grey, size, derivative, blur_);
        const Plane down = filtered(grey, size, blur_, derivative);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::sqrt(out[i] * out[i] + down[i] * down[i]);
        return out;
    }

    double deviation_;  // [pixels]
    Kernel blur_, edge_, point_;
    std::array<std::vector<Term>, 3> sensitivity_;
    double most_;
};

Size size_of(const Image& image) {
    return {static_cast<int>(image.width), static_cast<int>(image.height)};
}

// The ACES curve of Narkowicz (2016) without its pre-exposure of 0.6: (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5).
constexpr double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03, k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

double toned(double radiance, double factor) {
    const double x = std::max(radiance, 0.0) * factor, denominator = k3 * x * x + k4 * x + k5;
    return std::isfinite(denominator) ? std::clamp((k0 * x * x + k1 * x) / denominator, 0.0, 1.0) : 1.0;
}

template <class Value>
std::vector<Colour> colours(const Image& image, Value value) {
    std::vector<Colour> out(image.pixels.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        for (int c = 0; c < 3; ++c)
            out[i][static_cast<std::size_t>(c)] = value(static_cast<double>(image.pixels[i][c]));
    return out;
}

}  // namespace

std::vector<float> ldr_flip(const Image& image, const Image& reference, double pixels_per_degree) {
    check_comparable(image, reference, "image");
    const Observer observer(pixels_per_degree);
    const auto clamped = [](double v) { return std::clamp(v, 0.0, 1.0); };
    const Size size = size_of(reference);
    return observer.compare(observer.see(colours(image, clamped), size),
                            observer.see(colours(reference, clamped), size));
}

Exposures flip_exposures(const Image& reference) {
    std::vector<double> values;
    values.reserve(reference.pixels.size());
    for (const trace::Vec3 p : reference.pixels)
        values.push_back(luminance(std::max(p.x, 0.0f), std::max(p.y, 0.0f), std::max(p.z, 0.0f)));
    const double brightest = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
    if (brightest <= 0) return {0, 0, 1};
    double middle = trace::median(values);
    if (middle <= 0) {
        middle = brightest;
        for (const double value : values)
            if (value > 0) middle = std::min(middle, value);
    }

    // Where the curve is 0.85: the positive root of (k0 - 0.85 k3) x^2 + (k1 - 0.85 k4) x - 0.85 k5.
    constexpr double t = 0.85;
    const double half_b = 0.5 * (k1 - t * k4) / (k0 - t * k3), c = -t * k5 / (k0 - t * k3);
    const double root = -half_b + std::sqrt(half_b * half_b - c);
    Exposures out{std::log2(root / brightest), std::log2(root / middle), 0};
    out.count = static_cast<unsigned>(std::max(2.0, std::ceil(out.stop - out.start)));
    return out;
}

std::vector<float> hdr_flip(const Image& image, const Image& reference, double pixels_per_degree) {
    check_comparable(image, reference, "image");
    const Observer observer(pixels_per_degree);
    const Exposures exposures = flip_exposures(reference);
    const Size size = size_of(reference);
    std::vector<std::vector<float>> maps(exposures.count);
    tbb::parallel_for(0u, exposures.count, [&](unsigned i) {
        const double step = (exposures.stop - exposures.start) / std::max(exposures.count - 1, 1u);
        const double factor = std::exp2(exposures.start + i * step);
        const auto tone = [&](double v) { return toned(v, factor); };
        maps[i] = observer.compare(observer.see(colours(image, tone), size),
                                   observer.see(colours(reference, tone), size));
    });
    std::vector<float> out = maps.front();
    for (const std::vector<float>& map : maps)
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(out[i], map[i]);
    return out;
}

double mean_flip(const std::vector<float>& map) {
    double sum = 0;
    for (const float v : map) sum += static_cast<double>(v);
    return map.empty() ? 0 : sum / static_cast<double>(map.size());
}

}  // namespace regather::capture
