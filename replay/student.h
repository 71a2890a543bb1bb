// replay/student.h -- how many standard errors a 95 % interval reaches when the error itself is an estimate.
#pragma once
#include <cstdint>

namespace regather::replay {

/// The two-sided 95 % quantile of Student's t distribution; at least one degree of freedom.
double student_quantile_95(std::uint64_t degrees_of_freedom);

}  // namespace regather::replay
