#include "replay/student.h"

#include <boost/math/distributions/students_t.hpp>

namespace regather::replay {

double student_quantile_95(std::uint64_t degrees_of_freedom) {
    // Without it Boost calculates in long double, from static objects that abort where there is none
    // (valgrind).
    using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
    return boost::math::quantile(
        boost::math::students_t_distribution<double, InDouble>(static_cast<double>(degrees_of_freedom)),
        0.975);
}

}  // namespace regather::replay
