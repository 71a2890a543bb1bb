#include "study/chi_squared.h"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <cstddef>

namespace regather::study {

double chi_squared_tail(double chi_squared, double degrees) {
    // Without it Boost calculates in long double, from static objects that abort where there is none
    // (valgrind).
    using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
    return chi_squared > 0 ? boost::math::gamma_q(degrees / 2, chi_squared / 2, InDouble()) : 1;
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
