#include "study/error_parts.h"

#include <cmath>

namespace regather::study {
namespace {

/// Mean over all pairs of different images, `without` one of them; SIZE_MAX: with all.
double mean_of_pairs(const std::vector<std::vector<double>>& products, std::size_t without = SIZE_MAX) {
    double sum = 0;
    std::size_t pairs = 0;
    for (std::size_t m = 0; m < products.size(); ++m)
        for (std::size_t n = 0; n < m; ++n) {
            if (m == without || n == without) continue;
            sum += products[m][n];
            ++pairs;
        }
    return sum / static_cast<double>(pairs);
}

/// Standard error of an estimate from its values without one image each.
double jackknife(const std::vector<double>& left) {
    const auto count = static_cast<double>(left.size());
    double middle = 0, squares = 0;
    for (const double value : left) middle += value / count;
    for (const double value : left) squares += (value - middle) * (value - middle);
    return std::sqrt(squares * (count - 1) / count);
}

}  // namespace

ErrorParts error_parts(std::span<const capture::Image> images, const Truth& truth,
                       std::span<const std::uint8_t> mask) {
    const std::size_t count = images.size();
    std::vector<std::vector<double>> products(count, std::vector<double>(count));
    ErrorParts out;
    double values = 0;
    std::vector<double> difference(count);
    for (std::size_t i = 0; i < truth.mean.pixels.size(); ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        for (int c = 0; c < 3; ++c) {
            for (std::size_t m = 0; m < count; ++m) {
                difference[m] = static_cast<double>(images[m].pixels[i][c]) -
                                static_cast<double>(truth.mean.pixels[i][c]);
                for (std::size_t n = 0; n <= m; ++n) products[m][n] += difference[m] * difference[n];
            }
            if (!truth.variance.empty()) out.reference_variance += static_cast<double>(truth.variance[i][c]);
        }
        values += 3;
    }
    out.reference_variance /= values;
    double own = 0;
    for (std::size_t m = 0; m < count; ++m) {
        for (std::size_t n = 0; n <= m; ++n) products[m][n] /= values;
        own += products[m][m] / static_cast<double>(count);
    }
    out.squared_error = own - out.reference_variance;
    if (count < 2) return out;
    const double pairs = mean_of_pairs(products);
    out.variance = own - pairs;
    out.bias_squared = pairs - out.reference_variance;
    if (count < 3) return out;
    std::vector<double> bias(count), variance(count);
    for (std::size_t m = 0; m < count; ++m) {
        bias[m] = mean_of_pairs(products, m);
        const auto others = static_cast<double>(count - 1);
        variance[m] = (own * static_cast<double>(count) - products[m][m]) / others - bias[m];
    }
    out.bias_squared_stderr = jackknife(bias);
    out.variance_stderr = jackknife(variance);
    return out;
}

}  // namespace regather::study
