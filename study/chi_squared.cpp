#include "study/chi_squared.h"

#include <cmath>
#include <cstddef>

namespace regather::study {

double chi_squared_tail(double chi_squared, double degrees) {
    const double a = degrees / 2, x = chi_squared / 2;
    if (!(x > 0)) return 1;
    const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > sum * 1e-16; ++n) sum += term *= x / n;
        return 1 - sum * front;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;  // Lentz
    for (int i = 1; i < 10'000; ++i) {
        const double numerator = -i * (i - a);
        b += 2;
        d = 1 / (numerator * d + b);
        c = b + numerator / c;
        const double factor = c * d;
        fraction *= factor;
        if (std::fabs(factor - 1) < 1e-15) break;
    }
    return front * fraction;
}

double chi_squared_p(std::span<const double> observed, std::span<const double> expected) {
    double chi_squared = 0, few_observed = 0, few_expected = 0;
    int cells = 0;
    const auto add = [&](double found, double due) {
        chi_squared += (found - due) * (found - due) / due;
        ++cells;
    };
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (!(expected[i] > 0) && observed[i] > 0) return 0;
        if (expected[i] < 5) {
            few_observed += observed[i];
            few_expected += expected[i];
        } else {
            add(observed[i], expected[i]);
        }
    }
    if (few_expected > 1) add(few_observed, few_expected);
    return cells < 2 ? 1 : chi_squared_tail(chi_squared, cells - 1);
}

double sidak(double significance, int tests) {
    return -std::expm1(std::log1p(-significance) / tests);
}

}  // namespace regather::study
