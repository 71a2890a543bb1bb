#include "replay/student.h"

#include <boost/math/distributions/students_t.hpp>

namespace regather::replay {

double student_quantile_95(std::uint64_t degrees_of_freedom) {
    return boost::math::quantile(boost::math::students_t(static_cast<double>(degrees_of_freedom)), 0.975);
}

}  // namespace regather::replay
